"""The YAML of ROS map_server: what it says about an image, checked field by field.

Source: ros-navigation/navigation2 ``nav2_map_server/src/map_io.cpp``. Nav2 refuses a YAML without thresholds or
`negate`; here what map_saver writes is taken for them, with a warning.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from difflib import get_close_matches
from pathlib import Path
from typing import cast

from groundplan._errors import MapError, shown
from groundplan.maps._dialects import FREE_THRESH, MODES, OCCUPIED_THRESH, Mode
from groundplan.maps._map import MapWarning
from groundplan.maps._open import open_file
from groundplan.maps._source import Described, Origin

#: A YAML of a map has a few hundred bytes; what is larger is something else.
LARGEST_YAML = 1 << 20

#: What the names of pictures end in.
PICTURES = (".pgm", ".png", ".bmp", ".tif", ".tiff", ".jpg", ".jpeg", ".pbm", ".ppm")

#: The keys that map_server reads.
KEYS = ("image", "resolution", "origin", "negate", "mode", "occupied_thresh", "free_thresh")

#: Metres a pixel, and metres from the frame's origin, beyond which a value is a slip and floats lose the centimetre.
SMALLEST_RESOLUTION, LARGEST_RESOLUTION, FARTHEST_ORIGIN = 1e-6, 1e4, 1e9

#: What helps where a file does not say it: the flag, and the keyword of `groundplan.read`.
SETS_RESOLUTION = "--resolution sets it, such as --resolution 0.05; in Python resolution=0.05"
SETS_ORIGIN = "--origin sets it, such as --origin 0 0 0; in Python origin=(0, 0, 0)"


def read_yaml(path: Path) -> Described:
    """Read a map_server YAML.

    Raises
    ------
    MapError
        ``map.missing``, ``map.directory``, ``map.unreadable``, ``map.empty``, ``map.yaml``, ``map.image``,
        ``map.resolution``, ``map.origin``, ``map.negate``, ``map.mode``, ``map.thresholds``.
    """
    fields = _mapping(path)
    image, beside = _image(path, fields)
    warnings = list(beside)
    origin = None
    if "origin" in fields:
        origin, odd = check_origin(fields["origin"], str(path), exactly=3)
        warnings += odd
    negate = check_negate(path, fields["negate"]) if "negate" in fields else None
    mode = check_mode(fields["mode"], str(path)) if "mode" in fields else None
    occupied, free = (
        check_threshold(fields[name], name, str(path)) if name in fields else None
        for name in ("occupied_thresh", "free_thresh")
    )
    assumed = {"negate": "0", "occupied_thresh": str(OCCUPIED_THRESH), "free_thresh": str(FREE_THRESH)}
    missing = [name for name in assumed if name not in fields]
    misspelled = _misspelled(fields)
    if missing:
        named = ", ".join(f"{name} (but {misspelled[name]})" if name in misspelled else name for name in missing)
        said = ", ".join(f"{name} {assumed[name]}" for name in missing)
        warnings.append(MapWarning("fields-missing", f"{path.name} does not state {named}: assumed {said}"))
    resolution = check_resolution(fields["resolution"], str(path)) if "resolution" in fields else None
    return Described(image, resolution, origin, negate, mode, occupied, free, tuple(warnings), misspelled=misspelled)


def check_resolution(value: object, where: str = "") -> float:
    """Metres a pixel, or ``map.resolution``. `where` is the file or topic that says it; none where the caller does."""
    metres = number(value)
    if metres is None or not SMALLEST_RESOLUTION <= metres <= LARGEST_RESOLUTION:
        raise MapError(
            "map.resolution",
            f"{_in(where)}resolution {shown(value)} is not a number of metres a pixel between "
            f"{SMALLEST_RESOLUTION:g} and {LARGEST_RESOLUTION:g}",
            SETS_RESOLUTION if where else None,
        )
    return metres


def check_origin(value: object, where: str = "", *, exactly: int | None = None) -> tuple[Origin, list[MapWarning]]:
    """Pose of the lower left corner, or ``map.origin``; a yaw that is not a number is 0, with a warning.

    One of more than a turn is taken, with a warning too.
    """
    length = f"{exactly} numbers" if exactly else "2 or 3 numbers"
    parts = list(value) if isinstance(value, Sequence) and not isinstance(value, str | bytes) else None
    if hasattr(value, "tolist"):
        parts = cast("list[object]", value.tolist())
    if not isinstance(parts, list) or len(parts) not in ((exactly,) if exactly else (2, 3)):
        raise MapError("map.origin", f"{_in(where)}origin {shown(value)} is not {length}: x, y, yaw")
    x, y, yaw = (number(part) for part in [*parts, 0.0][:3])
    if x is None or y is None or not (abs(x) <= FARTHEST_ORIGIN and abs(y) <= FARTHEST_ORIGIN):
        raise MapError(
            "map.origin",
            f"{_in(where)}origin {shown(value)} is not a place: x and y are metres within {FARTHEST_ORIGIN:g} of 0",
        )
    if yaw is None or abs(yaw) > FARTHEST_ORIGIN:
        said = f"{_in(where)}origin has the yaw {shown(parts[-1])}, which is no angle in radians"
        raise MapError("map.origin", said)
    if math.isnan(yaw):
        said = f"the yaw of the origin{f' in {Path(where).name}' if where else ''} is nan: read as 0"
        return (x, y, 0.0), [MapWarning("yaw-nan", said)]
    if abs(yaw) > 2 * math.pi:
        said = f"the yaw of the origin{f' in {Path(where).name}' if where else ''} is {yaw:g} rad, more than a turn"
        return (x, y, yaw), [MapWarning("yaw-degrees", f"{said}: if these are degrees, it is {math.radians(yaw):.6g}")]
    return (x, y, yaw), []


def _in(where: str) -> str:
    """How a sentence about a file's or topic's value begins."""
    return f"{where}: " if where else ""


def check_threshold(value: object, name: str, where: str) -> float:
    """A share between 0 and 1, or ``map.thresholds``."""
    share = number(value)
    if share is None or not 0.0 <= share <= 1.0:
        raise MapError("map.thresholds", f"{where}: {name} {shown(value)} is not a number between 0 and 1")
    return share


def check_mode(value: object, where: str) -> Mode:
    """One of the three modes, or ``map.mode``."""
    mode = str(value).lower()
    for known in MODES:
        if mode == known:
            return known
    raise MapError("map.mode", f"{where}: mode {shown(value)} is none of {', '.join(MODES)}")


def number(value: object) -> float | None:
    """A finite, infinite or nan float from what YAML or a caller gives; None if it is no number.

    YAML 1.1 takes 5e-2 and -nan for text; they are the numbers that C++ writes.
    """
    if isinstance(value, bool) or value is None:
        return None
    try:
        return float(str(value).strip().lower().replace(".nan", "nan").replace(".inf", "inf"))
    except ValueError:
        return None


def _mapping(path: Path) -> dict[str, object]:
    """The YAML's keys and values."""
    import yaml

    with open_file(path) as file:
        data = file.read(LARGEST_YAML + 1)
    if not data.strip():
        raise MapError("map.empty", f"{path} is empty")
    if len(data) > LARGEST_YAML:
        raise MapError("map.yaml", f"{path} is not a map_server YAML: it has more than {LARGEST_YAML} bytes")
    try:
        fields = yaml.safe_load(data.decode("utf-8-sig"))
    except UnicodeDecodeError as fault:
        raise MapError(
            "map.yaml", f"{path} is not UTF-8 text: byte {data[fault.start]:#04x} at {fault.start}"
        ) from fault
    except (yaml.YAMLError, ValueError, RecursionError) as fault:
        # ValueError: a date or a number that YAML recognises but cannot be.
        mark = getattr(fault, "problem_mark", None)
        line = f", line {mark.line + 1}" if mark is not None else ""
        problem = getattr(fault, "problem", None) or "it cannot be parsed"
        raise MapError("map.yaml", f"{path} is not YAML{line}: {problem}") from fault
    if not isinstance(fields, dict):
        raise MapError("map.yaml", f"{path} is not a map_server YAML: it holds no keys such as image and resolution")
    return {str(key): value for key, value in fields.items()}


