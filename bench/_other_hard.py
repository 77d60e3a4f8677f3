"""Harder sites of another make: halls joined by gates and passages, turned, staggered, ragged; and how they are seen.

The kinds are those that users meet: several halls, one whose rows run across, a wing at any angle, cross aisles
staggered from row to row, rows of different length and depth, a lidar that sees 5 m, drift that bends rows, pallets on
the floor, empty bays, half of the site not driven; and some of these at once.
"""

from __future__ import annotations

import math
import random
from dataclasses import dataclass, replace

import numpy as np
from _other_halls import OUT, Hall, hall
from _other_joined import WALL, Joint, Layout, Meeting, Place, Standing, join, join_again, put
from _other_plan import Measures, Point

KINDS = (
    "halls",
    "across",
    "wing",
    "staggered",
    "ragged",
    "5 m lidar",
    "bent",
    "pallets",
    "empty bays",
    "partly seen",
    "several",
)
_PALLETS = ((1.2, 0.8), (0.8, 1.2), (1.2, 1.0))  # metres along and across the way
_LAYOUTS, _LOOKS = KINDS[:5], KINDS[5:10]
_SHORT, _SHORT_ALONE = 11.0, 17.0  # metres at least of racks in a row of one of several halls, and of one by itself


@dataclass(frozen=True)
class Hard:
    """What is drawn at random for a site: what it is, and what its halls share; metres, radians."""

    kind: str
    has: tuple[str, ...]
    common: Measures
    bend: float
    unseen: float


def hard(seed: int, draw: random.Random) -> Hard:
    """Draw what a site is like; its kind goes round with the seed."""
    kind = KINDS[seed % len(KINDS)]
    has: tuple[str, ...] = (kind,)
    if kind == "several":
        has = (draw.choice(_LAYOUTS), *draw.sample(_LOOKS, 2))
    style = draw.choice(["legs", "shelves"] if "empty bays" in has else ["solid", "hollow", "legs", "shelves"])
    bay = draw.uniform(1.8, 3.0)
    common = Measures(
        aisle=draw.uniform(2.0, 4.0),
        cross=_cross(style, bay, draw),
        depth=draw.uniform(0.8, 1.3),
        bay=bay,
        rows=draw.randint(3, 6),
        blocks=draw.randint(1, 3),
        bays=draw.randint(3, 6),
        style=style,
        fill=draw.choice([0.6, 0.45, 0.3]) if "empty bays" in has else draw.choice([1, 0.9, 0.75]),
        ends=draw.choice(["both", "both", "both", "west"]),
        walls=draw.choice(["rack", "aisle"]),
        yaw=draw.uniform(-np.pi / 2, np.pi / 2),
        resolution=draw.choice([0.04, 0.05, 0.05, 0.05, 0.08]),
        look=draw.choice(["trinary", "trinary", "grey"]),
        range=5 if "5 m lidar" in has else draw.choice([10, 15, 25]),
        noise=draw.choice([0.01, 0.02, 0.03]),
        clutter=draw.choice([0, 5, 10]),
        wall=WALL,
    )
    bend = draw.uniform(0.04, 0.12) if "bent" in has else 0.0
    unseen = draw.uniform(0.25, 0.5) if "partly seen" in has else 0.0
    return Hard(kind, has, common, bend, unseen)


def _cross(style: str, bay: float, draw: random.Random) -> float:
    """A cross aisle's width: not a bay's where bays may be empty, or in one row nothing would tell them apart."""
    width = draw.uniform(2.4, 4.5)
    return max(width, bay * draw.uniform(1.25, 1.6)) if style in ("legs", "shelves") else width


def layout(site: Hard, draw: random.Random, goods: np.random.Generator) -> Layout:
    """Lay a site out: halls one after the other, each joined to the one before."""
    made = Layout()
    joined = {"halls": draw.choice([2, 2, 3]), "across": draw.choice([2, 3]), "wing": 2}
    count = max(joined.get(name, 1) for name in site.has)
    halls = [Standing(_hall(site, draw), Place((0.0, 0.0), 0.0))]
    out = OUT[draw.choice(list(OUT))]
    for _ in range(1, count):
        any(_joined(site, halls, out, made, draw) for _ in range(500))
    for each in halls:
        put(each, made, goods)
    _litter(site, made, draw, goods)
    return made


