"""groundplan evaluate: scores of a survey against a truth, or of the method on a suite."""

from __future__ import annotations

import argparse
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from groundplan._cli import terminal
from groundplan._cli.arguments import count

#: What each score is called, its unit, and its decimals.
SCORES = {
    "direction_error_deg": ("greatest error of a direction", " deg", 3),
    "direction_extra": ("directions too many", "", 0),
    "line_recall": ("lines found, of their length", "", 3),
    "line_error_m": ("error of a line, median", " m", 3),
    "junction_f1": ("junctions, F1", "", 3),
    "junction_typed_f1": ("junctions of the right type, F1", "", 3),
    "corridor_recall": ("corridors found, of their length", "", 3),
    "corridor_precision": ("corridors that are ones, of their area", "", 3),
    "pillar_f1": ("pillars, F1", "", 3),
    "pitch_recall": ("racks with the right pitch", "", 3),
    "pitch_error_m": ("error of a rack's pitch, median", " m", 3),
    "rack_recall": ("racks found", "", 3),
    "rack_precision": ("racks that are ones", "", 3),
    "hall_recall": ("halls found", "", 3),
    "hall_precision": ("regions in halls that are halls", "", 3),
    "iou_1to1": ("rooms found, one to one, of their union", "", 3),
    "mcc": ("agreement on rooms, Matthews", "", 3),
    "rooms": ("rooms", "", 0),
    "regions": ("regions found", "", 0),
    "joins_missing": ("aisles that meet and are not joined, pairs", "", 0),
    "joins_extra": ("aisles that are joined and do not meet, pairs", "", 0),
    "lane_elsewhere_m": ("lanes that follow no aisle", " m", 1),
    "lane_error_m": ("lanes off their aisle's centre line, at most", " m", 3),
    "lane_clearance_m": ("from lanes to what is occupied, at least", " m", 3),
    "node_ratio": ("nodes, of junctions, ends and pick faces", "", 3),
}

SCORES |= {
    f"{score}_{kind}": (f"{kind} {word}", "", 3)
    for score, word in (("names", "by the same name"), ("found", "found again"))
    for kind in ("aisles", "regions", "racks", "pillars")
}

#: Columns of the suite's table: those before the labels are the same for every method.
BEFORE = {"direction_error_deg": "error", "direction_extra": "extra", "line_recall": "lines"}
LABELS = {
    "junction_f1": "F1",
    "junction_typed_f1": "typed",
    "corridor_recall": "recall",
    "corridor_precision": "prec",
    "rack_recall": "racks",
    "rack_precision": "prec",
    "hall_recall": "halls",
    "hall_precision": "prec",
}
#: Of the suite of names, in place of those: kept, and found again by whatever name.
NAMES = {
    "names_aisles": "aisles",
    "found_aisles": "(found)",
    "names_regions": "regions",
    "found_regions": "(found)",
    "names_racks": "racks",
    "found_racks": "(found)",
}
#: Of a suite of rooms, in place of those.
REGIONS = {"iou_1to1": "IoU", "mcc": "MCC", "rooms": "rooms", "regions": "found"}
#: Of a suite of road maps.
ROADS = {
    "joins_missing": "missing",
    "joins_extra": "extra",
    "lane_elsewhere_m": "elsewhere",
    "lane_error_m": "off",
    "lane_clearance_m": "clear",
    "node_ratio": "nodes",
}


