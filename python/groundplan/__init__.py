"""Groundplan surveys robot maps: it finds the ground plan in an occupancy grid.

    import groundplan

    map = groundplan.read("warehouse.yaml")
    survey = groundplan.survey(map)
    survey.write("survey.json")
"""

from groundplan._core import version as _version
from groundplan._errors import FormatError, GroundplanError, MapError, ParameterError
from groundplan.maps import Map, MapWarning, from_array, read
from groundplan.parameters import table as parameters
from groundplan.stages import (
    Adjacency,
    Directions,
    Gradients,
    Lines,
    Occupancy,
    Radiogram,
    Response,
    Subdivision,
    Walls,
    find_adjacency,
    find_directions,
    find_gradients,
    find_lines,
    find_occupancy,
    find_radiograms,
    find_response,
    find_walls,
    subdivide,
)
from groundplan.survey import Survey, survey

__version__ = _version()

__all__ = [
    "Adjacency",
    "Directions",
    "FormatError",
    "Gradients",
    "GroundplanError",
    "Lines",
    "Map",
    "MapError",
    "MapWarning",
    "Occupancy",
    "ParameterError",
    "Radiogram",
    "Response",
    "Subdivision",
    "Survey",
    "Walls",
    "find_adjacency",
    "find_directions",
    "find_gradients",
    "find_lines",
    "find_occupancy",
    "find_radiograms",
    "find_response",
    "find_walls",
    "from_array",
    "parameters",
    "read",
    "subdivide",
    "survey",
]