def _hall(site: Hard, draw: random.Random, before: Hall | None = None) -> Hall:
    """A hall of its own measures, or but for its racks' number of those of the one before it."""
    common = site.common if before is None else before.measures
    several = any(name in site.has for name in ("halls", "across", "wing"))
    shortest = _SHORT if several else _SHORT_ALONE
    measures = replace(common, blocks=1, bays=1)
    while measures.bay * measures.bays * measures.blocks < shortest:
        measures = _drawn(site, common, several, draw)
    if before is not None and draw.random() < 0.5:
        measures = replace(measures, aisle=draw.uniform(2.0, 4.0), cross=_cross(measures.style, measures.bay, draw))
    return hall(measures, "staggered" in site.has, "ragged" in site.has, draw)


def _drawn(site: Hard, common: Measures, several: bool, draw: random.Random) -> Measures:
    """How many rows, blocks and bays a hall has, and what is at its walls."""
    return replace(
        common,
        rows=draw.randint(3, 5 if several else 6),
        blocks=draw.randint(2, 3) if "staggered" in site.has else draw.randint(1, 2 if several else 3),
        bays=draw.randint(4, 6) if "staggered" in site.has else draw.randint(3, 5 if several else 6),
        ends=draw.choice(["both", "both", "west"]) if several else common.ends,
        walls=draw.choice(["rack", "aisle"]),
    )


def _joined(site: Hard, halls: list[Standing], out: Point, made: Layout, draw: random.Random) -> bool:
    """One more hall on the side `out` of the last one, or none where what was drawn has no room."""
    old, is_across, is_wing = halls[-1], "across" in site.has, "wing" in site.has
    new = _hall(site, draw, old.hall)
    side = min(OUT, key=lambda name: math.dist(OUT[name], old.place.back(out)))
    facing = draw.choice(["south", "north"] if is_across == (side in ("east", "west")) else ["east", "west"])
    ports, doors = old.hall.ports(side, draw), new.ports(facing, draw)
    if is_wing:  # at a corner a way that turns is hard to tell from the corner
        ports, doors = ([port for port in each if not port.is_corner] for each in (ports, doors))
    if not ports or not doors:
        return False
    turn = draw.choice([-1, 1]) * math.radians(draw.uniform(12, 55)) if is_wing else 0.0
    length = WALL if not is_wing and draw.random() < 0.5 else draw.uniform(2.5, 6.0)
    if not join(halls, new, Joint(ports[0], doors[0], turn, length), made):
        return False
    if not is_wing and not is_across:
        join_again(halls, (old.hall.ports(side, draw), new.ports(facing, draw)), ports[0], made)
    return True


def _litter(site: Hard, made: Layout, draw: random.Random, goods: np.random.Generator) -> None:
    """Boxes at the sides of the ways, and pallets that leave room to pass, off the crossings."""
    ways = [way for way in made.corridors if math.dist(way[0], way[1]) > 4]
    length = sum(math.dist(a, b) for a, b, _ in ways)
    count = round(length / 10 * draw.uniform(0.4, 1.0)) if "pallets" in site.has else 0
    for number in range(site.common.clutter + count):
        is_pallet = number >= site.common.clutter
        a, b, width = draw.choices(ways, [math.dist(a, b) for a, b, _ in ways])[0]
        whole = math.dist(a, b)
        ux, uy = (b[0] - a[0]) / whole, (b[1] - a[1]) / whole
        along, hand = draw.uniform(1.0, whole - 1.0), draw.choice([-1, 1])
        long, deep = draw.choice(_PALLETS) if is_pallet else (draw.uniform(0.1, 0.35), draw.uniform(0.1, 0.35))
        if width - deep < 1.2:
            continue
        aside = hand * (width / 2 - deep / 2 - goods.uniform(0, min(0.3, width - deep - 1.2)))
        x, y = a[0] + along * ux - aside * uy, a[1] + along * uy + aside * ux
        if is_pallet and any(math.dist((x, y), meeting.at) < 1.2 + _half(meeting) for meeting in made.meetings):
            continue
        corners = [(-long, -deep), (long, -deep), (long, deep), (-long, deep)]
        made.stands.append([(x + (u * ux - v * uy) / 2, y + (u * uy + v * ux) / 2) for u, v in corners])


def _half(meeting: Meeting) -> float:
    """Half the longer side of a crossing."""
    return max(math.hypot(*side) for side in meeting.sides) / 2
