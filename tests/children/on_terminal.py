"""Runs a command on a terminal of its own and copies what it shows to stdout: `on_terminal.py COMMAND ARGUMENT ..`.

The exit code is that of the command. The terminal is 100 columns wide and never types anything.
"""

import fcntl
import os
import pty
import struct
import sys
import termios

pid, terminal = pty.fork()
if pid == 0:
    os.execv(sys.argv[1], sys.argv[1:])
fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", 40, 100, 0, 0))
shown = sys.stdout.buffer
while True:
    # The other side is closed: Linux says so by an error.
    try:
        more = os.read(terminal, 65536)
    except OSError:
        break
    if not more:
        break
    shown.write(more)
_, status = os.waitpid(pid, 0)
shown.flush()
sys.exit(os.waitstatus_to_exitcode(status))
