"""Options of a run."""

from __future__ import annotations

import os
from typing import Any, Iterable, Union

from ._progress import Progress

__all__ = ["Names", "Path", "RunOptions", "names"]

Path = Union[str, "os.PathLike[str]"]
Names = Union[str, Iterable[str], None]


def names(names: Names) -> list[str]:
    """A name or several as a list."""
    if names is None:
        return []
    return [names] if isinstance(names, str) else [str(name) for name in names]


class RunOptions:
    """Options of a run that do not depend on what it computes."""

    def __init__(
        self,
        characteristics: Names,
        threads: int | None,
        time: float | None,
        executor: Any,
        chunksize: int | str,
        cache: Path | bool | None,
        progress: Progress,
        on_interrupt: str,
    ) -> None:
        if on_interrupt not in ("raise", "partial"):
            raise ValueError(f'on_interrupt must be "raise" or "partial", got {on_interrupt!r}')
        if threads is not None and (isinstance(threads, bool) or int(threads) < 1):
            raise ValueError(f"threads must be 1 or more, got {threads!r}")
        if time is not None and not float(time) > 0:
            raise ValueError(f"time must be positive, in seconds, got {time!r}")
        if chunksize != "auto" and (isinstance(chunksize, (str, bool)) or int(chunksize) < 1):
            raise ValueError(f'chunksize must be "auto" or 1 or more, got {chunksize!r}')
        if executor is not None and not hasattr(executor, "submit"):
            raise TypeError(f"an executor has a method submit, and {type(executor).__name__} has none")
        self.characteristics = names(characteristics)
        self.threads = 0 if threads is None else int(threads)
        self.time = None if time is None else float(time)
        self.executor = executor
        self.chunksize = chunksize
        self.cache = cache
        self.progress = progress
        self.partial = on_interrupt == "partial"
