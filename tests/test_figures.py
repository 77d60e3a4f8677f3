"""The figures: every kind of map and label can be drawn, the same bytes each time, and the map shows as it is."""

import dataclasses
import math
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from matplotlib.figure import Figure
from PIL import Image

import groundplan
from groundplan import Map, Survey
from groundplan._shapes import readable
from groundplan.figures import _labelled, _labels, _names, _panels, _style, draw_figures, draw_survey
from groundplan.figures._underlay import underlay

FREE_PIXEL, UNKNOWN_PIXEL, OCCUPIED_PIXEL = 254, 205, 0
NAMES = [
    "figure-2-directions",
    "figure-3-radiograms",
    "figure-4-subdivision",
    "figure-5d-edge-features",
    "figure-6-abstraction",
    "figure-7-connectivity",
    "figure-8-labels",
    "figure-9-coarse-and-fine",
]


def two_rooms() -> npt.NDArray[np.uint8]:
    """Two rooms with a door between them, unknown all around."""
    picture = np.full((120, 200), UNKNOWN_PIXEL, dtype=np.uint8)
    picture[20:100, 20:180] = FREE_PIXEL
    picture[[20, 99], 20:180] = OCCUPIED_PIXEL
    picture[20:100, [20, 100, 179]] = OCCUPIED_PIXEL
    picture[50:70, 100] = FREE_PIXEL
    return picture


def surveyed(picture: npt.NDArray[np.uint8], **parameters: Any) -> tuple[Survey, Map]:
    map = groundplan.from_array(picture, 0.05, (1.0, -2.0, 0.3))
    return groundplan.survey(map, **parameters), map


def every_label() -> list[dict[str, Any]]:
    square = [[2.0, 2.0], [5.0, 2.0], [5.0, 3.0], [2.0, 3.0]]
    hole = [[2.5, 2.2], [3.0, 2.2], [3.0, 2.6], [2.5, 2.6]]
    axis = [[2.0, 2.5], [5.0, 2.5]]
    region = {"kind": "region", "faces": [0], "polygon": square, "at": [3.0, 2.5], "area": 3.0}
    junctions = [
        {"kind": "junction", "type": type, "faces": [0], "polygon": square, "at": [2.0 + n / 2, 2.5], "corridors": [2]}
        for n, type in enumerate(["X", "T", "L", "Y", "end"])
    ]
    return [
        region | {"use": "room", "holes": [hole], "name": "R01"},
        region | {"use": "corridor", "holes": [], "name": "R02"},
        {"kind": "corridor", "faces": [0], "polygon": square, "axis": axis, "width": 1.0, "name": "A01"},
        {"kind": "rack", "faces": [0], "polygon": square, "axis": axis, "width": 1.0},
        {"kind": "door", "at": [4.0, 3.0], "width": 0.9, "between": [0, 1]},
        {"kind": "pillar", "at": [7.0, 3.0]},
        *junctions,
    ]


def colours_in(path: Path) -> set[tuple[int, int, int]]:
    found = Image.open(path).convert("RGB").getcolors(1 << 24) or []
    return {(colour[0], colour[1], colour[2]) for _, colour in found if isinstance(colour, tuple)}


def rgb(colour: str) -> tuple[int, int, int]:
    return int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16)


def test_every_figure_is_written_in_every_format_and_told_of(tmp_path: Path) -> None:
    told: list[str] = []
    written = draw_figures(*surveyed(two_rooms()), tmp_path, progress=told.append)
    assert told == NAMES
    assert [path.name for path in written] == [f"{name}.{kind}" for name in NAMES for kind in ("png", "svg")]
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(path.name for path in written)


@pytest.mark.parametrize(
    "picture",
    [
        pytest.param(np.full((1, 1), FREE_PIXEL, dtype=np.uint8), id="one pixel"),
        pytest.param(np.full((30, 50), UNKNOWN_PIXEL, dtype=np.uint8), id="unknown"),
        pytest.param(np.full((30, 50), OCCUPIED_PIXEL, dtype=np.uint8), id="occupied"),
        pytest.param(np.full((2, 900), FREE_PIXEL, dtype=np.uint8), id="a strip"),
    ],
)
def test_a_map_with_nothing_in_it_has_its_figures(picture: npt.NDArray[np.uint8], tmp_path: Path) -> None:
    assert len(draw_figures(*surveyed(picture), tmp_path, formats=["png"])) == len(NAMES)


