"""The one table of formats and the one of their options: what the command line, `Survey.export` and the list go by.

Nothing heavy is imported here: the list and ``--help`` answer at once.
"""

from __future__ import annotations

from dataclasses import dataclass

from groundplan._errors import ParameterError


@dataclass(frozen=True)
class Format:
    """One format. Its module is `groundplan.export.NAME`, with ``write(survey, path, **options) -> list[Path]``.

    Attributes
    ----------
    name : str
        What ``--to`` takes; the module's name, dashes there being underscores.
    suffix : str
        What the file's name ends in; the map's name comes before it. Where a format is several files, this is the
        one that names the others, which lie beside it and have its name up to the suffix.
    holds : str
        What is in it.
    readers : str
        Who reads it.
    tested : str
        What the tests read it back with.
    options : tuple of str
        Names from OPTIONS that its ``write`` takes.
    needs : tuple of str
        Modules that it imports, none of them a core dependency.
    extra : str or None
        The extra that installs them.
    map : str
        ``no``; ``may`` use the map's pixels where they are given (``write(..., map=None)``); ``must`` have them.
    """

    name: str
    suffix: str
    holds: str
    readers: str
    tested: str
    options: tuple[str, ...] = ()
    needs: tuple[str, ...] = ()
    extra: str | None = None
    map: str = "no"


@dataclass(frozen=True)
class Option:
    """What a format can be told. `kind`: ``text``, ``number`` (positive), ``numbers`` (with commas), ``file`` or
    ``choice`` of `choices`.
    """  # noqa: D205

    sentence: str
    metavar: str
    kind: str = "text"
    choices: tuple[str, ...] = ()


#: Options by name; the flag has dashes for the underscores.
OPTIONS: dict[str, Option] = {
    "graph": Option(
        "the graph to write: places (default), faces (the cells of the subdivision) or roads (the road map)",
        "WHICH",
        "choice",
        ("places", "faces", "roads"),
    ),
    "layers": Option("a table that replaces layers, TOML or CSV", "FILE", "file"),
    "units": Option("the unit of lengths: m (default) or mm", "UNIT", "choice", ("m", "mm")),
    "vehicle_width": Option("leave corridors and doors that are narrower out of the road map", "M", "number"),
    "rules": Option("speeds and one-way lanes by name, from a TOML file", "FILE", "file"),
    "keep": Option("keep out of some only of racks,walls,pillars", "KINDS"),
    "max_speed": Option("the vehicle's greatest speed: limits are then in percent of it, else in m/s", "M/S", "number"),
    "spurs": Option("lead spurs from the lanes to the pick faces, up to so far before them", "M", "number"),
    "vehicle_type": Option("the id of the vehicles that the layout is for (default AGV)", "ID"),
    "date": Option("the date that the file carries, ISO 8601 (default: SOURCE_DATE_EPOCH, else now)", "DATE"),
    "anchor": Option(
        "where the map frame's origin lies, and where its x axis points: degrees clockwise from north",
        "LAT,LON,HEADING",
        "numbers",
    ),
    "scale": Option("the plan at 1 to so many (default: the largest round one that fits on 400 mm)", "N", "number"),
    "height": Option("how high walls and rooms are, metres; nobody has measured it (default 3)", "METRES", "number"),
}

#: What every format with a road map takes, for `groundplan.roadmap.road_map`.
ROADS = ("vehicle_width", "rules", "spurs")

