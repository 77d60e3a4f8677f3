"""An SVG drawing to scale, a unit a metre: layers that editors know as such, and shapes with ids and titles."""

from __future__ import annotations

import base64
import io
import math
from collections.abc import Iterable, Sequence
from typing import Any
from xml.etree import ElementTree

import numpy as np
import numpy.typing as npt
from PIL import Image

from groundplan.export._text import one_line
from groundplan.figures._names import Names
from groundplan.figures._underlay import COLOURS, Underlay

Point = Sequence[float] | npt.NDArray[np.float64]
FONT = "DejaVu Sans, Verdana, Arial, sans-serif"
#: Millimetres to a point of type.
POINT_MM = 25.4 / 72


class Drawing:
    """A drawing being made. Places are metres of the map frame, y up; sizes of lines and type are millimetres on paper.

    A layer's coordinates are the map's own, and the layer turns them upside down; only text, which that would turn
    over, has its y negated instead.
    """

    def __init__(self, scale: float) -> None:
        #: Metres to a millimetre of paper.
        self.mm = scale / 1000
        self.root = ElementTree.Element(
            "svg",
            {
                "xmlns": "http://www.w3.org/2000/svg",
                "xmlns:inkscape": "http://www.inkscape.org/namespaces/inkscape",
                "version": "1.1",
            },
        )

    def page(self, box: tuple[float, float, float, float], title: str) -> None:
        """Set the paper's least x, greatest x, least y, greatest y."""
        x0, x1, y0, y1 = box
        wide, high = x1 - x0, y1 - y0
        self.root.attrib |= {
            "width": f"{wide / self.mm:.3f}mm",
            "height": f"{high / self.mm:.3f}mm",
            "viewBox": f"{_n(x0)} {_n(-y1)} {_n(wide)} {_n(high)}",
        }
        ElementTree.SubElement(self.root, "title").text = one_line(title)
        paper = {"id": "paper", "x": _n(x0), "y": _n(-y1), "width": _n(wide), "height": _n(high), "fill": "#ffffff"}
        ElementTree.SubElement(self.root, "rect", paper)

    def layer(
        self, id: str, name: str, style: dict[str, str] | None = None, *, upright: bool = False
    ) -> ElementTree.Element:
        """A layer; `upright` for text, whose y is given negated."""
        own = {"id": f"layer-{id}", "inkscape:groupmode": "layer", "inkscape:label": name}
        turn = {} if upright else {"transform": "scale(1 -1)"}
        return ElementTree.SubElement(self.root, "g", own | turn | _dashed(style or {}))

    def path(
        self, layer: ElementTree.Element, rings: Iterable[Iterable[Point]], id: str, title: str, **style: str
    ) -> None:
        """Closed rings, those within others holes."""
        parts = ("M" + " L".join(f"{_n(p[0])},{_n(p[1])}" for p in ring) + " Z" for ring in rings)
        self._titled(layer, "path", {"id": id, "d": " ".join(parts), "fill-rule": "evenodd"} | _dashed(style), title)

    def line(self, layer: ElementTree.Element, ends: Sequence[Point], id: str, title: str = "") -> None:
        """A line from end to end."""
        a, b = ends
        placed = {"x1": _n(a[0]), "y1": _n(a[1]), "x2": _n(b[0]), "y2": _n(b[1])}
        self._titled(layer, "line", {"id": id} | placed, title)

    def disc(self, layer: ElementTree.Element, at: Point, radius: float, id: str, title: str, **style: str) -> None:
        """A disc, its radius in metres."""
        round_ = {"id": id, "cx": _n(at[0]), "cy": _n(at[1]), "r": _n(radius)}
        self._titled(layer, "circle", round_ | _dashed(style), title)

    def text(
        self, layer: ElementTree.Element, at: Point, text: str, mm: float, angle: float = 0.0, **style: str
    ) -> None:
        """Text whose middle line is at a place, turned counter-clockwise by so many degrees."""
        x, y = _n(at[0]), _n(-at[1])
        turn = {"transform": f"rotate({_n(-angle)} {x} {y})"} if angle else {}
        size = {"font-size": _n(mm * self.mm), "font-family": FONT, "dy": "0.36em"}
        ElementTree.SubElement(layer, "text", {"x": x, "y": y} | size | turn | _dashed(style)).text = one_line(text)

    def picture(self, layer: ElementTree.Element, view: Underlay) -> None:
        """The map, in a layer that is upright."""
        data = io.BytesIO()
        picture = Image.fromarray(view.ranks, mode="L").convert("P")
        picture.putpalette(COLOURS.tobytes() + bytes(768 - COLOURS.size))
        picture.save(data, format="PNG", bits=2)
        rows, columns = view.ranks.shape
        pixel = view.block * view.resolution
        x, y, yaw = view.origin
        cos, sin = math.cos(yaw), math.sin(yaw)
        pose = " ".join(f"{value:.9f}" for value in (cos, -sin, sin, cos, x, -y))
        place = {
            "id": "map",
            "x": _n(view.corner[0]),
            "y": _n(-view.corner[1] - rows * pixel),
            "width": _n(columns * pixel),
            "height": _n(rows * pixel),
            "transform": f"matrix({pose})",
            "preserveAspectRatio": "none",
            "image-rendering": "optimizeSpeed",
            "xmlns:xlink": "http://www.w3.org/1999/xlink",
            "xlink:href": "data:image/png;base64," + base64.b64encode(data.getvalue()).decode(),
        }
        ElementTree.SubElement(layer, "image", place)

    def data(self) -> bytes:
        """The file."""
        ElementTree.indent(self.root, " ")
        made: bytes = ElementTree.tostring(self.root, encoding="utf-8", xml_declaration=True)
        return made + b"\n"

    def _titled(self, layer: ElementTree.Element, kind: str, attributes: dict[str, str], title: str) -> None:
        made = ElementTree.SubElement(layer, kind, attributes)
        if title:
            ElementTree.SubElement(made, "title").text = one_line(title)


def names_on(drawing: Drawing, layer: ElementTree.Element) -> Names:
    """Writes names on a layer of a drawing."""

    def put(at: Any, text: str, size: float, colour: str, zorder: float, angle: float) -> None:
        drawing.text(layer, at, text, size * POINT_MM, angle, fill=colour)

    return Names(1 / (drawing.mm * POINT_MM), put)


def _n(value: float) -> str:
    """A number to a tenth of a millimetre, without needless digits."""
    return f"{round(float(value), 4) + 0.0:.4f}".rstrip("0").rstrip(".")


def _dashed(style: dict[str, str]) -> dict[str, str]:
    return {name.replace("_", "-"): value for name, value in style.items()}
