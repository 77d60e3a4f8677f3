"""The zoo: small maps drawn by code, each with a name, and the ways to turn them.

Greys are a picture's: 0 occupied, 205 unknown, 254 free, top row first, 5 cm to the pixel. Shapes are placed in pixels
from the lower left corner, y up, as the map frame has it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np
import numpy.typing as npt

import groundplan

OCCUPIED, UNKNOWN, FREE = 0, 205, 254
#: Metres per pixel.
RESOLUTION = 0.05

Picture = npt.NDArray[np.uint8]
Points = npt.NDArray[np.float64]


class Canvas:
    """A map being drawn: pixels whose centres lie in a shape take its value, so nothing is smoothed."""

    def __init__(self, width: int, height: int, ground: int = UNKNOWN) -> None:
        self.rows = np.full((height, width), ground, dtype=np.uint8)
        y, x = np.mgrid[:height, :width]
        self.x, self.y = x + 0.5, y + 0.5
        self.cos, self.sin = 1.0, 0.0
        self.middle = (width / 2, height / 2)

    def turn(self, degrees: float) -> Canvas:
        """Turn what is drawn from here on about the map's middle."""
        self.cos, self.sin = float(np.cos(np.radians(degrees))), float(np.sin(np.radians(degrees)))
        return self

    def box(self, x0: float, y0: float, x1: float, y1: float, value: int = OCCUPIED) -> Canvas:
        """Fill a rectangle."""
        dx, dy = self.x - self.middle[0], self.y - self.middle[1]
        u = self.middle[0] + dx * self.cos + dy * self.sin
        v = self.middle[1] + dy * self.cos - dx * self.sin
        self.rows[(u >= x0) & (u < x1) & (v >= y0) & (v < y1)] = value
        return self

    def room(self, x0: float, y0: float, x1: float, y1: float, wall: float = 3) -> Canvas:
        """Fill a rectangle with free space and draw walls along its inside."""
        return self.box(x0, y0, x1, y1).box(x0 + wall, y0 + wall, x1 - wall, y1 - wall, FREE)

    def bar(self, p: tuple[float, float], degrees: float, length: float, width: float, value: int = OCCUPIED) -> Canvas:
        """Fill a bar from a point on along an angle, half its width to either side."""
        cos, sin = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
        u = (self.x - p[0]) * cos + (self.y - p[1]) * sin
        v = (self.y - p[1]) * cos - (self.x - p[0]) * sin
        self.rows[(u >= 0) & (u < length) & (np.abs(v) <= width / 2)] = value
        return self

    @property
    def picture(self) -> Picture:
        """The map, top row first."""
        return np.ascontiguousarray(self.rows[::-1])


def sheared(picture: Picture, degrees: float) -> Picture:
    """A picture of which what ran down the columns leans by an angle, and rows stay as they are."""
    height, width = picture.shape
    slope = np.tan(np.radians(degrees))
    off = [round(slope * row - min(0.0, slope) * height) for row in range(height)]
    leaning = np.full((height, width + max(off) + 1), UNKNOWN, np.uint8)
    for row, first in enumerate(off):
        leaning[row, first : first + width] = picture[row]
    return leaning


def walled(width: int, depth: int) -> Picture:
    """Free space of so many pixels within walls two pixels thick, 18 of the unknown around."""
    picture = np.full((depth + 40, width + 40), UNKNOWN, np.uint8)
    picture[18:-18, 18:-18] = OCCUPIED
    picture[20:-20, 20:-20] = FREE
    return picture


def empty() -> Picture:
    """Free space and nothing else."""
    return Canvas(80, 60, FREE).picture


def all_unknown() -> Picture:
    """Nothing was seen."""
    return Canvas(80, 60, UNKNOWN).picture


def all_occupied() -> Picture:
    """Everything is taken."""
    return Canvas(80, 60, OCCUPIED).picture


def one_pixel() -> Picture:
    """A single taken pixel is the whole map."""
    return Canvas(1, 1, OCCUPIED).picture


def one_row() -> Picture:
    """A scan line: free space between two taken pixels."""
    return Canvas(90, 1, FREE).box(10, 0, 11, 1).box(70, 0, 71, 1).picture


def single_room() -> Picture:
    """One room with walls of 15 cm."""
    return Canvas(120, 90).room(10, 10, 110, 80).picture


def two_rooms_with_door() -> Picture:
    """Two rooms and a door of 80 cm between them."""
    plan = Canvas(160, 90).room(10, 10, 82, 80).room(79, 10, 150, 80)
    return plan.box(79, 30, 82, 46, FREE).picture


