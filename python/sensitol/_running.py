"""What evaluates the points of one run: by an executor where there is one, with kept answers where they are wanted."""

from __future__ import annotations

import math
import pickle
import queue
import threading
import time
from typing import TYPE_CHECKING, Any, Sequence

from ._evaluate import Answer, Call, Hello, Scalar, Vectorized, fails_point, reason
from ._model import Model

if TYPE_CHECKING:
    from ._run_options import RunOptions

#: How long a task of an executor should take, in seconds: long beside the cost of sending it, which is 20 to 100 us.
TASK = 0.02
#: Most points of a task.
MOST = 4096
#: How long to wait before signals are looked for, in seconds.
TICK = 0.05


def evaluator(model: Model, hello: Hello, how: RunOptions) -> Any:
    """The evaluator of a run."""
    one: Any
    if how.executor is not None:
        one = Distributed(model, hello, how.executor, how.chunksize)
    else:
        one = Vectorized(model, hello) if model.vectorized else Scalar(model, hello)
    if how.cache is None or how.cache is False:
        return one
    if how.cache is True:
        raise ValueError("cache must be a file for the answers of a function, such as cache='gap.journal.sqlite'")
    from ._cache import Cached

    return Cached(one, model, hello, how.cache)


def task(call: Call, answer: Answer, points: Sequence[Sequence[float]], outputs: list[int]) -> tuple[list[Any], float]:
    """Evaluates some points, in the process of a worker: values or a reason for each, and the time that it took."""
    begun = time.perf_counter()
    model = call.model
    if model.vectorized:
        found = _block(call, answer, points, outputs)
    else:
        found = []
        for point in points:
            try:
                found.append(answer.numbers(call(point), outputs))
            except Exception as error:
                if not fails_point(model, error):
                    raise
                found.append(reason(error))
    return found, time.perf_counter() - begun


def _block(call: Call, answer: Answer, points: Sequence[Sequence[float]], outputs: list[int]) -> list[Any]:
    import numpy

    columns = numpy.array(points, dtype=float).T.copy()
    columns.flags.writeable = False
    vectorized: Any = object.__new__(Vectorized)
    vectorized.numpy, vectorized.model, vectorized.call, vectorized.answer = numpy, call.model, call, answer
    try:
        found = vectorized.block(columns, len(points), outputs)
        failed: list[tuple[int, str]] = []
    except Exception as error:
        if not fails_point(call.model, error):
            raise
        found, failed = vectorized.one_by_one(columns, len(points), outputs)
    why = dict(failed)
    return [why.get(row, found[:, row].tolist()) for row in range(len(points))]


class Distributed:
    """Sends points to an executor, and waits for its answers on the calling thread."""

    def __init__(self, model: Model, hello: Hello, executor: Any, chunksize: Any) -> None:
        self.model = model
        self.call = Call(model, hello)
        self.answer = Answer(model, hello.outputs)
        self.executor = executor
        self.chunksize = None if chunksize == "auto" else int(chunksize)
        # Dask takes a task of the same arguments for the same one.
        dask = type(executor).__module__.split(".")[0] == "distributed"
        self.options = {"pure": False} if dask else {}
        self.scalar = Scalar(model, hello)
        if type(executor).__module__ == "concurrent.futures.process":
            self.can_be_sent()

    def can_be_sent(self) -> None:
        try:
            pickle.dumps(self.call)
        except Exception as error:
            raise TypeError(
                f"{self.model.name}() cannot be sent to another process ({error}): define it in a module, or use an executor of "
                f"loky or Dask, which send functions by value"
            ) from error

    def size(self, rows: int) -> int:
        return self.chunksize if self.chunksize is not None else min(rows, MOST)

    def __call__(self, points: bytes, rows: int, outputs: list[int]) -> tuple[bytes, list[tuple[int, str]], int]:
        import array

        answers = array.array("d", [math.nan]) * (rows * len(outputs))
        failed: list[tuple[int, str]] = []
        every = self.scalar.rows(points, rows)

        def keep(first: int, found: list[Any]) -> None:
            for row, one in enumerate(found, first):
                if isinstance(one, str):
                    failed.append((row, one))
                else:
                    for column, value in enumerate(one):
                        answers[column * rows + row] = value

        first = 0
        if self.chunksize is None and every:
            # The first point tells how long one takes. A few of them together make a task.
            took = self.run([every[:1]], outputs, lambda _, found: keep(0, found))
            self.chunksize = max(1, min(MOST, int(TASK / max(took, 1e-6))))
            first = 1
        size = self.size(rows)
        starts = list(range(first, rows, size))
        self.run([every[start : start + size] for start in starts], outputs, lambda place, found: keep(starts[place], found))
        return answers.tobytes(), sorted(failed), 0

    def run(self, tasks: list[Any], outputs: list[int], keep: Any) -> float:
        done: queue.SimpleQueue[tuple[int, Any]] = queue.SimpleQueue()
        futures: list[Any] = []
        stop = threading.Event()

        def send() -> None:
            # Not on the calling thread: Ctrl-C in the middle of submit would leave locks of the executor held for ever.
            try:
                for place, points in enumerate(tasks):
                    if stop.is_set():
                        return
                    future = self.executor.submit(task, self.call, self.answer, points, outputs, **self.options)
                    futures.append(future)
                    future.add_done_callback(lambda future, place=place: done.put((place, future)))
            except BaseException as error:
                done.put((-1, error))

        sender = threading.Thread(target=send, name="sensitol-sender", daemon=True)
        took, left = 0.0, len(tasks)
        try:
            sender.start()
            while left:
                try:
                    place, future = done.get(timeout=TICK)
                except queue.Empty:
                    continue
                if place < 0:
                    raise future
                found, elapsed = future.result()
                took = max(took, elapsed)
                keep(place, found)
                left -= 1
        except BaseException:
            stop.set()
            sender.join()
            for future in futures:
                future.cancel()
            raise
        return took
