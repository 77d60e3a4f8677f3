"""What can go wrong, and how it is said.

    GroundplanError
    ├── MapError          a map that cannot be read
    ├── ParameterError    an unknown parameter, or a value out of its range
    └── FormatError       a survey, truth or settings file that is not one, or that cannot be written

Only the door can fail: reading a map and setting a parameter. After the door every stage gives a valid result,
at worst one face, and warnings.
"""

from __future__ import annotations

_OF_A_YAML = "map_saver writes one: image, resolution, origin and thresholds, a line each"
_SAVE_AGAIN = "it was cut short or damaged on its way: copy it again, or save the map again"

#: What helps wherever a fault arises, by its code; who raises it may know better.
_HINTS = {
    "file.json": "it was cut short or damaged on its way: copy it again, or make it anew",
    "map.corrupt": _SAVE_AGAIN,
    "map.empty": _SAVE_AGAIN,
    "map.format": "groundplan survey --help names what can be read",
    "map.header": _SAVE_AGAIN,
    "map.image": _OF_A_YAML,
    "map.origin": "x and y of the lower left pixel's corner in metres and a yaw in radians, such as [-12.0, -8.5, 0.0]",
    "map.thresholds": "shares of black: free_thresh 0.196 and occupied_thresh 0.65 are usual",
    "map.truncated": _SAVE_AGAIN,
    "map.yaml": _OF_A_YAML,
    "point.finite": "numbers, in metres",
    "settings.toml": "a table for each stage, such as [lines] and below it snr = 3.0",
    "survey.content": "groundplan survey makes it anew",
    "survey.format": "groundplan survey MAP writes one",
    "survey.json": "groundplan survey makes it anew",
    "survey.version": "groundplan survey makes it anew",
}


def shown(value: object) -> str:
    """A value in a sentence, cut if it is long."""
    try:
        text = repr(value)
    except ValueError:  # an integer of thousands of digits
        return "of too many digits"
    return text if len(text) <= 60 else text[:57] + "..."


class GroundplanError(Exception):
    """Base of all errors of Groundplan.

    Attributes
    ----------
    code : str
        Stable name of the fault for programs, such as ``map.truncated``.
    hint : str or None
        What would help, as a sentence for people.
    """

    def __init__(self, code: str, message: str, hint: str | None = None) -> None:
        super().__init__(message)
        self.code = code
        self.hint = hint or _HINTS.get(code)

    def __reduce__(self) -> tuple[type[GroundplanError], tuple[str, str, str | None]]:
        # Raised in one process, it is told in another.
        return type(self), (self.code, str(self), self.hint)


class MapError(GroundplanError):
    """A map that cannot be read; the message names the file and the value."""


class ParameterError(GroundplanError, ValueError):
    """An unknown parameter or a value out of its range; the message names both."""


class FormatError(GroundplanError):
    """A file of ours that is not what it says, or that cannot be written."""
