"""A suite from end to end: each case simulated, surveyed by each method, scored."""

from __future__ import annotations

import math
import multiprocessing
import os
import signal
import tempfile
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from groundplan import simulate
from groundplan._errors import GroundplanError
from groundplan._pipeline import survey
from groundplan.evaluate import Case, _reliability, _scores, score, score_regions, suite
from groundplan.evaluate._names import name_scores
from groundplan.evaluate._roads import read_route, road_scores
from groundplan.maps import Map, read
from groundplan.parameters import resolve, table
from groundplan.stages import cores

Answer = TypeVar("Answer")

#: Algorithm 1 of the paper as printed, which every other method is held against.
PRINTED = "paper"

#: Degrees by which the maps of one place are turned against the first.
_TURNED = 0.5


#: In the name of a score that is better the smaller it is.
LESS = ("error", "extra", "missing", "elsewhere", "ratio")


def methods() -> tuple[str, ...]:
    """The default method of labelling, and beside it Algorithm 1 as printed."""
    default = next(row.default for row in table() if row.name == "labels.method")
    return tuple(dict.fromkeys((default, PRINTED)))


def run(
    name: str,
    chosen: Sequence[str] | None = None,
    *,
    workers: int | None = None,
    progress: Callable[[int, int], None] | None = None,
    maps: str | os.PathLike[str] | None = None,
) -> dict[str, Any]:
    """Score methods on every case of a suite.

    Parameters
    ----------
    name
        Of the suite.
    chosen
        Values of ``labels.method``; by default those of `methods`, and of regions the first: the paper has none.
    workers
        Processes; by default one for each core, and 1 is this process. Any number gives the same scores.
    progress
        Called with how many cases are done, and how many there are.
    maps
        Where the maps of the suite ``rooms`` lie.

    Returns
    -------
    dict
        ``suite``; ``methods``; ``cases``, each with its ``name``, ``kind``, ``options`` and, by method, ``scores``;
        ``means`` and ``worst``, by method, each score over the cases; ``kinds``, by kind of case, the same two. A
        score that no case has is None.

    Raises
    ------
    ParameterError
        ``suite.unknown``, or a method that is none.
    GroundplanError
        ``extra.missing`` without SciPy or Shapely, ``suite.worker`` when a worker process ends early.
    """
    cases = suite(name, maps)
    usual = methods() if name == "warehouses" else methods()[:1]
    labellers = tuple(dict.fromkeys(chosen or usual))
    for method in labellers:
        resolve({"labels.method": method})
    for module in ("scipy.optimize", "shapely"):
        _scores.optional(module)
    scores = _each_case(partial(_case, labellers=labellers), cases, workers or cores(), progress or (lambda *_: None))
    kinds = {
        kind: _summary([by for case, by in zip(cases, scores, strict=True) if case.kind == kind], labellers)
        for kind in dict.fromkeys(case.kind for case in cases)
    }
    return {
        "suite": name,
        "methods": list(labellers),
        "cases": [
            {"name": case.name, "kind": case.kind, "options": case.options, "scores": by_method}
            for case, by_method in zip(cases, scores, strict=True)
        ],
        **_summary(scores, labellers),
        "kinds": kinds,
    }


def reliability(
    *, workers: int | None = None, progress: Callable[[int, int], None] | None = None
) -> dict[str, list[dict[str, Any]]]:
    """Whether confidence means something: of the labels of each confidence, the share that is right.

    Over the simulated warehouses and offices. By kind of label, and for all: a list of bins, each with its upper end
    ``to``, how many ``labels`` it has, and the share ``right``, None without any.
    """
    for module in ("scipy.optimize", "shapely"):
        _scores.optional(module)
    cases = suite("confidence")
    found = _each_case(_judged, cases, workers or cores(), progress or (lambda *_: None))
    return _reliability.table([entry for entries in found for entry in entries])


def _judged(case: Case) -> list[_reliability.Judged]:
    make: Callable[..., simulate.Simulated] = getattr(simulate, case.place)
    made = make(**case.options)
    return _reliability.judged(survey(made.map, threads=1).to_dict(), made.truth)


def _summary(scores: list[dict[str, dict[str, Any]]], labellers: tuple[str, ...]) -> dict[str, Any]:
    """Mean and worst of every score, by method."""
    return {
        name: {method: _over(figure, [by[method] for by in scores]) for method in labellers}
        for name, figure in (("means", _mean), ("worst", _worst))
    }


