"""Names made fit for a format: people name places as they like."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable


def one_line(text: str) -> str:
    """The text without control characters, line breaks and halves of letters, which no format of ours can hold."""
    kept = (" " if unicodedata.category(c) in ("Cc", "Cs", "Zl", "Zp", "Cn") else c for c in text)
    return " ".join("".join(kept).split())


def slug(text: str) -> str:
    """Letters, digits and dashes of ASCII that recall the text; empty where nothing of it can be said so."""
    plain = unicodedata.normalize("NFKD", text.replace("ß", "ss")).encode("ascii", "ignore").decode()
    return re.sub(r"[^A-Za-z0-9_]+", "-", plain).strip("-")


def unique(names: Iterable[str]) -> list[str]:
    """The names, the second and later of the same name with a number behind them: ``A01``, ``A01-2``."""
    listed = list(names)
    taken, given = set(listed), set[str]()
    for place, name in enumerate(listed):
        number, fresh = 2, name
        while fresh in given or (fresh != name and fresh in taken):
            fresh, number = f"{name}-{number}", number + 1
        given.add(fresh)
        listed[place] = fresh
    return listed
