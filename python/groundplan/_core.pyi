from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

__all__ = [
    "find_adjacency",
    "find_directions",
    "find_gradients",
    "find_lines",
    "find_occupancy",
    "find_radiograms",
    "find_response",
    "find_walls",
    "problems",
    "resolve",
    "subdivide",
    "survey",
    "table",
    "version",
]

Layout: TypeAlias = tuple[
    npt.NDArray[np.uint8],
    bool,
    npt.NDArray[np.int8],
    npt.NDArray[np.uint8],
    float,
    tuple[float, float, float],
]
Record: TypeAlias = dict[str, Any]

def version() -> str: ...
def table() -> list[Record]: ...
def resolve(parameters: Record) -> Record: ...
def survey(
    layout: Layout,
    parameters: Record,
    threads: int,
    directions: Record | None = None,
    lines: Record | None = None,
) -> Record: ...
def find_gradients(layout: Layout, parameters: Record, threads: int) -> Record: ...
def find_directions(layout: Layout, gradients: Record, parameters: Record) -> Record: ...
def find_radiograms(layout: Layout, gradients: Record, directions: Record, parameters: Record) -> list[Record]: ...
def find_response(radiogram: Record, parameters: Record) -> Record: ...
def find_lines(radiograms: list[Record], parameters: Record) -> Record: ...
def subdivide(layout: Layout, directions: Record, lines: Record) -> Record: ...
def problems(subdivision: Record) -> list[str]: ...
def find_occupancy(
    layout: Layout, gradients: Record, directions: Record, lines: Record, parameters: Record, threads: int
) -> Record: ...
def find_walls(subdivision: Record, occupancy: Record, parameters: Record) -> Record: ...
def find_adjacency(subdivision: Record, walls: Record) -> Record: ...
