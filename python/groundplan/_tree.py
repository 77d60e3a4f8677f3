"""The survey as a tree of plain lists and numbers, as docs/survey.md has it, and back."""

from __future__ import annotations

import difflib
import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from groundplan._format import FORMAT, VERSION
from groundplan._results import (
    NONE,
    STATES,
    Adjacency,
    Directions,
    Label,
    Lines,
    MapInfo,
    Occupancy,
    Radiogram,
    Subdivision,
    Walls,
)
from groundplan.maps import MapWarning

if TYPE_CHECKING:
    from groundplan.survey import Survey

#: So many records are written at a time, and so many labels: their outlines may be long.
RECORDS, LABELS = 4096, 64

#: What a label of a kind must have besides its kind.
NEEDED = {
    "corridor": ("polygon", "axis", "width"),
    "junction": ("type", "at"),
    "rack": ("polygon", "axis"),
    "region": ("polygon",),
    "door": ("at",),
    "pillar": ("at",),
}

#: What can be given for reading a map.
READING = (
    *("dialect", "unknown", "negate", "mode", "occupied_thresh", "free_thresh", "resolution", "origin"),
    *("topic", "stamp", "band", "min_hits"),
)


@dataclass(frozen=True)
class Table:
    """Records of a survey that are made some at a time: how many there are, and some of them as plain values."""

    count: int
    some: Callable[[slice], list[Any]]
    at_once: int = 0


def parts(survey: Survey) -> dict[str, Any]:
    """The parts of a survey as the format has them, plain or as a `Table`, in the order in which they are written."""
    cut, measured, walls = survey.subdivision, survey.occupancy, survey.walls
    dual: Adjacency | None = survey.__dict__.get("adjacency")
    # What is not made yet need not be: links are the edges between two faces.
    inner = between_faces(cut.edge_faces) if dual is None else dual.edges
    source = {} if survey.source is None else {"source": {"file": survey.source, "reading": survey.reading}}

    def edges(some: slice) -> list[Any]:
        return rows(
            vertices=cut.edge_vertices[some],
            line=[None if line < 0 else line for line in cut.edge_lines[some].tolist()],
            faces=[[None if f < 0 else f for f in pair] for pair in cut.edge_faces[some].tolist()],
            occupancy=measured.edges[some],
            runs=ragged(measured.runs, measured.run_offsets, some),
            disparity=walls.disparity[some],
            cogent=walls.cogent[some],
        )

    def faces(some: slice) -> list[Any]:
        return rows(
            vertices=ragged(cut.face_vertices, cut.face_offsets, some),
            edges=ragged(cut.face_edges, cut.face_offsets, some),
            centre=cut.centres[some],
            area=cut.areas[some],
            occupancy=measured.faces[some],
            unknown=measured.unknown[some],
            free=measured.free[some],
            pixels=measured.pixels[some],
            state=[STATES[state] for state in measured.states[some].tolist()],
        )

    def links(some: slice) -> list[Any]:
        if dual is not None:
            return rows(faces=dual.faces[some], edge=dual.edges[some], connected=dual.connected[some])
        return rows(faces=cut.edge_faces[inner[some]], edge=inner[some], connected=~walls.cogent[inner[some]])

    def traced(some: slice) -> list[Any]:
        kinds = ["freestanding" if free else "separating" for free in walls.freestanding[some].tolist()]
        return rows(points=walls.points.reshape(-1, 2, 2)[some], line=walls.lines[some], kind=kinds)

    return {
        "format": FORMAT,
        "version": VERSION,
        **source,
        "map": {f.name: getattr(survey.map, f.name) for f in fields(survey.map)} | {"origin": list(survey.map.origin)},
        "parameters": survey.parameters,
        "directions": rows(angle=survey.directions.angles, weight=survey.directions.weights),
        "lines": rows(
            direction=survey.lines.directions,
            offset=survey.lines.offsets,
            amplitude=survey.lines.amplitudes,
            width=survey.lines.widths,
        ),
        "vertices": Table(len(cut.vertices), lambda some: cut.vertices[some].tolist()),
        "edges": Table(len(cut.edge_lines), edges),
        "faces": Table(len(cut.areas), faces),
        "links": Table(len(inner), links),
        "walls": Table(len(walls), traced),
        "labels": survey._label_table(),
        "patterns": survey.patterns,
        "warnings": [{"code": w.code, "message": w.message} for w in survey.warnings],
        "evidence": {
            "histogram": survey.directions.histogram.tolist(),
            "explained": survey.directions.explained,
            "min_amplitude": survey.lines.min_amplitude,
            "radiograms": [
                {"direction": r.direction, "start": r.start, "step": r.step, "values": r.values.tolist()}
                for r in survey.radiograms
            ],
        },
    }


