"""What both of Open-RMF's files want: names that are told once, rounded metres, YAML that people can read."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import yaml

from groundplan._files import write_text

LEVEL = "L1"


def metres(value: float) -> float:
    """A coordinate to a tenth of a millimetre, never -0."""
    return round(float(value), 4) + 0.0


class _Plain(yaml.SafeDumper):
    """Writes what occurs twice twice: not every reader of YAML knows aliases."""

    def ignore_aliases(self, data: Any) -> bool:
        return True


def save(path: Path, tree: dict[str, Any]) -> None:
    """Write YAML with one line for each vertex and lane."""
    text = yaml.dump(tree, Dumper=_Plain, default_flow_style=None, allow_unicode=True, sort_keys=False, width=4096)
    write_text(path, text)
