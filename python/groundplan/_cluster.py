"""A survey on more machines: the passes over pixels as Dask's futures, all else here.

Every pass is a function of a band of rows, with as many rows around it as a gradient's window needs. Its results are
integers, or rows in their order, so that they come to the same bytes wherever the map is cut and whoever was first:

1. counts of the pixels' values, from which it is known what they mean (of a map that the workers read themselves);
2. the gradients of a band, and the states of its pixels, packed;
3. what a band adds to the faces, once the lines are known.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
import numpy.typing as npt

from groundplan import _core
from groundplan._errors import GroundplanError, MapError, ParameterError
from groundplan._extras import needed
from groundplan._parts import add_faces, commonest, count_rows, look, unpacked
from groundplan.maps import Map
from groundplan.maps._canvas import Canvas
from groundplan.maps._distant import Distant
from groundplan.maps._read import read_or_leave
from groundplan.maps._source import Span
from groundplan.maps._tally import Tally, summed
from groundplan.parameters import named
from groundplan.stages import cores, layout, run

if TYPE_CHECKING:
    from groundplan.survey import Survey

R = TypeVar("R")

#: Pixels of a band at the most, but for a row of blocks; rows at the least, and bands for each thread of a worker.
PIXELS, ROWS, SHARES = 1 << 26, 128, 3

#: How long a scheduler is waited for, seconds.
TIMEOUT_S = 10


def connect(address: str) -> Any:
    """A client of the scheduler at an address, which has workers.

    Raises
    ------
    GroundplanError
        ``extra.missing``; ``cluster.connect``; ``cluster.workers``.
    """
    distributed = needed("distributed", "dask")
    try:
        # A client that was half made over a wrong address would wait for its end.
        distributed.comm.addressing.parse_host_port(distributed.comm.parse_address(address)[1])
        client = distributed.Client(address, timeout=TIMEOUT_S, set_as_default=False)
    except (OSError, ValueError, TypeError) as fault:
        said = f"no Dask scheduler answers at {address}: {' '.join(str(fault).split())}"
        raise GroundplanError("cluster.connect", said, "dask scheduler says its address, as tcp://HOST:8786") from fault
    try:
        client.wait_for_workers(1, timeout=TIMEOUT_S)
    except TimeoutError as fault:
        client.close()
        said = f"the Dask scheduler at {address} has no workers"
        raise GroundplanError("cluster.workers", said, f"dask worker {address} starts one") from fault
    return client


def checked(client: Any) -> None:
    """Refuse what is no client that can be waited for.

    Raises
    ------
    ParameterError
        ``cluster.client``.
    """
    if not hasattr(client, "submit") or not hasattr(client, "nthreads") or getattr(client, "asynchronous", False):
        kind = "an asynchronous one" if hasattr(client, "submit") else f"a {type(client).__name__}"
        raise ParameterError("cluster.client", f"the client is {kind}", "it takes a dask.distributed.Client")


@dataclass(frozen=True)
class Site:
    """A map on a cluster: what it is, and where its rows are read.

    Attributes
    ----------
    map : Map
        With its pixels where they are in this process, else of their shape alone.
    distant : Distant or None
        The file that the workers read.
    counts : (256,) int64 or None
        How often each pixel value occurs, where the workers counted.
    """

    map: Map
    distant: Distant | None = None
    counts: npt.NDArray[np.int64] | None = None


def open_map(path: str | os.PathLike[str], reading: dict[str, Any], client: Any) -> Site:
    """A map's file, counted by the workers where they can read it by rows, else read here.

    Raises
    ------
    MapError
        As `groundplan.read`; ``cluster.path`` where a worker has no such file.
    """
    checked(client)

    def count(far: Distant) -> Tally:
        spans = cut(far.shape, far.block, client)
        return summed(list(gather(client, count_rows, [(far, span) for span in spans])))

    map, far, known = read_or_leave(path, reading, count)
    return Site(map, far, None if known is None else known.counts)


def survey_site(
    site: Site,
    client: Any,
    parameters: dict[str, Any],
    threads: int | None,
    own: dict[str, Any],
    *,
    keep: bool = False,
) -> tuple[Survey, Map]:
    """The survey of a map, and the map as far as its pixels are here in the end.

    Of a map that the workers read, what is here are the states of its pixels. Where each state is one value, as in most
    maps, that is the map itself, and the survey keeps it; else each state is drawn in its commonest value.
    """
    from groundplan._pipeline import surveyed

    checked(client)
    map, far, values = site.map, site.distant, named(parameters)
    block = 1 if far is None else far.block
    spans = cut(map.pixels.shape, block, client)
    reach = _core.reach(map.resolution, values)
    meaning = map.values, map.states, map.resolution, map.origin
    sources: list[tuple[Any, Span, Span]] = []
    for span in spans:
        held = max(span[0] - reach, 0), min(span[1] + reach, map.height)
        sent = far if far is not None else client.scatter(np.ascontiguousarray(map.pixels[slice(*held)]))
        sources.append((sent, held, span))
    tasks: list[tuple[Any, ...]] = [(*source, map.height, meaning, values) for source in sources]
    found: list[dict[str, Any]] = []
    exact = True
    if far is None:
        found = [part for part, _ in gather(client, look, tasks)]
    else:
        assert site.counts is not None
        shown, exact = commonest(map.states, site.counts)
        with Canvas(Path(map.image), *far.shape) as canvas:
            parts = gather(client, look, tasks)
            for span, (part, packed) in zip(spans, parts, strict=True):
                found.append(part)
                canvas.put(span[0], shown[unpacked(packed, (span[1] - span[0], map.width))])
            map = replace(map, pixels=canvas.pixels())
    # The lowest rows come first in gradients, the highest in maps.
    gradients = {name: np.concatenate([part.pop(name) for part in reversed(found)]) for name in list(found[0])}
    grid = layout(map)
    directions = own.get("directions") or run(_core.find_directions, grid, gradients, values, cores(threads))
    lines = own.get("lines")
    if lines is None:
        radiograms = run(_core.find_radiograms, grid, gradients, directions, values, cores(threads))
        lines = run(_core.find_lines, radiograms, values)
        lines = run(_core.add_rack_faces, grid, gradients, directions, lines, values, cores(threads))
    # Those of no rows at all: a row of noughts for each face, and lines that do not fit are refused here.
    sums = run(_core.sum_faces, grid, (map.height, 0), (0, 0), directions, lines, 1)
    if far is not None:
        sources = [(far, span, span) for span in spans]  # a face needs no rows beside the band: they are not read again
    tasks = [(*source, map.height, meaning, directions, lines) for source in sources]
    for which, rows in gather(client, add_faces, tasks):
        sums[which] += rows
    parts_known = {"gradients": gradients, "directions": directions, "lines": lines, "sums": sums}
    made = surveyed(map, parameters, threads, own, parts_known, keep=keep)
    if not exact:
        made.__dict__["_map"] = None  # its pixels are not the map's
    return made, map


def cut(shape: tuple[int, int], block: int, client: Any) -> list[Span]:
    """Bands of rows, whole blocks each: from, to, from the top down."""
    height, width = shape
    threads = max(1, sum(client.nthreads().values()))
    rows = min(max(ROWS, -(-height // (SHARES * threads))), max(1, PIXELS // width))
    rows = -(-rows // block) * block
    return [(top, min(top + rows, height)) for top in range(0, height, rows)]


def gather(client: Any, task: Callable[..., R], given: list[tuple[Any, ...]]) -> Iterator[R]:
    """What the workers make of each, in order; what is left is called off when one fails.

    Raises
    ------
    GroundplanError
        What a worker raised; ``cluster.version`` where its method is another, ``cluster.failed`` for all that is not
        ours.
    """
    futures = [client.submit(there, _core.version(), task, *words, pure=False) for words in given]
    try:
        for future in futures:
            made: R = future.result()
            future.release()
            yield made
    except GroundplanError as fault:
        if fault.code == "map.missing":
            hint = "workers read the map themselves: its path has to be the same on their machines"
            raise MapError("cluster.path", f"a worker has no such file: {fault}", hint) from fault
        raise
    except Exception as fault:  # of Dask, of the network, of another version of Groundplan over there
        said = f"the cluster failed: {type(fault).__name__}: {' '.join(str(fault).split())}"
        raise GroundplanError(
            "cluster.failed", said, "its workers need groundplan and dask of these versions"
        ) from fault
    finally:
        client.cancel([future for future in futures if not future.done()])


def there(version: str, task: Callable[..., R], *words: Any) -> R:
    """On a worker: a task, by the same method as here."""
    if version != _core.version():
        said = f"a worker has groundplan {_core.version()}, and {version} is asked of it"
        raise GroundplanError("cluster.version", said, "the same version everywhere gives the same survey")
    return task(*words)
