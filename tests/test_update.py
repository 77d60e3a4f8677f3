"""A survey that follows its map: whatever the patch, the bytes are those of a survey of the whole map as it is now."""

from __future__ import annotations

import copy
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from zoo import FREE, OCCUPIED, RESOLUTION, UNKNOWN, ZOO

import groundplan
from groundplan import Map, ParameterError, Survey, _core

#: Maps with structure of every kind, and two that hardly have any.
NAMES = ("turned_warehouse", "two_blocks_of_racks", "rows_of_offices", "noise", "one_row", "half_explored")

Pixels = npt.NDArray[Any]


def map_of(name: str) -> Map:
    return groundplan.from_array(ZOO[name](), RESOLUTION, (-3.0, 1.5, 0.2))


def with_patch(map: Map, patch: Pixels, row: int, column: int) -> Map:
    pixels = map.pixels.copy()
    pixels[row : row + patch.shape[0], column : column + patch.shape[1]] = patch
    return replace(map, pixels=pixels)


@st.composite
def patches(draw: st.DrawFn) -> tuple[str, int, list[tuple[Pixels, int, int]]]:
    """A map, and patches one after another: anywhere, of any size, of one state or of all."""
    name = draw(st.sampled_from(NAMES))
    height, width = ZOO[name]().shape
    found = []
    for _ in range(draw(st.integers(1, 3))):
        rows, columns = (draw(st.one_of(st.just(1), st.just(n), st.integers(1, n))) for n in (height, width))
        row, column = (
            draw(st.one_of(st.just(0), st.just(most), st.integers(0, most)))
            for most in (height - rows, width - columns)
        )
        kind = draw(st.sampled_from(["free", "occupied", "unknown", "noise", "walls"]))
        random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
        patch = np.full((rows, columns), {"occupied": OCCUPIED, "unknown": UNKNOWN}.get(kind, FREE), np.uint8)
        if kind == "noise":
            patch = random.choice(np.array([OCCUPIED, UNKNOWN, FREE], np.uint8), (rows, columns))
        if kind == "walls":
            patch[random.integers(0, rows, 3)] = OCCUPIED
            patch[:, random.integers(0, columns, 3)] = OCCUPIED
        found.append((patch, row, column))
    return name, draw(st.integers(1, 4)), found


@settings(max_examples=60, deadline=None)
@given(patches())
def test_any_patches_give_the_bytes_of_a_full_survey(case: tuple[str, int, list[tuple[Pixels, int, int]]]) -> None:
    name, threads, changes = case
    now = map_of(name)
    survey = groundplan.survey(now, keep=True)
    for patch, row, column in changes:
        survey = survey.update(patch, row, column, threads=threads)
        now = with_patch(now, patch, row, column)
        assert survey.to_json() == groundplan.survey(now).to_json()


