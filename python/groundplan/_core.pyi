from typing import Any, Self, TypeAlias, final

import numpy as np
import numpy.typing as npt

__all__ = [
    "SAME_DIRECTION",
    "UNSURE",
    "Labels",
    "Locator",
    "Memory",
    "Ways",
    "add_rack_faces",
    "find_adjacency",
    "find_directions",
    "find_gradients",
    "find_gradients_in",
    "find_labels",
    "find_lines",
    "find_occupancy",
    "find_radiograms",
    "find_response",
    "find_walls",
    "is_large",
    "problems",
    "reach",
    "resolve",
    "subdivide",
    "sum_faces",
    "survey",
    "table",
    "version",
]

_Layout: TypeAlias = tuple[
    npt.NDArray[np.uint8],
    bool,
    npt.NDArray[np.int8],
    npt.NDArray[np.uint8],
    float,
    tuple[float, float, float],
]
_Record: TypeAlias = dict[str, Any]
_Frame: TypeAlias = tuple[int, int, float, tuple[float, float, float]]
_Points: TypeAlias = npt.NDArray[np.float64]
_Ragged: TypeAlias = tuple[_Points, list[int]]

SAME_DIRECTION: float
UNSURE: float

@final
class Labels:
    def __len__(self) -> int: ...
    def some(self, start: int, to: int) -> list[_Record]: ...

@final
class Locator:
    def __new__(
        cls,
        place: _Frame,
        directions: _Record,
        lines: _Record,
        ring_points: _Points,
        offsets: list[int],
        labels: list[int],
    ) -> Self: ...
    @property
    def faces(self) -> int: ...
    def locate(self, x: float, y: float) -> int | None: ...
    def locate_all(self, array: _Points) -> npt.NDArray[np.int32]: ...
    def labels_at(self, x: float, y: float) -> list[int]: ...
    def labels_along(self, way: _Points, step: float) -> list[int]: ...
    def along(self, way: _Points) -> npt.NDArray[np.uint32]: ...

@final
class Memory: ...

@final
class Ways:
    @staticmethod
    def of_map(layout: _Layout, closed: _Ragged, clearance: float) -> Ways: ...
    @staticmethod
    def of_survey(place: _Frame, free: _Ragged, taken: _Points, closed: _Ragged, clearance: float) -> Ways: ...
    def is_open(self, x: float, y: float) -> bool: ...
    def nearest(self, x: float, y: float, reach: float) -> tuple[float, float] | None: ...
    def route(self, start: tuple[float, float], end: tuple[float, float]) -> _Points | None: ...

def version() -> str: ...
def table() -> list[_Record]: ...
def resolve(parameters: _Record) -> _Record: ...
def survey(
    layout: _Layout,
    parameters: _Record,
    threads: int,
    given: _Record,
    keep: bool,
) -> _Record: ...
def is_large(layout: _Layout) -> bool: ...
def find_gradients_in(
    layout: _Layout,
    held: tuple[int, int],
    rows: tuple[int, int],
    columns: tuple[int, int],
    parameters: _Record,
    threads: int,
) -> _Record: ...
def reach(resolution: float, parameters: _Record) -> int: ...
def sum_faces(
    layout: _Layout,
    held: tuple[int, int],
    rows: tuple[int, int],
    directions: _Record,
    lines: _Record,
    threads: int,
) -> npt.NDArray[np.int64]: ...
def find_gradients(layout: _Layout, parameters: _Record, threads: int) -> _Record: ...
def find_directions(layout: _Layout, gradients: _Record, parameters: _Record, threads: int) -> _Record: ...
def find_radiograms(
    layout: _Layout, gradients: _Record, directions: _Record, parameters: _Record, threads: int
) -> list[_Record]: ...
def find_response(radiogram: _Record, parameters: _Record) -> _Record: ...
def find_lines(radiograms: list[_Record], parameters: _Record) -> _Record: ...
def add_rack_faces(
    layout: _Layout, gradients: _Record, directions: _Record, lines: _Record, parameters: _Record, threads: int
) -> _Record: ...
def subdivide(layout: _Layout, directions: _Record, lines: _Record, threads: int) -> _Record: ...
def problems(subdivision: _Record) -> list[str]: ...
def find_occupancy(
    layout: _Layout, gradients: _Record, directions: _Record, lines: _Record, parameters: _Record, threads: int
) -> _Record: ...
def find_walls(subdivision: _Record, occupancy: _Record, parameters: _Record) -> _Record: ...
def find_adjacency(subdivision: _Record, walls: _Record) -> _Record: ...
def find_labels(
    layout: _Layout,
    gradients: _Record,
    directions: _Record,
    lines: _Record,
    occupancy: _Record,
    walls: _Record,
    parameters: _Record,
    threads: int,
) -> list[_Record]: ...
