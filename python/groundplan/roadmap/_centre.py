"""Centre lines held against the map's pixels: between the posts of racks, and clear of what sticks out.

Goods that stand back in their bays can make a line of their own, deeper than the rack's face, and a corridor's side is
then there. The posts stand at the face, one at every pitch.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from groundplan.roadmap._faces import posts
from groundplan.roadmap._lanes import Way
from groundplan.roadmap._pixels import Floats, Pixels

if TYPE_CHECKING:
    from groundplan.export._places import Place
    from groundplan.survey import Survey

#: A side is the posts' when they stand nearer than it by this, metres; less is the width of the face's own pixels.
NEARER_M = 0.22
#: How far before a corridor's side posts are looked for, metres, and how far along from where one is due.
BEFORE_M, DUE_M = 0.6, 0.15
#: Posts stand in one line to this, metres; so many at least, and such a share of those due.
IN_LINE_M, POSTS, SHARE = 0.05, 5, 0.6
#: A lane gives way to what sticks out by no more than this, metres, in these steps; its ends, so near to what it runs
#: towards, are not asked.
ASIDE_M, STEP_M, ENDS_M = 0.12, 0.02, 1.0


def centred(survey: Survey, places: list[Place], way: Way, pixels: Pixels, keep: float) -> Way:
    """A corridor with its lane between the posts on both sides, and clear of what sticks out as far as little helps."""
    a, b = way.start, way.point(way.length)
    s, d = pixels.beside(a, b, way.width / 2 + BEFORE_M)
    left, right = (_side(survey, places, way, side, s, d) for side in (1.0, -1.0))
    middle = (left - right) / 2
    inner = (s > ENDS_M) & (s < way.length - ENDS_M)
    aside = _aside(d[inner] - middle, keep + pixels.half)
    return replace(way, start=way.point(0.0, middle + aside), width=left + right, aside=aside)


def _aside(d: Floats, keep: float) -> float:
    """The least step to the left or right after which a line keeps clear; none where none helps."""
    steps = np.arange(round(ASIDE_M / STEP_M) + 1) * STEP_M
    for step in sorted(np.concatenate([steps, -steps[1:]]), key=abs):
        if np.abs(d - step).min(initial=keep) >= keep:
            return float(step)
    return 0.0


def _side(survey: Survey, places: list[Place], way: Way, side: float, s: Floats, d: Floats) -> float:
    """How far a corridor is free to one side: to the line on which the posts of its racks stand, else as it says."""
    told = way.width / 2
    due = np.array(sorted(set(_due(survey, places, way, side))))
    if len(due) < POSTS:
        return told
    beside = side * d > told - BEFORE_M
    s, off = s[beside], side * d[beside]
    # For each post that is due, at which distances something stands.
    which = np.abs(s[:, None] - due) < DUE_M
    offsets = np.arange(told - BEFORE_M, told - NEARER_M, IN_LINE_M / 2)
    posts = [int(which[np.abs(off - offset) <= IN_LINE_M].any(0).sum()) for offset in offsets]
    if not posts or max(posts) < max(POSTS, SHARE * len(due)):
        return told
    return float(offsets[int(np.argmax(posts))]) + IN_LINE_M


def _due(survey: Survey, places: list[Place], way: Way, side: float) -> Iterator[float]:
    """Where posts are due along a corridor, by the pitch and phase of the racks on one side of it."""
    for row in posts(survey, places):
        ends = [way.place_of(p) for p in row.axis]
        gap = abs(side * (ends[0][1] + ends[1][1]) / 2 - row.width / 2 - way.width / 2)
        if gap > BEFORE_M or abs(ends[0][1] - ends[1][1]) > 0.1 * row.length:
            continue
        for n in range(math.floor((row.length - row.first) / row.pitch) + 1):
            along = ends[0][0] + (ends[1][0] - ends[0][0]) * (row.first + n * row.pitch) / row.length
            if ENDS_M < along < way.length - ENDS_M:
                yield along
