"""What a survey costs against opening the map's picture (``cv2.imread``) and against ``cv2.Sobel``, stage by stage.

Medians; what a ratio is made of is measured in turns in one run. On Bormann et al.'s maps (../shared/maps/bormann; the
mean over them) and on the example's warehouse laid side by side to 4000 x 4000 pixels; then a survey from the shell.
Ends with exit code 1 when a bar is missed. Needs OpenCV. ``bench/survey.py RUNS`` measures so many (default 5).
"""

from __future__ import annotations

import argparse
import os
import platform
import statistics
import subprocess
import sys
import sysconfig
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from _maps import laid_out

import groundplan as gp
from groundplan import Map
from groundplan._cli.arguments import count

ROOT = Path(__file__).resolve().parents[1]
BORMANN = ROOT.parent / "shared" / "maps" / "bormann"
SIDE = 4000
THREADS = (1, 2, 4)
#: Survey over imread on one thread and on four, and at 4000 x 4000 on four; directions and radiograms over Sobel.
ONE, FOUR, LARGE, SOBEL = 2.5, 1.0, 1.0, 3.0
#: From the shell, one megapixel, seconds.
SHELL_S = 0.6

Stages = dict[str, Callable[[], Any]]


def stages(map: Map, threads: int) -> Stages:
    """Each stage as a call, over what the ones before it made."""
    survey = gp.survey(map, threads=threads)
    gradients = gp.find_gradients(map, threads=threads)
    directions, lines, cut = survey.directions, survey.lines, survey.subdivision
    occupancy, walls = survey.occupancy, survey.walls
    return {
        "gradients": lambda: gp.find_gradients(map, threads=threads),
        "directions": lambda: gp.find_directions(map, gradients, threads=threads),
        "radiograms": lambda: gp.find_radiograms(map, directions, gradients, threads=threads),
        "lines": lambda: gp.find_lines(survey.radiograms),
        "rack faces": lambda: gp.add_rack_faces(map, directions, lines, gradients, threads=threads),
        "subdivision": lambda: gp.subdivide(map, directions, lines, threads=threads),
        "occupancy": lambda: gp.find_occupancy(map, directions, lines, gradients, threads=threads),
        "walls": lambda: gp.find_walls(cut, occupancy),
        "adjacency": lambda: gp.find_adjacency(cut, walls),
        "labels": lambda: gp.find_labels(map, directions, lines, occupancy, walls, gradients, threads=threads),
        "survey": lambda: gp.survey(map, threads=threads),
    }


def medians(tasks: Stages, runs: int) -> dict[str, float]:
    """Median milliseconds of each, in turns so that what else the computer does falls on all of them alike."""
    times: dict[str, list[float]] = {name: [] for name in tasks}
    for _ in range(runs):
        for name, task in tasks.items():
            start = time.perf_counter()
            task()
            times[name].append(1e3 * (time.perf_counter() - start))
    return {name: statistics.median(spent) for name, spent in times.items()}


def measured(cases: list[tuple[Map, Path]], threads: int, runs: int) -> dict[str, float]:
    """Mean milliseconds over the maps, of the stages and of OpenCV on the same pictures."""
    import cv2

    cv2.setNumThreads(threads)
    rows = []
    for map, picture in cases:
        grey = cv2.imread(str(picture), cv2.IMREAD_GRAYSCALE)

        def sobel(grey: Any = grey) -> None:
            cv2.Sobel(grey, cv2.CV_32F, 1, 0)
            cv2.Sobel(grey, cv2.CV_32F, 0, 1)

        def imread(picture: Path = picture) -> None:
            cv2.imread(str(picture), cv2.IMREAD_GRAYSCALE)

        rows.append(medians({"cv2.imread": imread, "cv2.Sobel x, y": sobel} | stages(map, threads), runs))
    return {name: statistics.mean(row[name] for row in rows) for name in rows[0]}


def table(title: str, columns: dict[int, dict[str, float]]) -> None:
    """Milliseconds, a row for each stage, a column for each number of threads."""
    print(f"\n{title}\n{'ms, threads':20}" + "".join(f"{threads:10}" for threads in columns))
    for name in next(iter(columns.values())):
        print(f"{name:20}" + "".join(f"{column[name]:10.2f}" for column in columns.values()))


def shell(folder: Path, runs: int) -> dict[str, float]:
    """Median seconds of `groundplan survey` on a map of one megapixel, with its picture and without."""
    import cv2

    cv2.imwrite(str(folder / "one.pgm"), laid_out(1000).pixels)
    program = str(Path(sysconfig.get_path("scripts")) / "groundplan")
    command = [program, "survey", str(folder / "one.pgm"), "--resolution", "0.05", "-o", str(folder / "out"), "-q"]

    def run(more: list[str]) -> Callable[[], object]:
        return lambda: subprocess.run(command + more, check=True)

    tasks = {"with survey.png": run([]), "--no-picture": run(["--no-picture"])}
    medians(tasks, 1)
    return {name: spent / 1e3 for name, spent in medians(tasks, runs).items()}


def main() -> int:
    """Measure, print the tables, hold them to the bars."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("runs", nargs="?", type=count, default=5)
    runs = parser.parse_args().runs
    try:
        import cv2
    except ImportError as error:
        print(f"survey: not measured, {error}")
        return 0
    print(f"{platform.machine()}, {os.cpu_count()} cores; medians of {runs}")
    bars: list[tuple[str, float, float]] = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        pictures = [path.with_suffix(".png") for path in sorted(BORMANN.glob("*.yaml"))]
        if pictures:
            cases = [(gp.read(path.with_suffix(".yaml")), path) for path in pictures]
            columns = {threads: measured(cases, threads, runs) for threads in THREADS}
            pixels = statistics.mean(map.pixels.size for map, _ in cases)
            table(f"{len(cases)} maps of Bormann et al., {pixels / 1e6:.2f} Mpx in the mean", columns)
            ratio = {threads: column["survey"] / column["cv2.imread"] for threads, column in columns.items()}
            one = columns[1]
            found = one["gradients"] + one["directions"] + one["radiograms"]
            bars += [
                ("survey / imread, 1 thread", ratio[1], ONE),
                ("survey / imread, 4 threads", ratio[4], FOUR),
                ("gradients, directions, radiograms / Sobel", found / one["cv2.Sobel x, y"], SOBEL),
                ("directions, radiograms / Sobel", (found - one["gradients"]) / one["cv2.Sobel x, y"], SOBEL),
            ]
        else:
            print(f"no maps in {BORMANN}: not measured on them")
        large = laid_out(SIDE)
        cv2.imwrite(str(folder / "large.png"), large.pixels)
        columns = {threads: measured([(large, folder / "large.png")], threads, min(runs, 3)) for threads in THREADS}
        table(f"{SIDE} x {SIDE}", columns)
        bars.append(("survey / imread, 4000 x 4000, 4 threads", columns[4]["survey"] / columns[4]["cv2.imread"], LARGE))
        spent = shell(folder, runs)
        print("\ngroundplan survey, 1 Mpx, process start to files written, seconds")
        for name, seconds in spent.items():
            print(f"{name:20}{seconds:10.2f}")
        bars.append(("groundplan survey --no-picture, 1 Mpx, seconds", spent["--no-picture"], SHELL_S))
    print()
    for what, value, bar in bars:
        print(f"{what:48}{value:9.2f}  bar <= {bar:g}{'' if value <= bar else '  MISSED'}")
    return int(any(value > bar for _, value, bar in bars))


if __name__ == "__main__":
    sys.exit(main())
