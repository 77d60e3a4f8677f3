"""What the C library does with memory that is let go of."""

from __future__ import annotations

import ctypes
import sys

#: mallopt's name for the size from which on a piece is memory of its own, and that size in bytes.
_MMAP_THRESHOLD, _OWN = -3, 1 << 18


def give_back() -> None:
    """Have the GNU C library give large pieces back to the system as soon as they are let go of.

    By itself it takes the largest piece that it ever got back for the size up to which it keeps them: a survey of a
    large map, which makes and drops most of its memory several times over, held half a gigabyte more. Other C
    libraries are left as they are.
    """
    if sys.platform != "linux":
        return
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    if mallopt is not None:
        mallopt(_MMAP_THRESHOLD, _OWN)
