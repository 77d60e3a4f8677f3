"""What the C library does with memory that is let go of."""

from __future__ import annotations

import ctypes
import sys

#: mallopt's names: from which size on a piece is memory of its own, and how many heaps there may be.
_MMAP_THRESHOLD, _ARENA_MAX = -3, -8
#: In bytes. With one heap four threads wait for one another: a survey takes twice as long, and a thirtieth less memory.
_OWN, _HEAPS = 1 << 16, 3


def give_back() -> None:
    """Have the GNU C library give memory back to the system as soon as it is let go of.

    By itself it takes the largest piece that it ever got back for the size up to which it keeps them, and it keeps them
    for each thread apart: a survey of a large map, which makes and drops most of its memory several times over, held
    0.4 GiB more. It stays so for the process. Other C libraries are left as they are.
    """
    if sys.platform != "linux":
        return
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    if mallopt is not None:
        mallopt(_MMAP_THRESHOLD, _OWN)
        mallopt(_ARENA_MAX, _HEAPS)
