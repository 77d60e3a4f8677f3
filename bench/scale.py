"""What a survey with labels costs as maps grow: seconds, and the memory that it holds beyond the map's mapped pages.

Simulated halls, each of its own kind, stand side by side on 200 x 200 m; larger maps are so many of these as they have
room for. Each is a PGM, read by memory map and surveyed with the defaults in a process of its own. Linux only. Ends
with exit code 1 when a bar is missed: 1 GiB at 1600 megapixels, and for a pixel 1.3 times what one costs on 16.
``bench/scale.py 16 64`` measures these sizes only, ``--threads 1`` on so many threads. With ``--write`` each map is
surveyed once more and the survey written. With ``--dask`` each map is surveyed by four worker processes on this machine
too, and the bytes of that survey are held to those from one thread.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from _watched import watched

import groundplan
from groundplan._cli.arguments import count
from groundplan._tree import written
from groundplan.simulate import office, warehouse

SIZES = (1, 4, 16, 64, 256, 1600)
RESOLUTION = 0.05
#: Pixels along the side of the piece that is laid out again and again, and of the place of one hall in it.
PIECE, PLACE = 4000, 1333
BAR_MIB, BAR_RATIO = 1024, 1.3

HALLS: tuple[dict[str, Any], ...] = (
    {"width": 62, "depth": 60},
    {"width": 58, "depth": 62, "bay": 3.3, "aisle": 2.4, "rack_depth": 0.9},
    {"width": 60, "depth": 56, "uneven": 0.6, "clutter": 1.2},
    {"width": 63, "depth": 50, "pillars": 12.0, "aisle": 4.2},
    {"width": 28, "depth": 60, "halls": 2, "gap": 3.0},
    {"width": 60, "depth": 61, "staggered": 12.0, "cross_aisles": 2},
    {"width": 61, "depth": 58, "sparse": 0.5, "bay": 1.9},
    {"width": 55, "depth": 62, "goods": 2.0, "drift": 0.1},
)

#: Surveys a map and says what that took.
CHILD = """
import json, re, sys, time
import groundplan
map = groundplan.read(sys.argv[1], resolution=float(sys.argv[2]), origin=(0, 0))
print("ready", flush=True)
sys.stdin.readline()
since, cpu = time.perf_counter(), time.process_time()
survey = groundplan.survey(map, threads=int(sys.argv[3]) or None)
if sys.argv[4]:
    survey.write(sys.argv[4])
