"""Regions on Bormann et al.'s maps, bare and furnished: scores against their ground truth, and the time a survey takes.

Needs ../shared (maps/bormann and tools/evaluate_*.py) beside the repository, and OpenCV. Prints a table; says so and
does nothing where they are not there. `bench/rooms.py name=value ...` sets parameters.
"""

import argparse
import json
import sys
import time
from pathlib import Path

import groundplan as gp

SHARED = Path(__file__).resolve().parents[2] / "shared"
SETS = {"bare": "", "furnished": "_furnitures", "furnished, bins": "_furnitures_trashbins"}


def main() -> None:
    """Survey every map and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("settings", nargs="*", metavar="name=value")
    settings = parser.parse_args().settings
    sys.path.insert(0, str(SHARED / "tools"))
    try:
        import cv2
        from evaluate_regions import drop_small, evaluate, label_image, read_gt
    except ImportError as error:
        print(f"rooms: not measured, {error}")
        return
    parameters = {name: float(value) for name, value in (s.split("=") for s in settings)}
    maps = SHARED / "maps" / "bormann"
    names = sorted(path.name.removesuffix(".gt.png") for path in maps.glob("*.gt.png"))
    print(f"{'map':40} iou_1to1   mcc   n_gt  n_seg  doors     ms")
    for title, suffix in SETS.items():
        rows = []
        for name in names:
            grid = gp.read(maps / f"{name}{suffix}.yaml")
            start = time.perf_counter()
            survey = gp.survey(grid, threads=1, **parameters)
            took = 1e3 * (time.perf_counter() - start)
            grey = cv2.imread(str(maps / f"{name}{suffix}.png"), cv2.IMREAD_GRAYSCALE)
            document = json.loads(survey.to_json())
            labels = label_image(document, grey >= 250)
            score = evaluate(drop_small(labels), read_gt(str(maps / f"{name}.gt.png")))
            doors = sum(label["kind"] == "door" for label in document["labels"])
            rows.append((score["iou_1to1"], score["mcc"], score["n_gt"], score["n_seg"], doors, took))
            print(
                f"{name + suffix:40} {rows[-1][0]:8.3f} {rows[-1][1]:5.3f} {rows[-1][2]:6} {rows[-1][3]:6}"
                f" {doors:6} {took:6.0f}"
            )
        means = [sum(column) / len(rows) for column in zip(*rows, strict=True)]
        print(
            f"{'mean, ' + title:40} {means[0]:8.3f} {means[1]:5.3f} {means[2]:6.1f} {means[3]:6.1f}"
            f" {means[4]:6.1f} {means[5]:6.0f}\n"
        )


if __name__ == "__main__":
    main()
