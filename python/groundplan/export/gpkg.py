"""A GeoPackage (OGC 12-128r19): one file with every layer, in an undefined Cartesian frame of metres.

A robot's map lies nowhere on Earth, and the specification has a frame for that: ``srs_id`` -1, "Undefined Cartesian".
QGIS shows it in metres with its scale and its measuring tools.
"""

from __future__ import annotations

import warnings
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

from groundplan._files import whole
from groundplan.export._dates import moment
from groundplan.export._features import Layer, layers

if TYPE_CHECKING:
    from groundplan.survey import Survey


def write(survey: Survey, path: Path, date: str | datetime | None = None, **roads: Any) -> list[Path]:
    """Write all layers; `date` is when the file says it was changed last, `roads` are options of `road_map`."""
    import pyogrio

    found = layers(survey, **roads)
    said = moment(date).strftime("%Y-%m-%dT%H:%M:%SZ")
    # A file that is renamed into place when it is whole need not be so after each layer.
    own = {"OGR_CURRENT_DATE": said, "OGR_SQLITE_SYNCHRONOUS": "OFF"}
    before = {name: pyogrio.get_gdal_config_option(name) for name in own}
    try:
        pyogrio.set_gdal_config_options(own)
        with whole(path) as beside:
            beside.unlink()  # GDAL adds layers to a file that is there, and an empty one is none
            for layer in found:
                _write(layer, beside)
    finally:
        pyogrio.set_gdal_config_options(before)
    return [path]


def _write(layer: Layer, path: Path) -> None:
    from pyogrio.raw import write as write_layer

    with warnings.catch_warnings():
        # It warns of a frame that is none of EPSG's, and that is what is meant.
        warnings.filterwarnings("ignore", message="'crs' was not provided")
        write_layer(
            path,
            geometry=shapely.to_wkb(np.array(layer.shapes, dtype=object)),
            field_data=[_column(values) for values in layer.columns.values()],
            fields=np.array(list(layer.columns)),
            geometry_type=layer.geometry,
            crs=None,
            layer=layer.name,
            driver="GPKG",
            append=path.exists(),
            # Nothing newer is used, and older readers know it without a warning.
            dataset_options=None if path.exists() else {"VERSION": "1.2"},
            layer_options={"SRID": "-1", "FID": "fid"},
        )


def _column(values: list[Any]) -> Any:
    if isinstance(values[0], str):
        return np.array(values, dtype=object)
    return np.array(values)