def test_a_map_that_is_looked_at_piece_by_piece_follows_its_patches() -> None:
    # So many pixels that clearances are not kept, and so tall that views are kept in squares.
    one = ZOO["two_blocks_of_racks"]()
    now = groundplan.from_array(np.tile(one, (1 + (1 << 24) // one.size, 1)), RESOLUTION, (-3.0, 1.5, 0.0))
    survey = groundplan.survey(now, keep=True)
    for row, changed in ((3000, one[40:140, :80].T.copy()), (9000, np.full((30, 60), OCCUPIED, np.uint8))):
        survey = survey.update(changed, row, 50)
        now = with_patch(now, changed, row, 50)
        assert survey.to_json() == groundplan.survey(now).to_json()


@settings(max_examples=20, deadline=None)
@given(patches())
def test_a_map_that_changed_in_several_places_is_compared_with_the_one_before(
    case: tuple[str, int, list[tuple[Pixels, int, int]]],
) -> None:
    name, threads, changes = case
    survey = groundplan.survey(map_of(name), keep=True)
    now = map_of(name)
    for patch, row, column in changes:
        now = with_patch(now, patch, row, column)
    assert survey.update(now, threads=threads).to_json() == groundplan.survey(now).to_json()


def tower() -> Map:
    """Many times as high as a gradient's window."""
    return groundplan.from_array(np.concatenate([ZOO["turned_warehouse"]()] * 3), RESOLUTION)


PATCH = np.full((40, 30), OCCUPIED, np.uint8)


def test_only_what_the_patch_touches_is_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    map = tower()
    survey = groundplan.survey(map, keep=True)
    asked: list[Any] = []
    found = _core.find_gradients_in

    def spy(layout: Any, held: Any, rows: Any, columns: Any, *others: Any) -> Any:
        asked.append((rows, columns))
        return found(layout, held, rows, columns, *others)

    monkeypatch.setattr("groundplan._update._core.find_gradients_in", spy)
    survey.update(PATCH, 100, 50)
    reach = _core.reach(map.resolution, {})
    top = map.height - 100
    assert asked == [((top - 40 - reach, top + reach), (50 - reach, 80 + reach))]


def test_a_map_that_is_looked_at_square_by_square_keeps_what_did_not_change() -> None:
    # More than 16 million pixels.
    block = np.kron(ZOO["rows_of_offices"](), np.ones((2, 2), np.uint8))
    pixels = np.tile(block, [-(-4200 // n) for n in block.shape])[:4200, :4200]
    now = groundplan.from_array(pixels, 0.05)
    survey = groundplan.survey(now, keep=True)
    for row, column in ((300, 400), (2000, 2050), (4100, 4100)):
        patch = now.pixels[row : row + 90, column : column + 90].T.copy()
        now = with_patch(now, patch, row, column)
        survey = survey.update(patch, row, column)
    assert survey.to_json() == groundplan.survey(now).to_json()


def test_a_survey_stays_what_it_is_when_another_is_made_of_it() -> None:
    map = tower()
    before = map.pixels.copy()
    survey = groundplan.survey(map)
    text = survey.to_json()
    once = survey.update(PATCH, 100, 50)
    again = survey.update(PATCH, 100, 50)
    back = once.update(before[100:140, 50:80], 100, 50)
    assert once.to_json() == again.to_json() != text
    assert back.to_json() == survey.to_json() == text
    assert np.array_equal(map.pixels, before)


def test_an_update_goes_on_with_what_the_survey_was_given() -> None:
    map = tower()
    lines = groundplan.Lines.of([0, 0, 1], [3.0, 5.0, 2.0])
    directions = groundplan.Directions.of([0.1, 1.2])
    cases: list[dict[str, Any]] = [
        {"lines": lines},
        {"lines": lines, "directions": directions},
        {"directions_count": 1},
    ]
    for own in cases:
        found = groundplan.survey(map, **own, labels_method="paper").update(PATCH, 7, 7)
        expected = groundplan.survey(with_patch(map, PATCH, 7, 7), **own, labels_method="paper")
        assert found.to_json() == expected.to_json()
        assert found.parameters["labels.method"] == "paper"


def test_where_nothing_occupied_changed_the_lines_stay() -> None:
    map = tower()
    explored = map.pixels.copy()
    explored[explored == UNKNOWN] = FREE
    explored[:20] = UNKNOWN
    cases: list[dict[str, Any]] = [{}, {"directions": groundplan.Directions.of([0.1, 1.2])}]
    for own in cases:
        found = groundplan.survey(map, keep=True, **own).update(replace(map, pixels=explored))
        assert found.to_json() == groundplan.survey(replace(map, pixels=explored), **own).to_json()


def test_what_changes_nothing_costs_nothing() -> None:
    map = tower()
    survey = groundplan.survey(map)
    assert survey.update(map.pixels[30:90, 20:99], 30, 20) is survey
    assert survey.update(replace(map, pixels=map.pixels.copy())) is survey
    named = survey.update(replace(map, image="tower.png"))
    assert named.to_json() == groundplan.survey(replace(map, image="tower.png")).to_json()


def test_routes_go_over_the_map_as_it_is_now() -> None:
    picture = np.full((100, 200), FREE, np.uint8)
    picture[:, :3] = picture[:, -3:] = picture[:3] = picture[-3:] = OCCUPIED
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    assert survey.route((1.0, 2.5), (9.0, 2.5)) is not None
    walled = survey.update(np.full((100, 4), OCCUPIED, np.uint8), 0, 98)
    assert walled.route((1.0, 2.5), (9.0, 2.5)) is None
    assert survey.route((1.0, 2.5), (9.0, 2.5)) is not None


def test_occupancies_are_counted_from_the_lowest_row_as_in_a_message() -> None:
    grid = np.select([ZOO["rows_of_offices"]() == OCCUPIED, ZOO["rows_of_offices"]() == FREE], [100, 0], -1)
    grid = grid.astype(np.int8)[::-1]
    patch = np.array([[100, 100, 100, 100], [0, -1, 100, 0]], np.int8).repeat(9, axis=0)
    now = grid.copy()
    now[20:38, 10:14] = patch
    expected = groundplan.survey(now, resolution=RESOLUTION).to_json()
    assert groundplan.survey(grid, resolution=RESOLUTION).update(patch, 20, 10).to_json() == expected
    # A picture takes them too: what means occupied there is written.
    greys = groundplan.survey(ZOO["rows_of_offices"](), resolution=RESOLUTION)
    painted = ZOO["rows_of_offices"]()
    painted[::-1][20:38, 10:14] = np.select([patch == 100, patch == 0], [OCCUPIED, FREE], UNKNOWN)
    assert greys.update(patch, 20, 10).to_json() == groundplan.survey(painted, resolution=RESOLUTION).to_json()


def test_a_patch_of_truth_values_is_occupied_or_free() -> None:
    taken = ZOO["single_room"]() == OCCUPIED
    patch = np.zeros((5, 6), np.bool_)
    patch[2] = True
    now = taken.copy()
    now[10:15, 20:26] = patch
    updated = groundplan.survey(taken, resolution=RESOLUTION).update(patch, 10, 20)
    assert updated.to_json() == groundplan.survey(now, resolution=RESOLUTION).to_json()


def test_that_nothing_is_free_or_occupied_is_said_no_longer_than_it_is_true() -> None:
    picture = np.full((60, 60), UNKNOWN, dtype=np.uint8)
    found = groundplan.survey(picture, resolution=RESOLUTION)
    for value, missing in ((FREE, {"no-occupied"}), (OCCUPIED, set())):
        picture = picture.copy()
        picture[30, value // 20] = value
        found = found.update(np.full((1, 1), value, dtype=np.uint8), 30, value // 20)
        codes = {warning.code for warning in found.warnings}
        assert codes & {"no-free-space", "no-occupied"} == missing
        assert found.to_json() == groundplan.survey(picture, resolution=RESOLUTION).to_json()


def test_a_map_of_another_size_or_meaning_is_surveyed_anew() -> None:
    survey = groundplan.survey(tower(), keep=True)
    for other in (map_of("turned_warehouse"), replace(tower(), states=np.roll(tower().states, 1))):
        assert survey.update(other).to_json() == groundplan.survey(other).to_json()


@pytest.mark.parametrize(
    ("patch", "row", "column", "said"),
    [
        (PATCH, -1, 0, "from row -1"),
        (PATCH, 0, 10_000, "column 10000"),
        (PATCH, 0.5, 0, "row 0.5"),
        (PATCH, None, 3, "row None"),
        (PATCH.astype(np.float64), 0, 0, "float64"),
        (PATCH[0], 0, 0, r"\(30,\)"),
        (PATCH[:0], 0, 0, r"\(0, 30\)"),
        ([[1, 2], [3]], 0, 0, "no patch"),
        (np.full((2, 2), 42, np.int8), 0, 0, "can mean 42"),
        (tower(), 1, 2, "a whole map"),
    ],
)
def test_what_is_no_patch_is_refused(patch: Any, row: Any, column: Any, said: str) -> None:
    with pytest.raises(ParameterError, match=said) as caught:
        zoo_survey().update(patch, row, column)
    assert caught.value.code == "update.patch"


def zoo_survey() -> Survey:
    return groundplan.survey(map_of("single_room"))


def test_a_survey_without_its_map_cannot_be_updated() -> None:
    read = Survey.from_json(zoo_survey().to_json())
    for survey in (read, copy.copy(zoo_survey())):
        with pytest.raises(ParameterError, match="has no map") as caught:
            survey.update(PATCH, 0, 0)
        assert caught.value.code == "update.map"