def l_corridor() -> Picture:
    """A corridor that turns once."""
    plan = Canvas(140, 140).box(10, 10, 48, 130).box(10, 10, 130, 48)
    return plan.box(13, 13, 45, 127, FREE).box(13, 13, 127, 45, FREE).picture


def crossing() -> Picture:
    """Two corridors cross."""
    plan = Canvas(160, 160).box(60, 10, 100, 150).box(10, 60, 150, 100)
    return plan.box(63, 13, 97, 147, FREE).box(13, 63, 147, 97, FREE).picture


def t_junction() -> Picture:
    """A corridor ends upon another."""
    plan = Canvas(160, 110).box(60, 10, 100, 100).box(10, 60, 150, 100)
    return plan.box(63, 13, 97, 97, FREE).box(13, 63, 147, 97, FREE).picture


def comb(canvas: Canvas) -> Canvas:
    """Four racks, closed to the wall at one end: aisles like a comb's teeth."""
    canvas.room(10, 10, 210, 150)
    for n in range(4):
        canvas.box(42 + 40 * n, 40, 58 + 40 * n, 147)
    return canvas


def comb_of_racks() -> Picture:
    """A warehouse of four racks that stand against one wall."""
    return comb(Canvas(220, 160)).picture


def warehouse(canvas: Canvas) -> Canvas:
    """Two blocks of four racks with cross aisles around and between."""
    canvas.room(20, 20, 220, 200)
    for n in range(4):
        canvas.box(50 + 40 * n, 50, 66 + 40 * n, 100).box(50 + 40 * n, 125, 66 + 40 * n, 172)
    return canvas


def two_blocks_of_racks() -> Picture:
    """A warehouse of eight racks in two blocks."""
    return warehouse(Canvas(240, 220)).picture


def turned_warehouse() -> Picture:
    """The warehouse of eight racks at 17 degrees."""
    return warehouse(Canvas(240, 220).turn(17)).picture


def skewed() -> Picture:
    """Walls of two families that meet at 70 degrees."""
    plan = Canvas(200, 180, FREE)
    for n in range(4):
        plan.bar((20, 20.5 + 40 * n), 0, 150, 3).bar((24.5 + 42 * n, 20), 70, 135, 3)
    return plan.picture


def triangle_grid() -> Picture:
    """Walls of three families, 60 degrees apart, that meet in points."""
    plan = Canvas(200, 180, FREE)
    for n in range(-2, 3):
        for degrees in (0, 60, 120):
            normal = np.array([-np.sin(np.radians(degrees)), np.cos(np.radians(degrees))])
            along = np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))])
            start = np.array([100.0, 90.0]) + 36 * n * normal - 75 * along
            plan.bar((float(start[0]), float(start[1])), degrees, 150, 3)
    return plan.picture


def thick_walls() -> Picture:
    """A room whose walls are 60 cm thick: each is two lines."""
    return Canvas(150, 120).room(10, 10, 140, 110, wall=12).picture


def double_walls() -> Picture:
    """A room within a room, a gap of 20 cm between their walls."""
    return Canvas(150, 120).room(10, 10, 140, 110, wall=2).room(16, 16, 134, 104, wall=2).picture


def freestanding_wall() -> Picture:
    """A wall in the middle of free space."""
    return Canvas(140, 100, FREE).box(30, 49, 110, 52).picture


def noise() -> Picture:
    """Salt: one pixel in thirty is taken, wherever chance has it."""
    random = np.random.default_rng(4)
    picture = Canvas(120, 100, FREE).picture
    picture[random.random(picture.shape) < 1 / 30] = OCCUPIED
    return picture


def diagonal_only() -> Picture:
    """One wall from corner to corner, at 45 degrees."""
    return Canvas(100, 100, FREE).bar((0, 0), 45, 142, 3).picture


def lines_at_the_corner() -> Picture:
    """Walls along the map's left and lower border, and one slanted out of the corner."""
    return Canvas(120, 120, FREE).box(0, 0, 120, 2).box(0, 0, 2, 120).bar((0, 0), 30, 110, 3).picture


def pillars() -> Picture:
    """A hall with three by four pillars, 30 cm square."""
    plan = Canvas(180, 140).room(10, 10, 170, 130)
    for column in range(4):
        for row in range(3):
            plan.box(40 + 32 * column, 36 + 30 * row, 46 + 32 * column, 42 + 30 * row)
    return plan.picture


def rows_of_offices() -> Picture:
    """A corridor with three rooms on either side, each with its door."""
    plan = Canvas(220, 180).room(10, 75, 210, 108)
    for n in range(3):
        x = 10 + 66 * n
        plan.room(x, 10, x + 69, 78).room(x, 105, x + 69, 170)
        plan.box(x + 24, 75, x + 42, 78, FREE).box(x + 24, 105, x + 42, 108, FREE)
    return plan.picture