def _each_case(
    job: Callable[[Case], Answer], cases: list[Case], workers: int, progress: Callable[[int, int], None]
) -> list[Answer]:
    """What a job makes of each case, in the order of the cases."""
    if workers == 1:
        answers = []
        for case in cases:
            answers.append(job(case))
            progress(len(answers), len(cases))
        return answers
    # Spawned, not forked: the same on every system, and safe whatever threads the caller has.
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(min(workers, len(cases)), context, _die_of_interrupts) as pool:
        try:
            futures = [pool.submit(job, case) for case in cases]
            for done, future in enumerate(as_completed(futures), start=1):
                future.result()
                progress(done, len(cases))
            return [future.result() for future in futures]
        except BrokenProcessPool as fault:
            raise GroundplanError(
                "suite.worker",
                "a worker process ended before its case was done",
                "fewer --workers need less memory; a script that starts this guards it by if __name__ == '__main__'",
            ) from fault
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def _die_of_interrupts() -> None:
    """Ctrl-C reaches the whole group of processes: a worker goes at once and without a word."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def _case(case: Case, labellers: tuple[str, ...]) -> dict[str, dict[str, Any]]:
    """Scores of one case by method."""
    if "remakes" in case.options:
        return {method: remade(case, method) for method in labellers}
    if case.place == "warehouse":
        made = simulate.warehouse(**case.options)
        return _each(labellers, made.map, lambda found: score(found, made.truth))
    if case.place == "office":
        made = simulate.office(**case.options)
        rooms = made.rooms
        assert rooms is not None
        return _each(labellers, made.map, lambda found: _office(found, made, rooms))
    if case.place == "roads":
        made = simulate.warehouse(**case.options)
        return {method: _roads(made, method) for method in labellers}
    map = read(case.options["map"])
    return _each(labellers, map, lambda found: score_regions(found, map, case.options["truth"]))


def _roads(made: simulate.Simulated, method: str) -> dict[str, Any]:
    """Of the road map as a planner gets it: the written file."""
    found = survey(made.map, threads=1, labels_method=method)
    with tempfile.TemporaryDirectory() as directory:
        (file,) = found.export(Path(directory) / "roads.route.geojson", "nav2", map=made.map)
        return road_scores(*read_route(file), made.truth, made.map)


def remade(case: Case, method: str) -> dict[str, Any]:
    """Names over several maps of one place, each but the first turned by half a degree one way or the other."""
    make: Callable[..., simulate.Simulated] = getattr(simulate, case.place)
    options = {key: value for key, value in case.options.items() if key != "remakes"}
    yaw = options.pop("yaw", 0.0)
    surveys = []
    for remake in range(1 + case.options["remakes"]):
        made = make(yaw=yaw + (_TURNED if remake % 2 else -_TURNED) * bool(remake), remake=remake, **options)
        surveys.append((survey(made.map, threads=1, labels_method=method).to_dict(), made.truth))
    return name_scores(*surveys[0], surveys[1:])


def _office(found: dict[str, Any], made: simulate.Simulated, rooms: npt.NDArray[np.uint8]) -> dict[str, Any]:
    """An office's lines and regions; its few corridors say little."""
    lines = {key: value for key, value in score(found, made.truth).items() if key.startswith(("direction", "line"))}
    return lines | score_regions(found, made.map, rooms)


def _each(
    labellers: tuple[str, ...], map: Map, scored: Callable[[dict[str, Any]], dict[str, Any]]
) -> dict[str, dict[str, Any]]:
    return {method: scored(survey(map, threads=1, labels_method=method).to_dict()) for method in labellers}


def _over(kind: Callable[[str, list[float]], float], scores: list[dict[str, Any]]) -> dict[str, float | None]:
    """A figure over the cases for each score, of those that have it."""
    result: dict[str, float | None] = {}
    for key in scores[0]:
        values = [float(entry[key]) for entry in scores if entry[key] is not None]
        result[key] = kind(key, values) if values else None
    return result


def _mean(_: str, values: list[float]) -> float:
    return round(math.fsum(values) / len(values), 4)


def _worst(key: str, values: list[float]) -> float:
    """Errors and what is too much are better small, shares better large."""
    return max(values) if any(word in key for word in LESS) else min(values)
