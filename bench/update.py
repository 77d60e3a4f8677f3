"""What a changed patch costs against a full survey, and a cluster's bytes against one thread's: bench/update.py [SIDE].

The example warehouse is laid side by side to SIDE x SIDE pixels (8,000). Patches of 512 x 512 pixels, each turned round
where it lies, are put in one after another; medians, in turns with full surveys of the same maps, whose bytes they are
held to. With labels by the default method, and by the paper's, which is cheap: what is left then are the stages before
the labels. The map is then surveyed from a Zarr array by four worker processes on this machine.

Ends with exit code 1 when bytes differ, or when an update costs more than a twentieth of a full survey.
"""

from __future__ import annotations

import argparse
import os
import platform
import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any, TypeVar

from _maps import laid_out

import groundplan as gp
from groundplan import Map
from groundplan._cli.arguments import count

SIDE, PATCH, RUNS = 8000, 512, 3
BAR = 1 / 20

R = TypeVar("R")


def timed(task: Callable[[], R], clock: Callable[[], float] = time.perf_counter) -> tuple[float, R]:
    """Seconds that a task takes, and what it makes."""
    since = clock()
    made = task()
    return clock() - since, made


def updates(map: Map, threads: int, **parameters: Any) -> tuple[float, float, bool]:
    """Median seconds of an update and of a full survey, of one thread those of its core; if all bytes are the same."""
    clock = time.process_time if threads == 1 else time.perf_counter
    survey = gp.survey(map, threads=threads, keep=True, **parameters)
    now, short, long, same = map, [], [], True
    for run in range(RUNS):
        row, column = (int((0.2 + 0.3 * run) * (n - PATCH)) for n in map.pixels.shape)
        patch = now.pixels[row : row + PATCH, column : column + PATCH][::-1, ::-1].copy()
        pixels = now.pixels.copy()
        pixels[row : row + PATCH, column : column + PATCH] = patch
        now = replace(now, pixels=pixels)
        spent, survey = timed(partial(survey.update, patch, row, column, threads=threads), clock)
        short.append(spent)
        spent, full = timed(partial(gp.survey, now, threads=threads, **parameters), clock)
        long.append(spent)
        same &= survey.to_json() == full.to_json()
    return statistics.median(short), statistics.median(long), same


def on_four_workers(map: Map) -> tuple[float, float, bool]:
    """Seconds of a survey from a Zarr array, by four worker processes and by one thread, and if the bytes agree."""
    import distributed
    import zarr

    with tempfile.TemporaryDirectory() as folder:
        path = f"{folder}/big.zarr"
        array = zarr.create_array(path, shape=map.pixels.shape, chunks=(1024, 1024), dtype="u1")
        array[:] = map.pixels
        array.attrs.update(resolution=map.resolution, origin=map.origin)
        workers = {"n_workers": 4, "threads_per_worker": 1, "processes": True, "host": "127.0.0.1"}
        with (
            distributed.LocalCluster(dashboard_address="127.0.0.1:0", **workers) as cluster,
            distributed.Client(cluster, set_as_default=False) as client,
        ):
            client.wait_for_workers(4)
            many_s, many = timed(lambda: gp.survey(path, client=client))
        one_s, one = timed(lambda: gp.survey(gp.read(path), threads=1))
        return many_s, one_s, many.to_json() == one.to_json()


def main() -> int:
    """Measure, print, hold to the bar."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("side", nargs="?", type=count, default=SIDE)
    side = parser.parse_args().side
    map, missed = laid_out(side), False
    print(f"{platform.machine()}, {os.cpu_count()} cores; {side} x {side} pixels, {PATCH} x {PATCH} of them changed")
    print(f"{'labels':10}{'threads':>8}{'update s':>10}{'survey s':>10}{'ratio':>8}  bar <= {BAR:g}")
    for method in ("strips", "paper"):
        for threads in (1, 4):
            short, long, same = updates(map, threads, labels_method=method)
            over = short > BAR * long
            missed |= over or not same
            said = ("  MISSED" if over else "") + ("" if same else "  OTHER BYTES")
            print(f"{method:10}{threads:8}{short:10.3f}{long:10.3f}{short / long:8.3f}{said}", flush=True)
    try:
        many, one, same = on_four_workers(map)
    except ImportError as fault:
        print(f"four workers: not measured, {fault}")
        return int(missed)
    print(f"from a Zarr array: four workers {many:.2f} s, one thread {one:.2f} s, {'same' if same else 'OTHER'} bytes")
    return int(missed or not same)


if __name__ == "__main__":
    sys.exit(main())