def half_explored() -> Picture:
    """The warehouse of racks, seen only as far as its middle."""
    picture = comb_of_racks()
    picture[:, 110:] = UNKNOWN
    return picture


ZOO: dict[str, Callable[[], Picture]] = {
    make.__name__: make
    for make in (
        empty,
        all_unknown,
        all_occupied,
        one_pixel,
        one_row,
        single_room,
        two_rooms_with_door,
        l_corridor,
        crossing,
        t_junction,
        comb_of_racks,
        two_blocks_of_racks,
        turned_warehouse,
        skewed,
        triangle_grid,
        thick_walls,
        double_walls,
        freestanding_wall,
        noise,
        diagonal_only,
        lines_at_the_corner,
        pillars,
        rows_of_offices,
        half_explored,
    )
}


@dataclass(frozen=True)
class Variant:
    """A turned, mirrored or padded map, and where the original's points went: p -> matrix p + shift, metres."""

    name: str
    picture: Picture
    matrix: Points
    shift: Points

    def points(self, original: npt.ArrayLike) -> Points:
        """Points of the original's map frame, (N, 2), in the variant's."""
        moved: Points = np.asarray(original, dtype=np.float64).reshape(-1, 2) @ self.matrix.T + self.shift
        return moved

    def angles(self, original: npt.ArrayLike) -> Points:
        """Undirected angles of the original in the variant, in [-pi/2, pi/2)."""
        angles = np.atleast_1d(np.asarray(original, dtype=np.float64))
        x, y = self.matrix @ np.stack([np.cos(angles), np.sin(angles)])
        turned: Points = (np.arctan2(y, x) + np.pi / 2) % np.pi - np.pi / 2
        return turned


def turns(picture: Picture) -> list[Variant]:
    """The map as it is, its other three rotations, its mirror image, and the map with a margin of unknown."""
    height, width = (RESOLUTION * side for side in picture.shape)
    made = []
    quarter = np.array([[0.0, -1.0], [1.0, 0.0]])
    matrix, corner = np.eye(2), {0: (0.0, 0.0), 1: (height, 0.0), 2: (width, height), 3: (0.0, width)}
    for n in range(4):
        turned = np.ascontiguousarray(np.rot90(picture, n))
        made.append(Variant(f"turned by {90 * n}", turned, matrix, np.array(corner[n])))
        matrix = quarter @ matrix
    mirrored = np.ascontiguousarray(picture[:, ::-1])
    made.append(Variant("mirrored", mirrored, np.diag([-1.0, 1.0]), np.array([width, 0.0])))
    left, below = 13, 7
    padded = np.pad(picture, ((11, below), (left, 5)), constant_values=UNKNOWN)
    made.append(Variant("padded", padded, np.eye(2), RESOLUTION * np.array([left, below])))
    return made


#: How many variants `turns` makes, and which of them is padded.
TURNS, PADDED = range(6), 5
#: Maps that a margin of unknown makes another map of: their free space, or what is taken, no longer runs off the map.
OPEN = frozenset(
    {"empty", "all_occupied", "skewed", "triangle_grid", "freestanding_wall", "noise", "diagonal_only"}
    | {"lines_at_the_corner", "one_pixel", "one_row"}
)


@cache
def variants(name: str) -> list[Variant]:
    """The variants of a map of the zoo."""
    return turns(ZOO[name]())


@cache
def surveyed(name: str, turn: int = 0) -> groundplan.Survey:
    """The survey of a variant of a map of the zoo."""
    return groundplan.survey(variants(name)[turn].picture, resolution=RESOLUTION, threads=1)


def apart(angles: npt.ArrayLike, others: npt.ArrayLike) -> Points:
    """Angles between undirected directions, radians, each of one list against each of the other."""
    gap = np.asarray(angles, dtype=np.float64)[:, None] - np.asarray(others, dtype=np.float64)[None, :]
    between: Points = np.abs((gap + np.pi / 2) % np.pi - np.pi / 2)
    return between


def farthest(points: npt.ArrayLike, others: npt.ArrayLike) -> float:
    """The greatest distance from any point to the nearest of the other set, either way round, metres."""
    p, q = (np.asarray(side, dtype=np.float64).reshape(-1, 2) for side in (points, others))
    if len(p) == 0 or len(q) == 0:
        return 0.0 if len(p) == len(q) else np.inf
    gaps = np.linalg.norm(p[:, None] - q[None, :], axis=2)
    return float(max(gaps.min(axis=0).max(), gaps.min(axis=1).max()))