spent = time.perf_counter() - since, time.process_time() - cpu
counts = [int(re.search(rf"(\\d+) {what}", repr(survey))[1]) for what in ("lines", "faces", "labels")]
print(json.dumps([*spent, *counts]), flush=True)
"""


def piece() -> npt.NDArray[np.uint8]:
    """Halls of all kinds and an office, side by side."""
    pixels = np.full((PIECE, PIECE), 205, np.uint8)
    maps = [warehouse(seed=seed, **options).map for seed, options in enumerate(HALLS)] + [office(seed=1).map]
    for n, map in enumerate(maps):
        row, column = (PLACE * k for k in divmod(n, 3))
        hall = np.asarray(map.pixels)[:PLACE, :PLACE]
        pixels[row : row + hall.shape[0], column : column + hall.shape[1]] = hall
    return pixels


def write(path: Path, one: npt.NDArray[np.uint8], side: int) -> None:
    """A square PGM of the piece again and again, a row of pieces at a time."""
    wide = np.tile(one, (1, -(-side // PIECE)))[:, :side]
    with path.open("wb") as file:
        file.write(b"P5\n%d %d\n255\n" % (side, side))
        for row in range(0, side, PIECE):
            wide[: side - row].tofile(file)


def measure(path: Path, threads: int, out: str = "") -> tuple[list[float], int]:
    """Seconds, seconds of all cores, lines, faces and labels; and the most memory beyond what was held before.

    With `out` the survey is written there, which is in the seconds and the memory.
    """
    said, most = watched(["-c", CHILD, str(path), str(RESOLUTION), str(threads), out])
    return json.loads(said), most


def on_four_workers(path: Path) -> tuple[float, float, bool]:
    """Seconds of a survey by four worker processes and by one thread, and whether their bytes agree."""
    import distributed

    def digest(survey: groundplan.Survey) -> str:
        found = hashlib.sha256()
        for piece in written(survey):
            found.update(piece.encode())
        return found.hexdigest()

    frame: dict[str, Any] = {"resolution": RESOLUTION, "origin": (0.0, 0.0, 0.0)}
    workers = {"n_workers": 4, "threads_per_worker": 1, "processes": True, "host": "127.0.0.1"}
    with (
        distributed.LocalCluster(dashboard_address="127.0.0.1:0", **workers) as cluster,
        distributed.Client(cluster, set_as_default=False) as client,
    ):
        client.wait_for_workers(4)
        since = time.perf_counter()
        survey = groundplan.survey(path, client=client, **frame)
        many_s, many = time.perf_counter() - since, digest(survey)
    del survey
    map = groundplan.read(path, **frame)
    since = time.perf_counter()
    survey = groundplan.survey(map, threads=1)
    return many_s, time.perf_counter() - since, many == digest(survey)


def main() -> int:
    """Make the maps, measure, print the table, hold it to the bars."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("sizes", nargs="*", type=count, default=SIZES, help="megapixels")
    parser.add_argument("--threads", type=int, default=0, help="as many as there are cores")
    parser.add_argument(
        "--write", action="store_true", help="survey each again and write survey.json, which takes more"
    )
    parser.add_argument("--dask", action="store_true", help="hold the bytes from four workers to those from one thread")
    words = parser.parse_args()
    if not Path("/proc/self/status").exists():
        print("the memory of a process is only measured on Linux")
        return 0
    one = piece()
    print(f"{'Mpx':>5}{'seconds':>9}{'of cores':>10}{'ns a pixel':>12}{'MiB':>7}{'lines':>7}{'faces':>9}{'labels':>8}")
    costs: dict[int, tuple[float, float]] = {}
    missed = False
    with tempfile.TemporaryDirectory() as directory:
        path = Path(directory) / "map.pgm"
        for size in words.sizes:
            side = round((size * 1e6) ** 0.5)
            write(path, one, side)
            (seconds, cores, *counts), most = measure(path, words.threads)
            costs[size] = (1e9 * cores / side**2, most / 2**20)
            lines, faces, labels = (int(count) for count in counts)
            cost = f"{size:5}{seconds:9.2f}{cores:10.2f}{costs[size][0]:12.1f}{costs[size][1]:7.0f}"
            print(f"{cost}{lines:7}{faces:9}{labels:8}", flush=True)
            if words.write:
                (seconds, *_), most = measure(path, words.threads, str(Path(directory) / "survey.json"))
                print(f"{'':5} with survey.json {seconds:.2f} s, {most / 2**20:.0f} MiB", flush=True)
            if words.dask:
                many_s, one_s, same = on_four_workers(path)
                missed |= not same
                said = f"{'same' if same else 'OTHER'} bytes"
                print(f"{'':5} four workers {many_s:.2f} s, one thread {one_s:.2f} s, {said}", flush=True)
    bars = [("MiB at 1600 Mpx", costs[1600][1], BAR_MIB)] if 1600 in costs else []
    larger = [cost for size, (cost, _) in costs.items() if size > 16]
    if 16 in costs and larger:
        bars.append(("the dearest pixel of larger maps over one of 16 Mpx", max(larger) / costs[16][0], BAR_RATIO))
    for what, value, bar in bars:
        print(f"{what:52}{value:8.2f}  bar <= {bar:g}{'' if value <= bar else '  MISSED'}")
    return int(missed or any(value > bar for _, value, bar in bars))


if __name__ == "__main__":
    sys.exit(main())
