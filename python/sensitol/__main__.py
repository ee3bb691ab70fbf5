"""``python -m sensitol``: the command."""

from ._cli import main

main()
