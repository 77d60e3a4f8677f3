"""Writing files whole or not at all."""

from __future__ import annotations

import contextlib
import errno
import os
import tempfile
from collections.abc import Iterator
from difflib import get_close_matches
from pathlib import Path

from groundplan._errors import FormatError


@contextlib.contextmanager
def whole(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Give a path beside `path` to write to; on success it is renamed to `path`, else it is removed.

    Raises
    ------
    FormatError
        ``file.write`` when the place cannot be written: no permission, disk full, a directory in the way.
    """
    target = Path(path)
    try:
        above = next((place for place in target.parents if place.exists()), None)
        if above is not None and not above.is_dir():
            raise NotADirectoryError(errno.ENOTDIR, f"{above} is a file and no directory")
        target.parent.mkdir(parents=True, exist_ok=True)
        if target.is_dir():  # told before the work, not after it
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
        handle, name = tempfile.mkstemp(prefix=f".{target.stem}.", suffix=target.suffix, dir=target.parent)
        os.close(handle)
    except OSError as fault:
        raise unwritable(target, fault) from fault
    beside = Path(name)
    try:
        yield beside
        umask = os.umask(0)
        os.umask(umask)
        beside.chmod(0o666 & ~umask)
        os.replace(beside, target)
    except OSError as fault:
        raise unwritable(target, fault) from fault
    finally:
        beside.unlink(missing_ok=True)


def write_text(path: str | os.PathLike[str], text: str) -> None:
    """Write UTF-8 text whole or not at all."""
    with whole(path) as beside:
        beside.write_text(text, encoding="utf-8")


def write_bytes(path: str | os.PathLike[str], data: bytes) -> None:
    """Write bytes whole or not at all."""
    with whole(path) as beside:
        beside.write_bytes(data)


def unwritable(path: Path, fault: OSError) -> FormatError:
    """The one text for a place that cannot be written."""
    return FormatError("file.write", f"cannot write {path}: {fault.strerror or fault}", "choose another place for it")


def unreadable(code: str, path: str | os.PathLike[str], fault: OSError) -> FormatError:
    """The one text for a file of ours that cannot be read."""
    if isinstance(fault, FileNotFoundError):
        return FormatError(code, absent(path), nearest(path))
    return FormatError(code, f"cannot read {os.fspath(path)}: {fault.strerror or fault}")


def absent(path: str | os.PathLike[str]) -> str:
    """The one text for a file that is not there."""
    return f"{os.fspath(path)} does not exist"


def nearest(path: str | os.PathLike[str]) -> str:
    """What helps to find a file that is not there: the name beside it that is most like it, or where it was sought."""
    wanted = Path(path)
    try:
        beside = sorted(entry.name for entry in wanted.parent.iterdir())
    except OSError:
        return f"there is no directory {wanted.parent}"
    # An ending that many files have makes no two names alike.
    alike = [name for name in beside if get_close_matches(wanted.stem, [Path(name).stem])]
    like = get_close_matches(wanted.name, alike, 1)
    return f"did you mean {wanted.with_name(like[0])}?" if like else f"it was sought in {wanted.parent.absolute()}"
