"""How long the program and the package take to start: medians of five, warm.

Ends with exit code 1 when a bar is missed: ``--help`` within 0.3 s, the package within 1.3 times numpy.
"""

from __future__ import annotations

import argparse
import statistics
import subprocess
import sys
import sysconfig
import time
from pathlib import Path

RUNS = 5
HELP_S, RATIO = 0.3, 1.3

PROGRAM = Path(sysconfig.get_path("scripts")) / "groundplan"
COMMANDS = {
    "python -c pass": [sys.executable, "-c", "pass"],
    "import numpy": [sys.executable, "-c", "import numpy"],
    "import groundplan": [sys.executable, "-c", "import groundplan"],
    "from groundplan import *": [sys.executable, "-c", "from groundplan import *"],
    "groundplan --help": [str(PROGRAM), "--help"],
    "groundplan survey --help": [str(PROGRAM), "survey", "--help"],
}


def seconds(command: list[str]) -> float:
    """Wall time of one run."""
    start = time.perf_counter()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return time.perf_counter() - start


def main() -> int:
    """Measure, print the table, hold it to the bars."""
    argparse.ArgumentParser(description=__doc__).parse_args()
    for command in COMMANDS.values():
        seconds(command)
    # In turns, so that what else the computer does falls on all of them alike.
    times: dict[str, list[float]] = {name: [] for name in COMMANDS}
    for _ in range(RUNS):
        for name, command in COMMANDS.items():
            times[name].append(seconds(command))
    medians = {name: statistics.median(values) for name, values in times.items()}
    numpy = medians["import numpy"]
    print(f"{'':26}  seconds  of numpy  bar")
    missed = False
    for name, median in medians.items():
        bar = ""
        if name in ("import groundplan", "groundplan --help"):
            helped = name.endswith("--help")
            met = median < HELP_S if helped else median <= RATIO * numpy
            missed |= not met
            bar = (f"< {HELP_S} s" if helped else f"<= {RATIO} of numpy") + ("" if met else "  MISSED")
        print(f"{name:26}  {median:7.3f}  {median / numpy:8.2f}  {bar}".rstrip())
    return int(missed)


if __name__ == "__main__":
    sys.exit(main())
