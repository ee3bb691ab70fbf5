"""Laws of values, with the functions of scipy's frozen distributions."""

from __future__ import annotations

from array import array
from typing import TYPE_CHECKING, Any, Tuple, Union

from . import _core

if TYPE_CHECKING:
    from typing import Protocol

    class Source(Protocol):
        """A study: what has the distributions of its dimensions."""

        _core: _core.Study

    #: A dimension of a study, or four moments.
    Made = Union[Tuple[Source, str], Tuple[float, float, float, float]]

__all__ = ["Distribution"]


class Distribution(str):
    """The law of a dimension, or of a fit: its name, with the functions of scipy's frozen distributions.

    The functions take a number, or an array or sequence of any shape, and return the same shape. `sf` and `isf` have the digits of a
    small probability that ``1 - cdf`` and ``ppf(1 - p)`` have lost.

    >>> import sensitol as st
    >>> study = st.Study(dimensions={"a": st.Dimension(10, 0.3)}, characteristics={"y": st.Characteristic("2*a")})
    >>> law = study.dimensions["a"].distribution
    >>> law == "normal", law.cdf(10), round(law.ppf(0.99865), 2)
    (True, 0.5, 10.3)
    """

    _made: Made
    _law: _core.Law | None

    def __new__(cls, name: str, made: Made) -> Distribution:
        self = super().__new__(cls, name)
        self._made = made
        self._law = None
        return self

    def __reduce__(self) -> Any:
        return (Distribution, (str(self), self._made))

    def _known(self) -> _core.Law:
        if self._law is None:
            if len(self._made) == 4:
                self._law = _core.Law.pearson(*self._made)
            else:
                study, name = self._made
                self._law = study._core.law(name)
        assert self._law is not None, "a dimension that does not vary has no distribution"
        return self._law

    def _at(self, what: str, x: Any) -> Any:
        law = self._known()
        if isinstance(x, (int, float)):
            return array("d", law.values(what, array("d", [x]).tobytes()))[0]
        import numpy as np

        x = np.asarray(x, dtype=float)
        return np.frombuffer(law.values(what, x.tobytes()), dtype=float).reshape(x.shape).copy()[()]

    def pdf(self, x: Any) -> Any:
        """Density per unit of `x`.

        Raises
        ------
        ValueError
            Where values have probabilities of their own, as measured ones do.
        """
        return self._at("pdf", x)

    def cdf(self, x: Any) -> Any:
        """Probability of at most `x`."""
        return self._at("cdf", x)

    def sf(self, x: Any) -> Any:
        """Probability of more than `x`: the survival function."""
        return self._at("sf", x)

    def ppf(self, q: Any) -> Any:
        """The value below which the probability is `q`; NaN where that is no probability."""
        return self._at("ppf", q)

    def isf(self, q: Any) -> Any:
        """The value above which the probability is `q`; NaN where that is no probability."""
        return self._at("isf", q)

    def rvs(self, size: int | tuple[int, ...] | None = None, random_state: Any = None) -> Any:
        """Random values: one, or an array of this size. `random_state` is a seed or a generator of NumPy. Both tails are as fine."""
        import numpy as np

        random = np.random.default_rng(random_state)
        # Never 0, whose quantile may be infinite.
        half, upper = 0.5 * (1.0 - random.random(size)), random.random(size) < 0.5
        return np.where(upper, self.isf(half), self.ppf(half))[()]
