"""A DXF drawing as it is made: layers, blocks, and entities that carry ids. Coordinates come in metres."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from ezdxf import options, units  # type: ignore[attr-defined]
from ezdxf.document import Drawing as Document
from ezdxf.enums import MTextEntityAlignment, TextEntityAlignment
from ezdxf.filemanagement import new
from ezdxf.tools.standards import linetypes

from groundplan._shapes import readable
from groundplan.export._layers import Layer
from groundplan.export._text import one_line

#: Of a unit: how many make a metre, and its number in $INSUNITS.
UNITS = {"m": (1.0, units.M), "mm": (1000.0, units.MM)}
#: Radius of a symbol, metres.
SYMBOL_M = 0.15


class Drawing:
    """A drawing being made. Coordinates come in metres."""

    def __init__(self, units: str, table: dict[str, Layer]) -> None:
        self.scale, number = UNITS[units]
        self.table = table
        with _timeless():
            self.doc: Document = new("R2010", setup=False)
        self.doc.units = number
        self.doc.header["$MEASUREMENT"] = 1
        # A sheet of A3: LibreCAD takes the library's 420 by 297 for the drawing's unit.
        self.doc.active_layout().dxf.limmax = (0.420 * self.scale, 0.297 * self.scale)
        for name, description, pattern in linetypes():
            if name in {layer.linetype for layer in table.values()} - {"CONTINUOUS"} and name not in self.doc.linetypes:
                # The library's patterns are in drawing units of which 1 is a dash's length.
                lengths = [0.5 * self.scale * value for value in pattern]
                self.doc.linetypes.add(name, pattern=lengths, description=description)
        for layer in {layer.name: layer for layer in table.values()}.values():
            made = self.doc.layers.add(layer.name, color=layer.color, linetype=layer.linetype)
            if not layer.on:
                made.freeze()
        self.doc.appids.add("GROUNDPLAN")
        self.space = self.doc.modelspace()
        self.low, self.high = [math.inf] * 2, [-math.inf] * 2

    def block(self, name: str, attributes: Sequence[str]) -> None:
        """A ring with a cross, one unit in radius, and attributes that are not shown."""
        block = self.doc.blocks.new(name)
        block.add_circle((0, 0), 1)
        block.add_line((-1, 0), (1, 0))
        block.add_line((0, -1), (0, 1))
        for n, tag in enumerate(attributes):
            block.add_attdef(tag, (1.5, -1.2 * n), dxfattribs={"height": 1, "flags": 1, "prompt": tag.title()})

    def points(self, points: Sequence[Sequence[float]]) -> list[tuple[float, float]]:
        """Points in the drawing's units; the drawing's extent grows with them."""
        scaled = [(float(p[0]) * self.scale, float(p[1]) * self.scale) for p in points]
        for axis in (0, 1):
            self.low[axis] = min(self.low[axis], *(p[axis] for p in scaled))
            self.high[axis] = max(self.high[axis], *(p[axis] for p in scaled))
        return scaled

    def _mark(self, entity: Any, id: str) -> None:
        entity.set_xdata("GROUNDPLAN", [(1000, id[:255])])

    def line(self, what: str, a: Sequence[float], b: Sequence[float], id: str) -> None:
        """A line."""
        start, end = self.points([a, b])
        self._mark(self.space.add_line(start, end, dxfattribs=self.on(what)), id)

    def ring(self, what: str, points: Sequence[Sequence[float]], id: str) -> None:
        """A closed polyline."""
        self._mark(self.space.add_lwpolyline(self.points(points), close=True, dxfattribs=self.on(what)), id)

    def fill(self, what: str, rings: Sequence[Sequence[Sequence[float]]], id: str) -> None:
        """A solid hatch, rings within the first left out."""
        hatch = self.space.add_hatch(color=256, dxfattribs=self.on(what))
        for n, points in enumerate(rings):
            hatch.paths.add_polyline_path(self.points(points), is_closed=True, flags=1 if n == 0 else 16)
        self._mark(hatch, id)

    def symbol(self, what: str, block: str, at: Sequence[float], values: Mapping[str, str]) -> None:
        """A block with its attributes."""
        (place,) = self.points([at])
        size = SYMBOL_M * self.scale
        sized = {"xscale": size, "yscale": size, "zscale": size}
        insert = self.space.add_blockref(block, place, dxfattribs=self.on(what) | sized)
        for n, (tag, text) in enumerate(values.items()):
            held = self.on(what) | {"height": size, "flags": 1}
            attribute = insert.add_attrib(tag, _plain(text), dxfattribs=held)
            where = (place[0] + 1.5 * size, place[1] - 1.2 * n * size)
            attribute.set_placement(where, align=TextEntityAlignment.LEFT)
        self._mark(insert, values["ID"])

    def text(self, what: str, at: Sequence[float], text: str, height: float, angle: float = 0.0) -> None:
        """A name, centred, never upside down."""
        if not one_line(text):
            return
        turned = readable(math.degrees(angle))
        made = self.space.add_mtext(_mtext(text), dxfattribs=self.on(what) | {"char_height": height * self.scale})
        made.set_location(self.points([at])[0], round(turned, 6), MTextEntityAlignment.MIDDLE_CENTER)

    def on(self, what: str) -> dict[str, Any]:
        return {"layer": self.table[what].name}

    def save(self, path: Path) -> None:
        """Write the file, with its extent and a view of all of it."""
        if math.isfinite(self.low[0]):
            self.space.dxf.extmin, self.space.dxf.extmax = (*self.low, 0), (*self.high, 0)
            wide, high = (b - a for a, b in zip(self.low, self.high, strict=True))
            centre = (self.low[0] + wide / 2, self.low[1] + high / 2)
            self.doc.set_modelspace_vport(1.05 * max(high, wide / 1.6, 1e-3 * self.scale), centre)
        # The classes in use would be listed in the order of a set.
        for name in sorted(self.doc.entitydb.dxf_types_in_use()):
            self.doc.classes.add_class(name)
        with _timeless():
            self.doc.saveas(path)


def _plain(text: str) -> str:
    """A text without the codes that CAD programs see in doubled percent signs and in carets."""
    return one_line(text).replace("%%", "% %").replace("^", "^ ")


def _mtext(text: str) -> str:
    """A text as MTEXT takes it: what would be a code there is escaped."""
    escaped = one_line(text).replace("\\", "\\\\").replace("{", "\\{").replace("}", "\\}")
    return escaped.replace("%%", "% %").replace("^", "^ ")


@contextlib.contextmanager
def _timeless() -> Iterator[None]:
    """Within this ezdxf writes no date and no random id."""
    before = options.write_fixed_meta_data_for_testing
    options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        options.write_fixed_meta_data_for_testing = before
