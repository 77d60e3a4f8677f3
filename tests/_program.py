"""Running the program in a test, and a small map to run it on."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

from groundplan.cli import main

YAML = """\
image: {image}
resolution: 0.05
origin: [-1.0, 2.0, {yaw}]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.196
"""


@dataclass(frozen=True)
class Ran:
    """What a run came to."""

    code: int
    out: str
    err: str


def call(capsys: pytest.CaptureFixture[str], *argv: str | Path) -> Ran:
    """Run the command line in this process."""
    capsys.readouterr()
    try:
        code = main([str(word) for word in argv])
    except SystemExit as leaving:
        assert leaving.code is None or isinstance(leaving.code, int)
        code = leaving.code or 0
    out, err = capsys.readouterr()
    return Ran(code, out, err)


def start(
    *argv: str | Path, cwd: Path | None = None, before: Callable[[], None] | None = None, **environment: str
) -> Ran:
    """Run the program in a process of its own; `before` is called in it first."""
    code = "import sys; from groundplan.cli import main; sys.exit(main())"
    done = subprocess.run(
        [sys.executable, "-c", code, *map(str, argv)],
        cwd=cwd,
        env={**os.environ, **environment},
        preexec_fn=before,
        capture_output=True,
        check=False,
        timeout=120,
    )
    return Ran(done.returncode, done.stdout.decode(), done.stderr.decode())


def hall() -> npt.NDArray[np.uint8]:
    """A hall of 12 m by 8 m with two blocks and an aisle between them, unknown outside."""
    pixels = np.full((200, 280), 205, np.uint8)
    pixels[20:180, 20:260] = 254
    for rows, columns in (
        (slice(20, 180), slice(20, 260)),
        (slice(60, 85), slice(70, 210)),
        (slice(115, 140), slice(70, 210)),
    ):
        block = pixels[rows, columns]
        block[:2], block[-2:], block[:, :2], block[:, -2:] = 0, 0, 0, 0
    return pixels


def write_pgm(path: Path, pixels: npt.NDArray[np.uint8], head: tuple[int, int] | None = None) -> Path:
    """Write a PGM; `head`: the width and height that it claims."""
    width, height = head or (pixels.shape[1], pixels.shape[0])
    path.write_bytes(b"P5\n%d %d\n255\n" % (width, height) + pixels.tobytes())
    return path


def write_map(directory: Path, name: str = "hall", yaw: str = "0.0") -> Path:
    """Write the hall as a map_server map; the path of its YAML."""
    write_pgm(directory / f"{name}.pgm", hall())
    yaml = directory / f"{name}.yaml"
    yaml.write_text(YAML.format(image=f"{name}.pgm", yaw=yaw))
    return yaml


def files(directory: Path) -> set[str]:
    """Names of all files below a directory, hidden ones too."""
    return {str(path.relative_to(directory)) for path in directory.rglob("*") if path.is_file()}