FORMATS: dict[str, Format] = {
    form.name: form
    for form in (
        Format(
            "csv",
            ".places.csv",
            "a table of places: name, kind, polygon as WKT, centre, width, neighbours",
            "warehouse management systems, spreadsheets, QGIS as delimited text",
            "Python's csv, shapely",
            needs=("shapely",),
            extra="fleet",
        ),
        Format(
            "dxf",
            ".dxf",
            "a drawing: walls, racks, regions, centre lines, road map, names, the map beneath it",
            "AutoCAD, BricsCAD, LibreCAD, QCAD, FreeCAD and layout tools of AGVs; they save it as DWG",
            "ezdxf's audit, GDAL, LibreCAD",
            options=("units", "layers", *ROADS),
            needs=("networkx", "shapely"),
            extra="fleet",
            map="may",
        ),
        Format(
            "geojson",
            ".local.geojson",
            "every layer in one collection; with an anchor in true longitude and latitude, and named .geojson",
            "QGIS, GDAL, web maps",
            "GDAL, the rules of RFC 7946",
            options=("anchor", *ROADS),
            needs=("shapely", "pyproj", "networkx"),
            extra="gis",
            map="may",
        ),
        Format(
            "gpkg",
            ".gpkg",
            "a GeoPackage: faces, regions, corridors, racks, lines, walls, doors, graph and road map as layers",
            "QGIS, GDAL, ArcGIS",
            "SQLite, GDAL, QGIS",
            options=("date", *ROADS),
            needs=("pyogrio", "shapely", "networkx"),
            extra="gis",
            map="may",
        ),
        Format(
            "graphml",
            ".graphml",
            "the graph of places, faces or roads as GraphML",
            "networkx, Gephi, yEd, Cytoscape, igraph",
            "networkx",
            options=("graph", *ROADS),
            needs=("networkx", "shapely"),
            extra="fleet",
            map="may",
        ),
        Format(
            "ifc",
            ".ifc",
            "a building model, IFC4: spaces, walls, racks, pillars, doors, space boundaries; heights are invented",
            "Revit, ArchiCAD, FreeCAD, Bonsai, IfcOpenShell",
            "IfcOpenShell's validation with all rules",
            options=("date", "height"),
            needs=("ifcopenshell", "shapely"),
            extra="bim",
        ),
        Format(
            "indoorgml",
            ".indoor.gml",
            "IndoorGML 1.1: cells, boundaries, and their dual graph",
            "research on indoor navigation",
            "a grammar of OGC 19-011r4, networkx",
            options=("graph",),
            needs=("shapely",),
            extra="fleet",
        ),
        Format(
            "json",
            ".graph.json",
            "the graph of places, faces or roads as node-link JSON",
            "networkx, D3, any program",
            "networkx",
            options=("graph", *ROADS),
            needs=("networkx", "shapely"),
            extra="fleet",
            map="may",
        ),
        Format(
            "keepout",
            ".keepout.yaml",
            "Nav2's keep-out mask of racks, walls, pillars and closed ways (YAML, PGM), and its servers' parameters",
            "Nav2's map server and keep-out filter",
            "the map server's rules",
            options=("keep", "rules"),
            needs=("shapely",),
            extra="fleet",
        ),
        Format(
            "lif",
            ".lif.json",
            "the road map as VDMA LIF 1.0.0: nodes, directed edges, stations at pick faces",
            "master controls of VDA 5050 fleets, LIF editors",
            "the VDMA's schema",
            options=("date", "vehicle_type", *ROADS),
            needs=("networkx", "shapely"),
            extra="fleet",
            map="may",
        ),
        Format(
            "nav2",
            ".route.geojson",
            "the road map as a route graph",
            "the Nav2 Route Server, its RViz panel, QGIS",
            "the graph loader's rules, Nav2's own graphs",
            options=ROADS,
            needs=("networkx", "shapely"),
            extra="fleet",
            map="may",
        ),
        Format(
            "opentcs",
            ".opentcs.xml",
            "the road map as a plant model of openTCS 7: points, paths, locations, blocks",
            "openTCS",
            "openTCS's XSD",
            options=ROADS,
            needs=("networkx", "shapely"),
            extra="fleet",
            map="may",
        ),
        Format(
            "pdf",
            ".report.pdf",
            "a report: the plan, the figures that the map allows, a table of places, warnings",
            "people, on paper and on screens",
            "poppler",
            options=("date",),
            needs=("shapely",),
            extra="fleet",
            map="may",
        ),
        Format(
            "rmf-building",
            ".building.yaml",
            "lanes, walls and floor in Cartesian metres",
            "Open-RMF's traffic editor, rmf_site, building_map_tools",
            "the rules of building_map_tools",
            options=ROADS,
            needs=("networkx", "shapely"),
            extra="fleet",
            map="may",
        ),
        Format(
            "rmf-nav",
            ".nav.yaml",
            "the road map as a navigation graph",
            "Open-RMF's fleet adapters",
            "the rules of the fleet adapter's parser",
            options=ROADS,
            needs=("networkx", "shapely"),
            extra="fleet",
            map="may",
        ),
        Format(
            "speed",
            ".speed.yaml",
            "Nav2's speed mask (YAML, PGM), and its servers' parameters; without rules half the speed at junctions",
            "Nav2's map server and speed filter",
            "the map server's and the filter's rules",
            options=("rules", "max_speed"),
            needs=("shapely",),
            extra="fleet",
        ),
        Format(
            "straight",
            ".straight.yaml",
            "the map turned so that its strongest direction is the x axis (YAML, PGM), and the turn both ways (JSON)",
            "map_server, Nav2, AMCL, every planner on grids",
            "Pillow, and surveyed again",
            map="must",
        ),
        Format(
            "svg",
            ".plan.svg",
            "the plan to scale, a layer for each kind, with legend and scale bar; the map beneath it where it is given",
            "browsers, Inkscape, Illustrator, any drawing program",
            "lxml, librsvg",
            options=("scale",),
            needs=("shapely",),
            extra="fleet",
            map="may",
        ),
        Format(
            "vda5050",
            ".zones.json",
            "a zone set of VDA 5050 3.0: blocked, directed and slow zones",
            "VDA 5050 vehicles and master controls",
            "the VDA 5050 schema",
            options=("date", *ROADS),
            needs=("networkx", "shapely"),
            extra="fleet",
            map="may",
        ),
        Format(
            "vector-objects",
            ".vector_objects.yaml",
            "racks and pillars as polygons and circles to keep out of, as parameters",
            "Nav2's Vector Object Server",
            "the server's own sample",
            needs=("shapely",),
            extra="fleet",
        ),
    )
}


def format_named(name: str) -> Format:
    """The format of a name.

    Raises
    ------
    ParameterError
        ``export.format``.
    """
    if name not in FORMATS:
        from groundplan._cli.arguments import nearest

        near = nearest(name, FORMATS)
        hint = f"did you mean {near}?" if near else "groundplan export --list"
        raise ParameterError("export.format", f"there is no format {name!r}", hint)
    return FORMATS[name]


def format_of(file: str) -> Format:
    """The format whose suffix a file's name ends in; of several the longest.

    Raises
    ------
    ParameterError
        ``export.format``.
    """
    fitting = [form for form in FORMATS.values() if file.lower().endswith(form.suffix)]
    if not fitting:
        endings = ", ".join(form.suffix for form in FORMATS.values())
        raise ParameterError("export.format", f"the name {file!r} tells no format", f"name one, or end it in {endings}")
    return max(fitting, key=lambda form: len(form.suffix))
