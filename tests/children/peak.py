"""Runs a command without its output and prints its exit code and the most memory that it held, in kilobytes: `peak.py COMMAND ..`."""

import os
import subprocess
import sys

with subprocess.Popen(sys.argv[1:], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as child:
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
# Linux counts in kilobytes, macOS in bytes.
print(child.returncode, usage.ru_maxrss // (1024 if sys.platform == "darwin" else 1))