def between_faces(edge_faces: npt.NDArray[np.int32]) -> npt.NDArray[np.uint32]:
    """The edges that have a face on both sides; of a large map they are looked at some at a time, to hold little."""
    found = [np.zeros(0, np.uint32)]
    for first in range(0, len(edge_faces), 1 << 20):
        inner = (edge_faces[first : first + (1 << 20)] != NONE).all(axis=1)
        found.append((first + np.flatnonzero(inner)).astype(np.uint32))
    return np.concatenate(found)


def to_tree(survey: Survey) -> dict[str, Any]:
    """The survey as the format has it: plain lists and numbers."""
    whole = slice(None)
    return {key: part.some(whole) if isinstance(part, Table) else part for key, part in parts(survey).items()}


def written(survey: Survey) -> Iterator[str]:
    """The survey as JSON, piece by piece: of a large one no more than a few thousand records are in memory at once."""
    before = "{\n"
    for key, part in parts(survey).items():
        yield f"{before}{dump(key)}: "
        before = ",\n"
        if not isinstance(part, Table):
            yield dump(part)
            continue
        count = part.at_once or RECORDS
        for first in range(0, part.count, count):
            yield ("," if first else "[") + dump(part.some(slice(first, first + count)))[1:-1]
        yield "]" if part.count else "[]"
    yield "\n}\n"


def from_tree(tree: dict[str, Any]) -> dict[str, Any]:
    """A survey's fields, by name.

    Raises
    ------
    KeyError, TypeError, ValueError, IndexError, AttributeError, OverflowError
        A part is missing, of another type or of another shape.
    """
    source = tree.get("source")
    frame, evidence, faces, edges = tree["map"], tree["evidence"], tree["faces"], tree["edges"]
    x, y, yaw = (float(value) for value in frame["origin"])
    width, height = int(frame["width"]), int(frame["height"])
    info = MapInfo(str(frame["image"]), width, height, float(frame["resolution"]), (x, y, yaw))
    sides, runs = ([len(entry[part]) for entry in of] for of, part in ((faces, "vertices"), (edges, "runs")))
    return {
        "map": info,
        "parameters": tree["parameters"],
        "directions": Directions(
            column(tree["directions"], "angle", np.float64),
            column(tree["directions"], "weight", np.float64),
            np.array(evidence["histogram"], dtype=np.float64),
            float(evidence["explained"]),
        ),
        "radiograms": [
            Radiogram(r["direction"], r["start"], r["step"], np.array(r["values"], dtype=np.float64))
            for r in evidence["radiograms"]
        ],
        "lines": Lines(
            column(tree["lines"], "direction", np.uint32),
            column(tree["lines"], "offset", np.float64),
            column(tree["lines"], "amplitude", np.float64),
            column(tree["lines"], "width", np.float64),
            float(evidence["min_amplitude"]),
        ),
        "subdivision": Subdivision(
            vertices=np.array(tree["vertices"], dtype=np.float64).reshape(-1, 2),
            edge_vertices=column(edges, "vertices", np.uint32).reshape(-1, 2),
            edge_lines=np.array([-1 if e["line"] is None else e["line"] for e in edges], dtype=np.int32),
            edge_faces=np.array([[-1 if f is None else f for f in e["faces"]] for e in edges], dtype=np.int32).reshape(
                -1, 2
            ),
            face_vertices=np.array([v for face in faces for v in face["vertices"]], dtype=np.uint32),
            face_edges=np.array([e for face in faces for e in face["edges"]], dtype=np.uint32),
            face_offsets=np.cumsum([0, *sides], dtype=np.uint32),
            centres=column(faces, "centre", np.float64).reshape(-1, 2),
            areas=column(faces, "area", np.float64),
            map_area=info.width * info.height * info.resolution**2,
        ),
        "occupancy": Occupancy(
            faces=column(faces, "occupancy", np.float64),
            unknown=column(faces, "unknown", np.float64),
            free=column(faces, "free", np.float64),
            pixels=column(faces, "pixels", np.uint64),
            states=np.array([STATES.index(face["state"]) for face in faces], dtype=np.uint8),
            edges=column(edges, "occupancy", np.float64),
            runs=np.array([run for edge in edges for run in edge["runs"]], dtype=np.float64).reshape(-1, 2),
            run_offsets=np.cumsum([0, *runs], dtype=np.uint32),
        ),
        "walls": Walls(
            cogent=column(edges, "cogent", np.bool_),
            disparity=column(edges, "disparity", np.float64),
            points=column(tree["walls"], "points", np.float64).reshape(-1, 2),
            lines=column(tree["walls"], "line", np.uint32),
            freestanding=np.array([w["kind"] == "freestanding" for w in tree["walls"]], dtype=np.bool_),
        ),
        "adjacency": Adjacency(
            faces=column(tree["links"], "faces", np.uint32).reshape(-1, 2),
            edges=column(tree["links"], "edge", np.uint32),
            connected=column(tree["links"], "connected", np.bool_),
        ),
        "labels": [checked(label) for label in tree["labels"]],
        "patterns": [checked_pattern(pattern) for pattern in tree.get("patterns", [])],
        "warnings": [MapWarning(w["code"], w["message"]) for w in tree["warnings"]],
        "source": None if source is None else str(source["file"]),
        "reading": {} if source is None else checked_reading(source.get("reading", {})),
    }


