"""The options of simulated places, each with its default, range and sentence."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Any

from groundplan._errors import ParameterError

SHAPES = ("straight", "L", "T", "ring")
SIDES = ("south", "east", "north", "west")


def _option(default: Any, text: str, **more: Any) -> Any:
    """A dataclass field with its sentence; `least` and `most` bound a number, `unit` stands in the help."""
    return dataclasses.field(default=default, metadata={"help": text, **more})


#: Options of the robot and its map, the same for every kind of place.
_ROBOT: dict[str, tuple[Any, str, dict[str, Any]]] = {
    "bend": (
        0.0,
        "How far the map bends walls and rows, smoothly over tens of metres, at most.",
        {"unit": "m", "least": 0.0, "most": 0.5},
    ),
    "drift": (0.02, "Error of the robot's poses that bends and doubles.", {"unit": "m", "least": 0.0, "most": 1.0}),
    "remake": (
        0,
        "Which map of the same place: other noise and drift, and some of what stands in it was moved.",
        {"least": 0, "most": 1000},
    ),
    "moved": (0.05, "Share of the goods and the furniture that a remake has elsewhere.", {"least": 0.0, "most": 1.0}),
    "lidar_range": (15.0, "Greatest range of the lidar.", {"unit": "m", "least": 2.0, "most": 100.0}),
    "beams": (600, "Beams in a full turn of the lidar.", {"least": 60, "most": 7200}),
    "noise": (0.012, "Deviation of a measured range.", {"unit": "m", "least": 0.0, "most": 0.5}),
    "scan_every": (0.4, "Way driven between two scans.", {"unit": "m", "least": 0.05, "most": 5.0}),
    "resolution": (0.05, "Side of a pixel.", {"unit": "m", "least": 0.01, "most": 0.5}),
}


def _robot(name: str) -> Any:
    """The field of one of those."""
    default, text, more = _ROBOT[name]
    return _option(default, text, **more)


def _hold(options: Any) -> None:
    """Hold every number to its range."""
    for item in dataclasses.fields(options):
        value = getattr(options, item.name)
        if "least" in item.metadata:
            least, most = item.metadata["least"], item.metadata["most"]
            if not least <= value <= most:  # also catches NaN
                raise ParameterError("simulate.range", f"{item.name} is {value}, not in {least} .. {most}")


@dataclass(frozen=True)
class WarehouseOptions:
    """What a simulated warehouse is like. Each field's metadata holds its help, unit and range.

    Raises
    ------
    ParameterError
        ``simulate.range`` for a value out of its range, ``simulate.side`` for an unknown side,
        ``simulate.disconnected`` when no cross aisle joins the aisles, ``simulate.small`` when nothing fits.
    """

    width: float = _option(42.0, "Length of the hall along its rack rows.", unit="m", least=12.0, most=120.0)
    depth: float = _option(28.0, "Length of the hall across its rack rows.", unit="m", least=10.0, most=120.0)
    yaw: float = _option(0.0, "Angle of the rack rows in the map.", unit="deg", least=-360.0, most=360.0)
    skew: float = _option(
        0.0, "How far the cross aisles lean from square to the rows.", unit="deg", least=-35.0, most=35.0
    )
    aisle: float = _option(3.0, "Width of the aisles, about.", unit="m", least=1.8, most=8.0)
    cross_aisle: float = _option(3.4, "Width of the cross aisles.", unit="m", least=1.8, most=8.0)
    cross_aisles: int = _option(1, "Cross aisles between those along the walls.", least=0, most=12)
    bay: float = _option(2.7, "Pitch of the racks' posts, about.", unit="m", least=1.0, most=6.0)
    rack_depth: float = _option(1.1, "Depth of a rack.", unit="m", least=0.4, most=3.0)
    sparse: float = _option(0.1, "Share of bays that are empty.", least=0.0, most=1.0)
    clutter: float = _option(
        0.4, "Things left on the floor: pallets, boxes, poles.", unit="per 10 m of aisle", least=0.0, most=10.0
    )
    goods: float = _option(
        0.0, "Stacks of pallets on the floor beside the racks.", unit="per 10 m of aisle", least=0.0, most=5.0
    )
    staggered: float = _option(
        0.0,
        "How far each rack row has its cross aisles from the regular places, at most.",
        unit="m",
        least=0.0,
        most=30.0,
    )
    uneven: float = _option(
        0.0, "How much the rows differ in depth, and the share of them that end early.", least=0.0, most=1.0
    )
    halls: int = _option(1, "Halls, joined by passages or gates.", least=1, most=5)
    gap: float = _option(
        0.5, "Length of the passages between halls; 0.5 is a gate in one wall.", unit="m", least=0.5, most=30.0
    )
    crosswise: bool = _option(False, "Let the rows of every second hall run across those of the others.")
    wing: float = _option(
        0.0, "Angle of a wing that is turned against the halls, 0 for no wing.", unit="deg", least=-60.0, most=60.0
    )
    pillars: float = _option(
        0.0, "Pitch of a grid of pillars that carries the roof, about; 0 for none.", unit="m", least=0.0, most=30.0
    )
    bend: float = _robot("bend")
    drift: float = _robot("drift")
    partial: float = _option(0.0, "Share of the ways that the robot does not drive.", least=0.0, most=0.9)
    closed_sides: tuple[str, ...] = _option(
        (), "Sides without an aisle along the wall: south, east, north, west.", choices=SIDES
    )
    remake: int = _robot("remake")
    moved: float = _robot("moved")
    lidar_range: float = _robot("lidar_range")
    beams: int = _robot("beams")
    noise: float = _robot("noise")
    scan_every: float = _robot("scan_every")
    resolution: float = _robot("resolution")

    def __post_init__(self) -> None:
        """Hold every value to its range."""
        _hold(self)
        for side in self.closed_sides:
            if side not in SIDES:
                raise ParameterError("simulate.side", f"closed_sides has {side!r}, not one of {', '.join(SIDES)}")
        if {"east", "west"} <= set(self.closed_sides) and not self.cross_aisles:
            raise ParameterError(
                "simulate.disconnected",
                "east and west are closed and cross_aisles is 0: nothing joins the aisles",
                "leave one of the two sides open, or ask for a cross aisle",
            )


@dataclass(frozen=True)
class OfficeOptions:
    """What a simulated office is like. Each field's metadata holds its help, unit and range.

    Raises
    ------
    ParameterError
        ``simulate.range`` for a value out of its range, ``simulate.shape`` for an unknown shape, ``simulate.small``
        when nothing fits.
    """

    shape: str = _option("straight", "How its corridors run: straight, L, T or ring.", choice=SHAPES)
    width: float = _option(36.0, "Length of the building.", unit="m", least=14.0, most=120.0)
    depth: float = _option(26.0, "Depth of the building where its corridors turn.", unit="m", least=14.0, most=120.0)
    yaw: float = _option(0.0, "Angle of the building in the map.", unit="deg", least=-360.0, most=360.0)
    corridor: float = _option(2.0, "Free width of the corridors.", unit="m", least=1.2, most=5.0)
    room_width: float = _option(4.0, "Length of a room along the corridor, about.", unit="m", least=2.4, most=12.0)
    room_depth: float = _option(5.0, "Depth of a room, about.", unit="m", least=3.0, most=12.0)
    halls: int = _option(0, "Open-plan halls in place of rooms.", least=0, most=8)
    door: float = _option(0.9, "Width of the doors, about.", unit="m", least=0.7, most=1.8)
    closed: float = _option(0.0, "Share of the doors that are closed.", least=0.0, most=1.0)
    half_open: float = _option(0.2, "Share of the doors that are half open.", least=0.0, most=1.0)
    linked: float = _option(0.1, "Share of neighbouring rooms with a door between them.", least=0.0, most=1.0)
    furniture: float = _option(0.5, "How much furniture there is, from none to all that fits.", least=0.0, most=1.0)
    bend: float = _robot("bend")
    drift: float = _robot("drift")
    remake: int = _robot("remake")
    moved: float = _robot("moved")
    lidar_range: float = _robot("lidar_range")
    beams: int = _robot("beams")
    noise: float = _robot("noise")
    scan_every: float = _robot("scan_every")
    resolution: float = _robot("resolution")

    def __post_init__(self) -> None:
        """Hold every value to its range."""
        _hold(self)
        if self.shape not in SHAPES:
            raise ParameterError("simulate.shape", f"shape is {self.shape!r}, not one of {', '.join(SHAPES)}")
