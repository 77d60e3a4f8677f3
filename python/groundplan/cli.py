"""The command line: the commands, and what becomes of an error.

    exit code 0     done
              1     a bug
              2     wrong usage: an unknown flag or parameter, a value out of its range, an extra not installed
              3     a file that cannot be read, is not what it should be, or cannot be written
              4     there is no way (groundplan route)
              130   interrupted
              141   nobody reads the output any more

Standard output has what was asked for, standard error all talk. Each command is a module of `groundplan._cli`; what
it needs is imported when it runs, so that ``--help`` answers at once.
"""

from __future__ import annotations

import os
from collections.abc import Sequence

from groundplan._cli import terminal
from groundplan._cli.arguments import parser
from groundplan._errors import GroundplanError, ParameterError

DONE, BUG, USAGE, FILES, INTERRUPTED, UNREAD = 0, 1, 2, 3, 130, 141


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line and give its exit code.

    Parameters
    ----------
    argv
        What stands behind the program's name; by default what the process was started with.

    Raises
    ------
    SystemExit
        For ``--help`` and wrong flags, as argparse does.
    """
    if argv is None:
        terminal.hear_one_interrupt()
    try:
        arguments = parser().parse(argv)
        arguments.run(arguments)
        return DONE
    except KeyboardInterrupt:
        return _interrupted(argv)
    except BrokenPipeError:
        return UNREAD
    except GroundplanError as fault:
        terminal.say("error", str(fault))
        terminal.say("hint", fault.hint)
        usage = isinstance(fault, ParameterError) or fault.code == "extra.missing"
        return USAGE if usage else FILES
    except MemoryError:
        terminal.say("error", "this computer has not enough memory for that")
        return FILES
    except BaseException as fault:  # a panic of the core is no Exception
        if terminal.interrupted():
            return _interrupted(argv)
        if isinstance(fault, SystemExit) or os.environ.get("GROUNDPLAN_DEBUG"):
            raise
        said = " ".join(f"{type(fault).__name__}: {fault}".split())
        terminal.say("error", f"this is a bug in Groundplan: {said}")
        terminal.say("hint", "GROUNDPLAN_DEBUG=1 shows where; please report it with the command and the map")
        return BUG


def _interrupted(argv: Sequence[str] | None) -> int:
    terminal.say("error", "interrupted")
    if argv is None:
        terminal.leave_unfinished(INTERRUPTED)
    return INTERRUPTED