def test_ten_directions_have_their_figures(tmp_path: Path) -> None:
    angles = [-88, -70, -50, -30, -10, 0, 20, 40, 60, 80]
    survey, map = surveyed(two_rooms(), directions_angles_deg=angles)
    assert len(survey.directions) == 10
    assert len(draw_figures(survey, map, tmp_path, formats=["png"])) == len(NAMES)


@pytest.mark.parametrize("kind", ["png", "svg"])
def test_the_same_survey_gives_the_same_bytes(kind: str, tmp_path: Path) -> None:
    survey, map = surveyed(two_rooms())
    first, second = (draw_survey(survey, map, tmp_path / f"{n}.{kind}").read_bytes() for n in range(2))
    assert first == second


def test_every_kind_of_label_is_drawn_and_counted_in_the_legend(tmp_path: Path) -> None:
    survey, map = surveyed(two_rooms())
    labelled = dataclasses.replace(
        survey, labels=every_label(), map=dataclasses.replace(survey.map, image="$a$ 図.png")
    )
    drawn = colours_in(draw_survey(labelled, map, tmp_path / "survey.png"))
    assert {rgb(colour) for colour in _style.JUNCTIONS.values()} <= drawn
    assert {rgb(_style.DOOR), rgb(_style.PILLAR)} <= drawn
    entries = [str(entry.get_label()) for entry in _labels.key(labelled)]
    assert entries == [
        "Wall",
        "Corridor (1)",
        "Rack (1)",
        "Region (2)",
        "X junction (1)",
        "T junction (1)",
        "L corner (1)",
        "Y junction (1)",
        "Dead end (1)",
        "Door (1)",
        "Pillar (1)",
    ]


def test_what_is_unsure_is_drawn_pale_and_counted(tmp_path: Path) -> None:
    survey, map = surveyed(two_rooms())

    def drawn(confidence: float) -> tuple[dict[str, int], list[str]]:
        labels = [label | {"confidence": confidence} for label in every_label()]
        shown = dataclasses.replace(survey, labels=labels)
        pixels = np.asarray(Image.open(draw_survey(shown, map, tmp_path / "survey.png")).convert("RGB"))
        inks = {"door": _style.DOOR, "pillar": _style.PILLAR}
        in_full = {kind: int((pixels == rgb(ink)).all(axis=2).sum()) for kind, ink in inks.items()}
        return in_full, [str(entry.get_label()) for entry in _labels.key(shown)]

    (sure, said_sure), (unsure, said_unsure) = drawn(0.51), drawn(0.5)
    # The legend's own is left.
    assert all(0 < unsure[kind] < sure[kind] for kind in sure)
    assert said_unsure == [*said_sure, f"Pale or hollow: unsure ({len(every_label())})"]


def test_a_door_lies_along_the_wall_that_it_is_in() -> None:
    survey, _ = surveyed(two_rooms())
    wall = survey.walls.points[:2]
    along = _labels.door_direction({"kind": "door"}, wall.mean(axis=0), survey)
    unit = (wall[1] - wall[0]) / math.dist(*wall)
    assert abs(float(along @ unit)) == pytest.approx(1)


def test_a_name_stands_in_the_widest_gap_between_crossings() -> None:
    line = np.array([[0.0, 0.0], [10.0, 0.0]])
    middle, room = _names.widest_gap(line, np.array([[2.0, 0.1], [3.0, 0.0], [5.0, 9.0]]), near=1.0)
    assert middle.tolist() == [6.5, 0.0]
    assert room == 7.0