def _misspelled(fields: dict[str, object]) -> dict[str, str]:
    """Of the keys that are not there, those that others may have been meant to be: each with what is there."""
    others = [key for key in fields if key not in KEYS]
    near = {key: get_close_matches(key, others, 1) for key in KEYS if key not in fields}
    return {key: like[0] for key, like in near.items() if like}


def meant(key: str, misspelled: Mapping[str, str]) -> str | None:
    """The hint where a key is not there but one that is like it."""
    return f"it has {misspelled[key]}: did you mean {key}?" if key in misspelled else None


def _image(path: Path, fields: dict[str, object]) -> tuple[Path, list[MapWarning]]:
    """The image's path. One that was absolute on another computer is looked for beside the YAML."""
    name = fields.get("image")
    if not isinstance(name, str) or not name or "\0" in name:
        said = f"image {shown(name)} is no file name" if "image" in fields else "it names no image"
        hint = meant("image", _misspelled(fields))
        raise MapError("map.image", f"{path} is not a map_server YAML: {said}", hint)
    image = path.parent / name
    beside = path.parent / name.replace("\\", "/").rsplit("/", 1)[-1]
    try:
        if image.is_dir():
            said = f"{path} names the image {name}, which is a directory"
            raise MapError("map.directory", said, "image: is followed by the name of a picture")
        if image.exists():
            return image, []
        if beside.is_file():
            said = f"{path.name} names the image {name}, which does not exist; read the {beside.name} beside it"
            return beside, [MapWarning("image-beside", said)]
    except OSError:
        return image, []  # no permission, or a name too long: opening it says so
    said = f"{path} names the image {name}, which does not exist"
    near = _near(path, image.parent, beside.stem)
    hint = f"copy {beside.name} into {path.parent.absolute()}, beside {path.name}, or correct image: in it"
    raise MapError("map.missing", said, f"did you mean image: {near} in {path.name}?" if near else hint)


def _near(path: Path, place: Path, stem: str) -> str | None:
    """The picture that an image which is not there may have been meant to be: by its name, or by the YAML's."""
    for folder in dict.fromkeys((place, path.parent)):
        try:
            names = sorted(entry.name for entry in folder.iterdir() if entry.suffix.lower() in PICTURES)
        except OSError:
            continue
        stems = {Path(name).stem: name for name in names}
        for wanted in (stem, path.stem):
            if like := get_close_matches(wanted, stems, 1):
                near = folder / stems[like[0]]
                return (near.relative_to(path.parent) if near.is_relative_to(path.parent) else near).as_posix()
    return None


def check_negate(path: Path, value: object) -> bool:
    """Whether white is occupied, or ``map.negate``. Nav2 takes an int or a bool."""
    if isinstance(value, bool):
        return value
    if isinstance(value, str) and value.lower() in ("true", "false", "yes", "no", "on", "off"):
        return value.lower() in ("true", "yes", "on")
    whole = number(value)
    if whole not in (0.0, 1.0):
        raise MapError("map.negate", f"{path}: negate {shown(value)} is neither 0 nor 1")
    return whole == 1.0
