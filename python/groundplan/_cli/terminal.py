"""Standard output for data, standard error for talk, and waiting in between."""

from __future__ import annotations

import contextlib
import errno
import os
import shutil
import signal
import sys
import textwrap
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar

from groundplan._errors import FormatError

T = TypeVar("T")

#: Work that takes no longer than this is done before one has read that it goes on.
_PATIENCE_S = 0.8

_unfinished: threading.Thread | None = None
_hears = threading.Event()


def put(text: str) -> None:
    """Write data to standard output, in UTF-8 whatever the locale.

    Raises
    ------
    BrokenPipeError
        Nobody reads it any more.
    FormatError
        ``file.write`` when it cannot be written, such as to a full disk.
    """
    stream = sys.stdout
    try:
        if stream is None:
            raise OSError(errno.EBADF, "it is closed")
        stream.buffer.write(text.encode("utf-8", "replace"))
        stream.flush()
    except OSError as fault:
        _abandon_output()
        if isinstance(fault, BrokenPipeError):
            raise
        raise FormatError("file.write", f"cannot write to standard output: {fault.strerror or fault}") from fault


def _abandon_output() -> None:
    """Send what is left in the buffer nowhere, so that the interpreter does not try again as it ends."""
    with contextlib.suppress(OSError, ValueError, AttributeError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())
        os.close(nowhere)


def say(kind: str, sentence: str | None) -> None:
    """Say something on standard error: ``kind: sentence``. Nothing is said where nobody listens."""
    if sentence is None or sys.stderr is None:
        return
    text = f"{kind}: {sentence}"
    if sys.stderr.isatty():
        text = textwrap.fill(text, width() - 1, subsequent_indent="  ", break_long_words=False, break_on_hyphens=False)
    with contextlib.suppress(OSError):
        encoding = sys.stderr.encoding or "utf-8"
        sys.stderr.write(text.encode(encoding, "backslashreplace").decode(encoding) + "\n")
        sys.stderr.flush()


def width() -> int:
    """Columns of the terminal; 80 where there is none."""
    return max(40, shutil.get_terminal_size((80, 24)).columns)


def has_room(columns: int) -> bool:
    """Whether lines of so many columns can be read where they go; a file has room for any."""
    return sys.stdout is None or not sys.stdout.isatty() or columns <= width()


class Status:
    """One line on the terminal that tells how far the work is; none where standard error is no terminal."""

    def __init__(self, quiet: bool = False) -> None:
        self._shown = not quiet and sys.stderr is not None and sys.stderr.isatty()
        self._since = time.monotonic()
        self._text = ""

    def __call__(self, text: str) -> None:
        """Show `text` in place of what stood there, unless the work has only begun."""
        if self._shown and time.monotonic() - self._since > _PATIENCE_S:
            text = text[: width() - 1]
            if text != self._text:
                self._write(f"\r{text:<{len(self._text)}}")
                self._text = text

    def clear(self) -> None:
        """Take the line away."""
        if self._text:
            self._write(f"\r{'':<{len(self._text)}}\r")
            self._text = ""

    def _write(self, text: str) -> None:
        with contextlib.suppress(OSError, UnicodeError):
            sys.stderr.write(text)
            sys.stderr.flush()


@contextlib.contextmanager
def status(quiet: bool = False) -> Iterator[Status]:
    """A status line that is gone afterwards, whatever happens."""
    line = Status(quiet)
    try:
        yield line
    finally:
        line.clear()


def working(line: Status, sentence: str, task: Callable[[], T]) -> T:
    """Do `task`, which may stay in the core for long, so that Ctrl-C is heard and the time is shown meanwhile.

    The core hears no signals; so it runs in a thread of its own, and the one that hears them waits.
    """
    global _unfinished
    results: list[T] = []
    faults: list[BaseException] = []

    def work() -> None:
        try:
            results.append(task())
        except BaseException as fault:
            faults.append(fault)

    thread = threading.Thread(target=work, daemon=True)
    since = time.monotonic()
    _unfinished = thread
    thread.start()
    while thread.is_alive():
        thread.join(0.25)
        line(f"{sentence}, {int(time.monotonic() - since)} s")
    _unfinished = None
    if faults:
        raise faults[0]
    return results[0]


def hear_one_interrupt() -> None:
    """Raise KeyboardInterrupt at the first Ctrl-C only: one more would break the clearing up after it."""

    def interrupt(*_: object) -> None:
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        raise KeyboardInterrupt

    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:  # else the caller wants it otherwise
        signal.signal(signal.SIGINT, interrupt)
        _hears.set()


def interrupted() -> bool:
    """Whether Ctrl-C was heard, whatever became of the exception."""
    return _hears.is_set() and signal.getsignal(signal.SIGINT) is signal.SIG_IGN


def leave_unfinished(code: int) -> None:
    """End the process at once if the core is still at work: it cannot be told to stop."""
    if _unfinished is not None and _unfinished.is_alive():
        with contextlib.suppress(OSError):
            sys.stdout.flush()
        os._exit(code)


def columns(rows: Sequence[Sequence[str]], align: str = "") -> list[str]:
    """Lines of a table, two spaces between columns.

    Parameters
    ----------
    rows
        Cells.
    align
        ``<`` or ``>`` for each column; those not named are ``<``.
    """
    count = max(map(len, rows), default=0)
    sides = align.ljust(count, "<")
    widths = [max((len(row[k]) for row in rows if k < len(row)), default=0) for k in range(count)]
    return ["  ".join(f"{cell:{sides[k]}{widths[k]}}" for k, cell in enumerate(row)).rstrip() for row in rows]