def test_a_name_is_read_from_below_or_from_the_right_and_not_from_the_left() -> None:
    assert [readable(angle) for angle in (0.0, 12.0, 180.0, -168.0, 225.0)] == [0.0, 12.0, 0.0, 12.0, 45.0]
    assert [readable(angle) for angle in (90.0, -90.0, 89.9, 270.0)] == [90.0, 90.0, 89.9, 90.0]
    assert readable(-89.9) == pytest.approx(90.1)
    assert readable(-78.0) == -78.0


def test_centre_lines_that_cross_are_known() -> None:
    line = np.array([[0.0, 0.0], [10.0, 0.0]])
    across, parallel, short = ([[4.0, -1.0], [4.0, 1.0]], [[0.0, 1.0], [9.0, 1.0]], [[7.0, 1.0], [7.0, 0.5]])
    assert _names.meetings(line, [line, *map(np.array, (across, parallel, short))]).tolist() == [[4.0, 0.0]]


def test_names_do_not_stand_over_one_another() -> None:
    axes = Figure().add_axes((0, 0, 1, 1))
    names = _names.Names(10.0, _names.on_axes(axes))
    names.take([5.0, 5.0], 8.0, 8.0)
    square = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]]
    narrow = [[4.9, 4.9], [5.1, 4.9], [5.1, 5.1], [4.9, 5.1]]
    regions = [{"polygon": square, "at": [5.0, 5.0], "name": "R01", "area": 100.0}]
    _names.name_regions([*regions, {"polygon": narrow, "at": [5.0, 5.0], "name": "R02", "area": 0.04}], [], names)
    (text,) = axes.texts
    # The large one steps aside, the one that has no room has no name.
    assert text.get_text() == "R01"
    assert text.get_position() != (5.0, 5.0)


def test_a_map_of_kilometres_has_its_size_in_plain_figures() -> None:
    sizes = {0.05: "0.25 × 0.3 m", 2.0: "10 × 12 m", 246.9: "1234 × 1481 m", 5000.0: "25000 × 30000 m"}
    for resolution, said in sizes.items():
        map = groundplan.from_array(np.full((6, 5), FREE_PIXEL, dtype=np.uint8), resolution)
        assert _labelled.summary(groundplan.survey(map))[0].startswith(f"{said} at ")


@pytest.mark.parametrize("width", [2.5, 3.6, 9.0])
def test_a_header_says_all_of_it_on_any_sheet(width: float) -> None:
    note = ["99.2 × 99.2 m at 0.05 m", "2 directions (88.2°, −4.9°)", "76 lines", "1265 faces"]
    lines = _panels.note_lines(note, width)
    assert " · ".join(lines) == " · ".join(note)
    room = width - _panels.LEFT - _panels.RIGHT
    assert all(_panels.text_width(line) <= room for line in lines)


@pytest.mark.parametrize("shape", [(700, 100), (100, 700), (300, 300)])
def test_a_scale_bar_ends_where_the_map_does(shape: tuple[int, int]) -> None:
    map = groundplan.from_array(np.full(shape, FREE_PIXEL, dtype=np.uint8), 0.05)
    note = ["a note that is rather long", "and goes on for more", "than a line"]
    figure, axes, _ = _panels.map_sheet(underlay(map), "title", note, [])
    (bar,) = axes.lines
    assert np.asarray(bar.get_xdata()).max() == 1.0
    # Nothing is written where it stands.
    figure.draw_without_rendering()
    place = bar.get_window_extent()
    assert not any(text.get_window_extent().overlaps(place) for text in figure.texts)


def test_black_all_around_and_specks_far_out_are_not_shown() -> None:
    picture = np.full((600, 800), OCCUPIED_PIXEL, dtype=np.uint8)
    picture[200:400, 300:500] = FREE_PIXEL
    view = underlay(groundplan.from_array(picture, 0.05), margin=0.0)
    assert view.extent == pytest.approx((15.0, 25.0, 10.0, 20.0), abs=0.16)
    assert (view.ranks[0] == 2).all()
    picture[picture == OCCUPIED_PIXEL] = UNKNOWN_PIXEL
    picture[3, 5] = picture[590, 795] = OCCUPIED_PIXEL
    speckled = underlay(groundplan.from_array(picture, 0.05), margin=0.0)
    assert speckled.extent == pytest.approx(view.extent, abs=0.16)


