"""The command `sensitol`."""

from __future__ import annotations

import os
import signal
import sys

#: File of the page of the workbench in this package; it is not part of every build.
_PAGE = "workbench.html"


def main() -> None:
    """Runs the command line in this process, and ends it."""
    if sys.argv[1:2] == ["mcp"]:
        from . import _mcp

        sys.exit(_mcp.main(sys.argv[2:]))
    from . import _core

    page = os.path.join(os.path.dirname(os.path.abspath(__file__)), _PAGE)
    if os.path.isfile(page):
        os.environ.setdefault("SENSITOL_WORKBENCH", page)
    # Python would turn Ctrl-C into an exception that nobody sees: the engine listens to it. A closed pipe is not an error.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    code = _core.run_cli(["sensitol", *sys.argv[1:]])
    sys.stdout.flush()
    # The clean-up of Python is skipped: nothing needs it.
    os._exit(code)


if __name__ == "__main__":
    main()
