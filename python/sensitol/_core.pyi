import os
from typing import Any, Callable, final

__all__ = ["Law", "Outcome", "Study", "__version__", "run_cli", "run_confined", "warnings_page"]

__version__: str

def run_cli(arguments: list[str]) -> int: ...
def run_confined(
    task: str,
    folder: str | os.PathLike[str],
    root: str | os.PathLike[str],
    starts_programs: bool,
    study_alone: bool,
    seconds: float | None,
) -> str: ...
def warnings_page() -> str: ...

@final
class Law:
    @staticmethod
    def pearson(mean: float, sigma: float, skewness: float, kurtosis: float) -> Law: ...
    def values(self, what: str, at: bytes) -> bytes: ...

@final
class Outcome:
    @property
    def study(self) -> str | None: ...
    @property
    def not_written(self) -> str | None: ...
    def json(self) -> str: ...
    def text(self, width: int = 80, full: bool = False) -> str: ...
    def html(self) -> str: ...
    def svg(self, title: str) -> str: ...
    def tables(self) -> list[tuple[str, str]]: ...

@final
class Study:
    @staticmethod
    def from_text(
        text: str,
        toml: bool,
        name: str,
        folder: str | os.PathLike[str],
        files: dict[str, bytes],
        made_in_python: bool,
        hosted: bool | None,
        configuration: str | None,
    ) -> Study: ...
    @staticmethod
    def read(path: str | os.PathLike[str], hosted: bool | None, configuration: str | None) -> Study: ...
    @property
    def described(self) -> str: ...
    @property
    def text(self) -> str: ...
    def as_json(self) -> str: ...
    def law(self, dimension: str) -> Law | None: ...
    def run(
        self,
        asked: str,
        analysis: str,
        characteristics: list[str],
        make_model: Callable[[str], Callable[[bytes, int, list[int]], tuple[bytes, list[tuple[int, str]], int]]] | None,
        progress: Callable[[int, int], Any] | None,
        threads: int,
        seconds: float | None,
        journal: str | os.PathLike[str] | None,
        partial: bool,
        whole: bool,
    ) -> Outcome: ...
