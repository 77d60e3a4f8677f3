"""The same place at another time: a share of what stands in it stands elsewhere."""

from __future__ import annotations

import numpy as np

from groundplan.simulate._plan import GroundPlan


def rearrange(plan: GroundPlan, share: float, random: np.random.Generator) -> None:
    """Take a share of the things away, and put as many of their kind where there is room: there, or in empty places."""
    here = [thing for thing in plan.things if thing.last > thing.first]
    taken = [thing for thing in here if random.random() < share]
    for kind in dict.fromkeys(thing.kind for thing in taken):
        gone = [thing for thing in taken if thing.kind == kind]
        empty = [thing for thing in plan.things if thing.kind == kind and thing.last == thing.first]
        places = [thing for thing in (*empty, *gone) if thing.put is not None]
        for index in random.permutation(len(places))[: len(gone)].tolist():
            put = places[index].put
            if put is not None:
                put(random)
    away = {index for thing in taken for index in range(thing.first, thing.last)}
    plan.shapes = [shape for index, shape in enumerate(plan.shapes) if index not in away]