def rows(**columns: Any) -> list[dict[str, Any]]:
    """Columns as a list of records."""
    lists = [column.tolist() if isinstance(column, np.ndarray) else column for column in columns.values()]
    return [dict(zip(columns, values, strict=True)) for values in zip(*lists, strict=True)]


def ragged(values: npt.NDArray[Any], offsets: npt.NDArray[Any], some: slice) -> list[Any]:
    """Some of the lists of different lengths that values and their offsets are."""
    first, last, _ = some.indices(len(offsets) - 1)
    ends = offsets[first : last + 1].tolist()
    flat = values[ends[0] : ends[-1]].tolist()
    return [flat[start - ends[0] : end - ends[0]] for start, end in pairwise(ends)]


def column(records: list[dict[str, Any]], name: str, kind: npt.DTypeLike) -> npt.NDArray[Any]:
    """One key of a list of records as an array."""
    return np.array([entry[name] for entry in records], dtype=kind)


def checked(label: Any) -> Label:
    """A label from a file, held to what its readers count on.

    Raises
    ------
    KeyError, TypeError, ValueError
        A part is missing, of another type or of another shape.
    """
    for key in ("kind", *NEEDED.get(label["kind"], ())):
        label[key]
    for key, value in label.items():
        if key in ("kind", "type", "use", "name") and not isinstance(value, str):
            raise TypeError(f"the {key} of a label is {value!r}")
        if key in ("at", "polygon", "axis"):
            points = np.asarray(value)
            if points.dtype.kind not in "if" or points.shape[-1:] != (2,) or points.ndim != 1 + (key != "at"):
                raise ValueError(f"the {key} of a {label['kind']} is not made of points")
            if not np.isfinite(points).all():
                raise ValueError(f"the {key} of a {label['kind']} is not finite")
        if key in ("width", "area") and not np.isfinite(float(value)):
            raise ValueError(f"the {key} of a {label['kind']} is {value}")
    return dict(label)


def checked_pattern(pattern: dict[str, Any]) -> Label:
    """A pattern from a file, held to what its readers count on.

    Raises
    ------
    KeyError, TypeError, ValueError
        A part is missing, of another type or of another shape.
    """
    if not isinstance(pattern["kind"], str):
        raise TypeError(f"the kind of a pattern is {pattern['kind']!r}")
    float(pattern["angle"])
    for key in ("pitch", "phase"):
        along, across = pattern[key]
        for value in (along, across):
            if value is not None:
                float(value)
    return pattern | {"labels": [int(label) for label in pattern["labels"]]}


def checked_reading(reading: dict[str, Any]) -> dict[str, Any]:
    """What a file says of how the map was read, held to the names that there are."""
    wrong = strange_reading(reading)
    if wrong:
        raise ValueError(wrong[0])
    return dict(reading)


def strange_reading(reading: dict[str, Any]) -> tuple[str, str] | None:
    """Of what is given for reading a map the first name that there is none of, as a sentence, and what would help."""
    for name in reading:
        if name not in READING:
            near = difflib.get_close_matches(name, READING, 1)
            hint = f"did you mean {near[0]}?" if near else "it takes what groundplan.read does"
            return f"there is no {name!r} in reading a map", hint
    return None


def dump(value: Any) -> str:
    """Compact JSON, without what JSON cannot say."""
    return json.dumps(value, separators=(",", ":"), ensure_ascii=False, allow_nan=False)
