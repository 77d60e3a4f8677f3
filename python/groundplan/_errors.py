"""What can go wrong, and how it is said.

    GroundplanError
    ├── MapError          a map that cannot be read
    ├── ParameterError    an unknown parameter, or a value out of its range
    └── FormatError       a survey, truth or settings file that is not one, or that cannot be written

Only the door can fail: reading a map and setting a parameter. After the door every stage gives a valid result,
at worst one face, and warnings.
"""

from __future__ import annotations


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
        self.hint = hint


class MapError(GroundplanError):
    """A map that cannot be read; the message names the file and the value."""


class ParameterError(GroundplanError, ValueError):
    """An unknown parameter or a value out of its range; the message names both."""


class FormatError(GroundplanError):
    """A file of ours that is not what it says, or that cannot be written."""