def fill(own: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    own.usage = "groundplan evaluate (SURVEY TRUTH | --suite NAME) [--json] [flags]"
    own.add_argument("survey", metavar="SURVEY", nargs="?", help="a survey.json, or the directory that holds it")
    own.add_argument("truth", metavar="TRUTH", nargs="?", help="a truth.json, as groundplan simulate writes it")
    own.add_argument("--json", action="store_true", help="print the scores as JSON")
    group = own.add_argument_group("a suite of maps")
    group.add_argument(
        "--suite",
        metavar="NAME",
        help="survey and score each of its cases: warehouses, roadmaps, offices, rooms, names or confidence",
    )
    group.add_argument(
        "--maps",
        metavar="DIR",
        help="where the maps of the suite rooms lie (default: $GROUNDPLAN_ROOM_MAPS, or ../shared/maps/bormann)",
    )
    group.add_argument(
        "--methods",
        type=lambda text: [part.strip() for part in text.split(",")],
        metavar="LIST",
        help="values of labels.method to compare (default: the default method, and paper, Algorithm 1 as printed)",
    )
    group.add_argument("--workers", type=count, metavar="N", help="processes (default: one for each core)")


def run(arguments: argparse.Namespace) -> None:
    """Score a survey, or run a suite."""
    if arguments.suite is not None:
        if arguments.survey is not None:
            arguments.parser.error("--suite makes its own surveys: give either that or SURVEY TRUTH")
        _run_suite(arguments)
        return
    if arguments.truth is None:
        arguments.parser.error("a SURVEY and its TRUTH are needed, or --suite NAME")
    for flag in ("methods", "workers", "maps"):
        if getattr(arguments, flag) is not None:
            arguments.parser.error(f"--{flag} goes with --suite")
    from groundplan._cli.figures import survey_file
    from groundplan.evaluate import score

    scores = score(survey_file(Path(arguments.survey)), arguments.truth)
    if arguments.json:
        _put_json(scores)
        return
    rows = []
    for key, figure in scores.items():
        name, unit, decimals = SCORES.get(key, (key, "", 3))
        rows.append((name, _shown(figure, decimals), unit.strip()))
    terminal.put("\n".join(terminal.columns(rows, "<>")) + "\n")


def _run_suite(arguments: argparse.Namespace) -> None:
    if arguments.suite == "confidence":
        _run_confidence(arguments)
        return
    from groundplan.evaluate import _suite

    with terminal.status() as status:
        result = _suite.run(
            arguments.suite,
            arguments.methods,
            workers=arguments.workers,
            maps=arguments.maps,
            progress=lambda done, total: status(f"{done} of {total} cases"),
        )
    if arguments.json:
        _put_json(result)
    else:
        terminal.put(suite_table(result))


def _run_confidence(arguments: argparse.Namespace) -> None:
    from groundplan.evaluate import _suite

    for flag in ("methods", "maps"):
        if getattr(arguments, flag) is not None:
            arguments.parser.error(f"--{flag} does not go with --suite confidence")
    with terminal.status() as status:
        result = _suite.reliability(
            workers=arguments.workers, progress=lambda done, total: status(f"{done} of {total} cases")
        )
    if arguments.json:
        _put_json(result)
        return
    bins = [f"to {row['to']:g}" for row in result["all"]]
    rows = [["labels right of", *bins]]
    for kind, parts in result.items():
        rows.append([kind, *(_right(part) for part in parts)])
    terminal.put("\n".join(terminal.columns(rows, "<" + ">" * len(bins))) + "\n")


def _right(part: dict[str, Any]) -> str:
    return "-" if part["right"] is None else f"{part['right']:.2f} of {part['labels']}"


def _put_json(tree: dict[str, Any]) -> None:
    import json

    terminal.put(json.dumps(tree, indent=1, ensure_ascii=False) + "\n")


def _shown(figure: float | None, decimals: int) -> str:
    return "-" if figure is None else f"{figure:.{decimals}f}"


def suite_table(result: dict[str, Any]) -> str:
    """A line for each case, the means and the worst; the methods side by side where the terminal has room."""
    methods: list[str] = result["methods"]
    rows = [(case["name"], case["kind"], case["scores"]) for case in result["cases"]]
    rows += [("mean", kind, part["means"]) for kind, part in result["kinds"].items() if len(result["kinds"]) > 1]
    rows += [(name, "all", result[key]) for name, key in (("mean", "means"), ("worst", "worst"))]
    below = len(rows) - len(result["cases"])
    known = result["means"][methods[0]]
    mine = LABELS | REGIONS | NAMES | ROADS
    same, apart = ({k: name for k, name in part.items() if k in known} for part in (BEFORE, mine))
    head = ["case", "kind", *same.values()]
    first = [[name, kind, *_cells(by[methods[0]], same)] for name, kind, by in rows]
    cases = _block("", head, first, below)
    blocks = [_block(m, [*apart.values()], [_cells(by[m], apart, 2) for *_, by in rows], below) for m in methods]
    side_by_side = _beside(cases, *blocks)
    if terminal.has_room(len(side_by_side[1])):
        return "\n".join(side_by_side) + "\n"
    return "\n\n".join("\n".join(_beside(cases, block)) for block in blocks) + "\n"


def _cells(scores: dict[str, Any], keys: Iterable[str], decimals: int | None = None) -> list[str]:
    return [_shown(scores[key], min(SCORES[key][2], 9 if decimals is None else decimals)) for key in keys]


def _block(title: str, head: list[str], rows: list[list[str]], below: int) -> list[str]:
    """Lines of one width: the title, the names of the columns, the rows, and rules round all but the last `below`."""
    lines = terminal.columns([head, *rows], "<<" * (head[0] == "case") + ">" * len(head))
    rule = "-" * max(map(len, lines))
    return [line.ljust(len(rule)) for line in (title, lines[0], rule, *lines[1:-below], rule, *lines[-below:])]


def _beside(*blocks: list[str]) -> list[str]:
    return ["   ".join(parts).rstrip() for parts in zip(*blocks, strict=True)]
