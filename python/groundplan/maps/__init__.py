"""Maps from files and arrays: `read` a map_server YAML or an image, or take a NumPy array as it lies."""

from __future__ import annotations

from groundplan.maps._map import FREE, OCCUPIED, UNKNOWN, Map, MapWarning
from groundplan.maps._read import from_array, read

__all__ = ["FREE", "OCCUPIED", "UNKNOWN", "Map", "MapWarning", "from_array", "read"]
