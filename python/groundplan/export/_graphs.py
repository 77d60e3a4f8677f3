"""The graphs that the graph formats write: with attributes that are plain values, as all of those formats can say."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from groundplan._errors import ParameterError
from groundplan.export._places import places
from groundplan.export._text import one_line
from groundplan.roadmap import road_map

if TYPE_CHECKING:
    import networkx

    from groundplan.survey import Survey


def graph(survey: Survey, which: str, roads: dict[str, Any]) -> networkx.Graph[Any]:
    """The graph of that name: ``places``, ``faces``, or ``roads``, which is directed, with the options of `road_map`.

    Coordinates are the attributes ``x`` and ``y``, metres.

    Raises
    ------
    ParameterError
        ``export.graph``.
    """
    if which not in ("places", "faces", "roads"):
        raise ParameterError("export.graph", f"there is no graph {which!r}", "there are places, faces and roads")
    if which == "roads":
        made = road_map(survey, **roads).to_networkx()
        made.graph["map"] = one_line(survey.map.image)
        return made
    return _places(survey) if which == "places" else _faces(survey)


def _places(survey: Survey) -> networkx.Graph[Any]:
    """Nodes by the places' ids; an edge between neighbours."""
    import networkx

    made: networkx.Graph[Any] = networkx.Graph(frame="map", units="m", map=one_line(survey.map.image))
    found = places(survey)
    for place in found:
        numbers = {"width": place.width, "area": place.area}
        texts = {"use": place.use, "region": "" if place.region is None else found[place.region].id}
        made.add_node(
            place.id,
            name=place.name,
            kind=place.kind,
            label=place.label,
            x=place.centre[0],
            y=place.centre[1],
            **{key: value for key, value in numbers.items() if value is not None},
            **{key: value for key, value in texts.items() if value},
        )
    for place in found:
        made.add_edges_from((place.id, found[n].id) for n in place.neighbours if n > place.label)
    return made


def _faces(survey: Survey) -> networkx.Graph[Any]:
    """As `Survey.to_networkx`, the centre as two numbers."""
    made = survey.to_networkx()
    made.graph |= {"frame": "map", "units": "m", "map": one_line(survey.map.image)}
    for _, values in made.nodes(data=True):
        values["x"], values["y"] = values.pop("centre")
    return made
