"""Answers of a function, kept in a file."""

from __future__ import annotations

import hashlib
import inspect
import os
import sqlite3
from typing import Any, Union

from ._evaluate import Hello
from ._model import Model

#: The table, and the version of its shape.
TABLE = "python_answers_1"


def identity(model: Model, hello: Hello) -> str:
    """The key of the answers: the function's text, its inputs and its constants. Functions that it calls are not in it;
    `version` is."""
    try:
        text = inspect.getsource(model.function)
    except (OSError, TypeError):
        code = getattr(model.function, "__code__", None)
        text = repr((code.co_code, code.co_consts, code.co_names)) if code is not None else repr(model.function)
    parts = (model.name, text, model.version, model.vectorized, hello.inputs, sorted(hello.constants.items()))
    return hashlib.sha256(repr(parts).encode()).hexdigest()


class Cached:
    """An evaluator whose answers are kept, each as it comes. Failed points are not: they are tried again."""

    def __init__(self, inner: Any, model: Model, hello: Hello, path: Union[str, "os.PathLike[str]"]) -> None:
        self.inner = inner
        self.outputs = hello.outputs
        self.identity = identity(model, hello)
        self.store = sqlite3.connect(path, timeout=30)
        try:
            tables = {name for (name,) in self.store.execute("SELECT name FROM sqlite_master WHERE type = 'table'")}
            if tables and TABLE not in tables:
                raise ValueError(f"{os.fspath(path)!r} keeps something else than the answers of functions: name another file")
            self.store.execute("PRAGMA journal_mode = WAL")
            self.store.execute(
                f"CREATE TABLE IF NOT EXISTS {TABLE} (model TEXT, output TEXT, point BLOB, value REAL, "
                f"PRIMARY KEY (model, output, point)) WITHOUT ROWID"
            )
            self.store.commit()
        except sqlite3.DatabaseError as error:
            self.store.close()
            raise ValueError(f"{os.fspath(path)!r} cannot keep answers: {error}") from error
        except BaseException:
            self.store.close()
            raise

    def close(self) -> None:
        self.store.close()

    def known(self, point: bytes, outputs: list[int]) -> list[float] | None:
        found = []
        for output in outputs:
            row = self.store.execute(
                f"SELECT value FROM {TABLE} WHERE model = ? AND output = ? AND point = ?",
                (self.identity, self.outputs[output], point),
            ).fetchone()
            if row is None:
                return None
            found.append(row[0])
        return found

    def __call__(self, points: bytes, rows: int, outputs: list[int]) -> tuple[bytes, list[tuple[int, str]], int]:
        import numpy

        columns = numpy.frombuffer(points).reshape(-1, rows)
        keys = [columns[:, row].tobytes() for row in range(rows)]
        values = numpy.full((len(outputs), rows), numpy.nan)
        failed: list[tuple[int, str]] = []
        missing = []
        for row, key in enumerate(keys):
            found = self.known(key, outputs)
            if found is None:
                missing.append(row)
            else:
                values[:, row] = found
        # A few points at a time, so that a run that is interrupted has kept what it paid for.
        step = max(1, len(missing) // 16) if getattr(self.inner, "executor", None) is None else len(missing)
        for start in range(0, len(missing), max(step, 1)):
            some = missing[start : start + step]
            block = numpy.ascontiguousarray(columns[:, some]).tobytes()
            answers, lost, _ = self.inner(block, len(some), outputs)
            got = numpy.frombuffer(answers).reshape(len(outputs), len(some))
            values[:, some] = got
            failed += [(some[row], why) for row, why in lost]
            finite: Any = numpy.isfinite(got).all(axis=0)
            self.store.executemany(
                f"INSERT OR REPLACE INTO {TABLE} VALUES (?, ?, ?, ?)",
                [
                    (self.identity, self.outputs[output], keys[row], float(got[column, place]))
                    for place, row in enumerate(some)
                    if finite[place]
                    for column, output in enumerate(outputs)
                ],
            )
            self.store.commit()
        return values.tobytes(), sorted(failed), rows - len(missing)
