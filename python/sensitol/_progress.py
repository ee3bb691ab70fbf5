"""How far a run is."""

from __future__ import annotations

import sys
from types import TracebackType
from typing import Any, Callable, Union

Progress = Union[bool, Callable[[int, int], Any], None]


class Shown:
    """Shows points answered and expected: by tqdm where that is installed, else in a line of stderr, or by a callable."""

    def __init__(self, progress: Progress) -> None:
        self.told: Callable[[int, int], Any] | None = None
        self.bar: Any = None
        self.line = False
        if progress is True:
            try:
                from tqdm.auto import tqdm  # type: ignore[import-untyped,unused-ignore]
            except ImportError:
                self.told = self.write
            else:
                self.bar = tqdm(unit=" points")
                self.told = self.update
        elif callable(progress):
            self.told = progress
        elif progress not in (False, None):
            raise TypeError(f"progress must be True or a callable of points and expected points, got {type(progress).__name__}")

    def update(self, points: int, expected: int) -> None:
        if expected:
            self.bar.total = max(expected, points)
        self.bar.n = points
        self.bar.refresh()

    def write(self, points: int, expected: int) -> None:
        of = f" of {max(expected, points)}" if expected else ""
        sys.stderr.write(f"\r{points}{of} points")
        sys.stderr.flush()
        self.line = True

    def __enter__(self) -> Shown:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        if self.bar is not None:
            self.bar.close()
        if self.line:
            sys.stderr.write("\n")
