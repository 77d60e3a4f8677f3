"""Groundplan surveys robot maps: it finds the ground plan in an occupancy grid.

    import groundplan

    map = groundplan.read("warehouse.yaml")
    survey = groundplan.survey(map)
    survey.write("survey.json")

Importing the package costs next to nothing: each name below is imported when it is first asked for.
"""

import sys
from types import ModuleType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from groundplan import evaluate as evaluate
    from groundplan import export as export
    from groundplan import figures as figures
    from groundplan import maps as maps
    from groundplan import roadmap as roadmap
    from groundplan import simulate as simulate
    from groundplan._errors import FormatError, GroundplanError, MapError, ParameterError
    from groundplan._pipeline import survey
    from groundplan._queries import Route
    from groundplan._results import (
        Adjacency,
        Directions,
        Gradients,
        Lines,
        Occupancy,
        Radiogram,
        Response,
        Subdivision,
        Walls,
    )
    from groundplan.maps import Map, MapWarning, from_array, read
    from groundplan.parameters import table as parameters
    from groundplan.stages import (
        add_rack_faces,
        find_adjacency,
        find_directions,
        find_gradients,
        find_labels,
        find_lines,
        find_occupancy,
        find_radiograms,
        find_response,
        find_walls,
        subdivide,
    )
    from groundplan.survey import Survey

    __version__: str

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
    "Route",
    "Subdivision",
    "Survey",
    "Walls",
    "add_rack_faces",
    "find_adjacency",
    "find_directions",
    "find_gradients",
    "find_labels",
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

#: Modules that are imported, too, when they are first asked for.
_MODULES = ("evaluate", "export", "figures", "maps", "roadmap", "simulate")

#: Each has what it makes and what the ones before it made.
_HOMES = ("_errors", "maps", "stages", "survey", "_pipeline")

if not TYPE_CHECKING:  # a type checker would take any name at all for one that __getattr__ gives

    def __getattr__(name: str) -> object:
        """A public name, imported when it is first asked for."""
        from importlib import import_module

        if name == "__version__":
            return import_module("groundplan._core").version()
        if name in _MODULES:
            return import_module(f"groundplan.{name}")
        if name not in __all__:
            raise AttributeError(f"module 'groundplan' has no attribute {name!r}")
        if name == "parameters":
            value = import_module("groundplan.parameters").table
        else:
            homes = (import_module(f"groundplan.{home}") for home in _HOMES)
            value = next(vars(home)[name] for home in homes if name in vars(home))
        globals()[name] = value
        return value

    def __dir__() -> list[str]:
        return sorted({*globals(), *__all__, *_MODULES, "__version__"})


class _Package(ModuleType):
    """Two modules have the names of the functions they hold: importing them must not hide the functions."""

    def __setattr__(self, name: str, value: object) -> None:
        if not (isinstance(value, ModuleType) and name in __all__):
            super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Package
