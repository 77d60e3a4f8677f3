"""What a process that a bench starts holds in memory."""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path


def watched(words: list[str]) -> tuple[str, int]:
    """What a Python process says once it is ready, and the most memory that it holds beyond what it held then, bytes.

    The process, `words` behind the interpreter, writes a line when it is ready and begins when it reads one. On Linux.
    """
    command = [sys.executable, *words]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as child:
        assert child.stdin is not None and child.stdout is not None
        child.stdout.readline()
        before = most = _held(child.pid)
        child.stdin.write("\n")
        child.stdin.flush()
        while child.poll() is None:
            most = max(most, _held(child.pid))
            time.sleep(0.005)
        said = child.stdout.read()
    if child.returncode:
        raise SystemExit(f"{' '.join(words[2:])} failed: {child.returncode}")
    return said, most - before


def _held(pid: int) -> int:
    """Bytes that a process holds for itself: pages of mapped files are not in it."""
    for line in Path(f"/proc/{pid}/status").read_text().splitlines():
        if line.startswith("RssAnon:"):
            return int(line.split()[1]) * 1024
    return 0
