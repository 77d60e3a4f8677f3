"""Where the robot believes that it was, and what that does to its map."""

from __future__ import annotations

import math

import numpy as np

from groundplan.simulate._lidar import Pose
from groundplan.simulate._plan import Point

Lengths = tuple[float, float]

_BENDS: Lengths = (40.0, 80.0)  # wavelengths of a bend, metres


class _Field:
    """Smooth displacements over a site: three waves along x and three along y, without mean, turn and stretch.

    Those are taken out since the map frame is where the map says it is: so directions and places stay true in the
    mean.
    """

    def __init__(self, outline: list[Point], lengths: Lengths, random: np.random.Generator) -> None:
        xs, ys = [p[0] for p in outline], [p[1] for p in outline]
        self._centre = (min(xs) + max(xs)) / 2, (min(ys) + max(ys)) / 2
        self._waves: list[list[tuple[float, float, float]]] = []  # x part, y part: wave vector and phase
        self._plane: list[tuple[float, float, float]] = []
        for _ in range(2):
            waves = []
            for _ in range(3):
                angle, length = float(random.uniform(0, 2 * math.pi)), float(random.uniform(*lengths))
                k = 2 * math.pi / length
                waves.append((k * math.cos(angle), k * math.sin(angle), float(random.uniform(0, 2 * math.pi))))
            self._waves.append(waves)
        self._grid = [
            (min(xs) + (max(xs) - min(xs)) * i / 20, min(ys) + (max(ys) - min(ys)) * j / 20)
            for i in range(21)
            for j in range(21)
        ]
        for part in range(2):
            raw = [self._wave(part, *p) for p in self._grid]
            mean = math.fsum(raw) / len(raw)
            slopes = []
            for axis in (0, 1):
                arm = [p[axis] - self._centre[axis] for p in self._grid]
                slopes.append(math.fsum(a * r for a, r in zip(arm, raw, strict=True)) / math.fsum(a * a for a in arm))
            self._plane.append((mean, slopes[0], slopes[1]))

    def _wave(self, part: int, x: float, y: float) -> float:
        return math.fsum(math.sin(kx * x + ky * y + phase) for kx, ky, phase in self._waves[part])

    def at(self, part: int, x: float, y: float) -> float:
        """The displacement along x (part 0) or y (part 1)."""
        mean, sx, sy = self._plane[part]
        return self._wave(part, x, y) - mean - sx * (x - self._centre[0]) - sy * (y - self._centre[1])

    def spread(self) -> float:
        """Root mean square of a displacement's parts over the site."""
        square = math.fsum(self.at(part, *p) ** 2 for part in range(2) for p in self._grid)
        return math.sqrt(square / (2 * len(self._grid)))

    def greatest(self) -> float:
        """The greatest displacement over the site."""
        return max(math.hypot(self.at(0, *p), self.at(1, *p)) for p in self._grid)


class Drift:
    """What a SLAM back end leaves of the odometry's error.

    A smooth field over the site bends rows, the same on every pass; a slow error along the drive, a third of it,
    doubles what is seen on two passes. A second field, `bend`, has waves of some tens of metres whatever the site's
    size, and doubles nothing.

    Parameters
    ----------
    amount
        Root mean square of the first field, metres.
    bend
        Greatest displacement of the second, metres.
    outline
        Points whose box is the site.
    random, bending
        One stream for each field.
    """

    def __init__(
        self,
        amount: float,
        outline: list[Point],
        random: np.random.Generator,
        bend: float = 0.0,
        bending: np.random.Generator | None = None,
    ) -> None:
        self._amount = amount
        size = max(max(p[k] for p in outline) - min(p[k] for p in outline) for k in (0, 1))
        field = _Field(outline, (0.6 * size, 1.6 * size), random)
        self._fields = [(field, amount / field.spread())] if amount else []
        if bend and bending is not None:
            field = _Field(outline, _BENDS, bending)
            self._fields.append((field, bend / field.greatest()))

    def bend(self, at: Point) -> Point:
        """Where the map shows this point of the plan."""
        x, y = at
        for field, gain in self._fields:
            x, y = x + gain * field.at(0, *at), y + gain * field.at(1, *at)
        return x, y

    def believed(self, poses: list[tuple[Pose, float]], random: np.random.Generator) -> list[Pose]:
        """The poses as the robot's SLAM has them."""
        if not self._fields:
            return [pose for pose, _ in poses]
        wander, before, result = [0.0, 0.0, 0.0], 0.0, []
        scale = (0.35 * self._amount, 0.35 * self._amount, 0.02 * self._amount)
        for pose, driven in poses:
            keep = math.exp(-(driven - before) / 8.0)
            fresh = math.sqrt(1 - keep * keep)
            wander = [keep * w + fresh * s * float(random.normal()) for w, s in zip(wander, scale, strict=True)]
            before = driven
            x, y = self.bend((pose.x, pose.y))
            turn = self._turn(pose.x, pose.y)
            result.append(Pose(x + wander[0], y + wander[1], pose.heading + turn + wander[2]))
        return result

    def _turn(self, x: float, y: float) -> float:
        """How far the fields turn what is near this point: half their curl."""
        h, turn = 0.5, 0.0
        for field, gain in self._fields:
            up = field.at(1, x + h, y) - field.at(1, x - h, y)
            across = field.at(0, x, y + h) - field.at(0, x, y - h)
            turn += gain * (up - across) / (4 * h)
        return turn