def test_walls_a_pixel_wide_outlive_the_reduction() -> None:
    picture = np.full((500, 900), FREE_PIXEL, dtype=np.uint8)
    picture[123] = picture[:, 457] = OCCUPIED_PIXEL
    view = underlay(groundplan.from_array(picture, 0.05), longest=100)
    assert view.block == 9
    assert (view.ranks[123 // 9] == 2).all()
    assert (view.ranks[:, 457 // 9] == 2).all()
    assert (view.ranks == 2).sum() == sum(view.ranks.shape) - 1


@pytest.mark.parametrize("yaw", [0.0, 0.4, 2.5])
def test_the_view_is_what_is_known_in_the_map_frame(yaw: float) -> None:
    view = underlay(groundplan.from_array(two_rooms(), 0.05, (3.0, 4.0, yaw)), margin=0.0)
    corners = np.array([[1.0, 1.0], [9.0, 1.0], [9.0, 5.0], [1.0, 5.0]])
    turn = np.array([[math.cos(yaw), math.sin(yaw)], [-math.sin(yaw), math.cos(yaw)]])
    placed = corners @ turn + np.array([3.0, 4.0])
    low, high = placed.min(axis=0), placed.max(axis=0)
    # The margin is one pixel at least, and the size a whole number of pixels.
    assert view.extent == pytest.approx((low[0], high[0], low[1], high[1]), abs=0.11)


def test_a_pixel_of_the_map_is_a_whole_number_of_dots(tmp_path: Path) -> None:
    picture = np.full((60, 60), FREE_PIXEL, dtype=np.uint8)
    picture[::2, ::2] = OCCUPIED_PIXEL
    map = groundplan.from_array(picture, 0.05)
    survey = dataclasses.replace(groundplan.survey(map), labels=[])
    bare = dataclasses.replace(survey.walls, points=np.zeros((0, 2)), lines=np.zeros(0, np.uint32))
    survey = dataclasses.replace(survey, walls=dataclasses.replace(bare, freestanding=np.zeros(0, np.bool_)))
    drawn = np.asarray(Image.open(draw_survey(survey, map, tmp_path / "survey.png")).convert("RGB"))
    row = drawn[len(drawn) // 2 : len(drawn) // 2 + 60, 300:-300]
    # No dot between black and white: each belongs to one pixel of the map.
    seen = {tuple(colour) for colour in row.reshape(-1, 3).tolist()}
    assert seen == {rgb(_style.FREE), rgb(_style.OCCUPIED)}


def test_nothing_is_left_half_written(tmp_path: Path) -> None:
    (tmp_path / "survey.png").mkdir()
    with pytest.raises(groundplan.FormatError) as fault:
        draw_survey(*surveyed(two_rooms()), tmp_path / "survey.png")
    assert fault.value.code == "file.write"
    assert [path.name for path in tmp_path.iterdir()] == ["survey.png"]


@pytest.mark.parametrize(("width", "size"), [(0.5, None), (0.6, 4.5), (0.7, 4.5), (1.0, 6.2), (3.0, 9.0)])
def test_a_name_is_written_where_the_least_type_fits_across_a_rack(width: float, size: float | None) -> None:
    sizes: list[float] = []
    names = _names.Names(10.0, lambda at, text, size, colour, zorder, angle: sizes.append(size))
    _names.name_racks([{"kind": "rack", "name": "S1-01", "axis": [[0, 0], [9, 0]], "width": width}], names)
    assert sizes == ([] if size is None else [pytest.approx(size)])


def test_drawing_leaves_the_style_of_others_alone(tmp_path: Path) -> None:
    import matplotlib

    before = dict(matplotlib.rcParams)
    draw_survey(*surveyed(two_rooms()), tmp_path / "survey.png")
    assert dict(matplotlib.rcParams) == before


def test_matplotlib_comes_with_the_figures_and_pyplot_never() -> None:
    script = (
        "import sys, groundplan; assert 'matplotlib' not in sys.modules; "
        "import groundplan.figures; assert 'matplotlib.pyplot' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", script], check=True, env=os.environ)
