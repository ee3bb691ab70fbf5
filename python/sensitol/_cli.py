"""The command `sensitol`."""

from __future__ import annotations

import os
import signal
import sys


def main() -> None:
    """Runs the command line in this process, and ends it."""
    from . import _core

    # Python would turn Ctrl-C into an exception that nobody sees: the engine listens to it. A closed pipe is not an error.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    code = _core.run_cli(["sensitol", *sys.argv[1:]])
    sys.stdout.flush()
    # The clean-up of Python is skipped: nothing needs it.
    os._exit(code)


if __name__ == "__main__":
    main()
