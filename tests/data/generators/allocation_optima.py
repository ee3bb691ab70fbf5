"""Allocations with several optima, or where sums of powers lead nowhere, with their optima; writes ../allocation-optima.json.

Needs numpy and scipy (pip). Moments of `sum(a x - q x^2)` of normal inputs are exact: mean -q s^2, variance a^2 s^2 + 2 q^2 s^4, with s = T/3.

- curved: one Cpk, four to six dimensions; SLSQP in ln T from 94 starts on the exact moments.
- stacks: groups of alike dimensions with a shim each, a Cpk of its own for every group, so that each group is a problem by itself: for a tolerance of the
  group that of the shim follows from the room that is left, and the one unknown is scanned.
"""

import json
import math
import pathlib

import numpy as np
from scipy import optimize

CURVED = {
    "curved-4": dict(
        terms=[(1.22, 1.26), (0.31, 0.44), (1.57, 0.87), (0.88, 0.55)],
        b=[1.03, 1.8, 0.84, 1.25],
        most=[4.84, 4.48, 2.33, 5.01],
        limits=[None, 1.38],
    ),
    "curved-4-between": dict(
        terms=[(1.24, 1.22), (0.78, 0.79), (0.88, 1.49), (0.47, 0.45)],
        b=[0.32, 1.22, 1.86, 0.25],
        most=[3.75, 3.83, 5.76, 2.82],
        limits=[-7.95, 0.98],
    ),
    "curved-6-between": dict(
        terms=[(1.12, 1.44), (1.24, 0.85), (0.68, 0.96), (1.92, 0.31), (1.61, 1.28), (1.8, 1.19)],
        b=[1.64, 1.09, 1.17, 0.91, 0.21, 1.75],
        most=[3.85, 2.0, 3.52, 3.42, 2.78, 2.73],
        limits=[-12.46, 0.85],
    ),
}
CPK, LEAST = 0.5, 0.01

# Parts of a stack, their curvature, costs of a part and of the shim, upper limit, greatest tolerances of a part and of the shim.
STACKS = {
    "three-stacks": [
        (7, 0.96, 0.99, 19.85, 1.28, 3.38, 3.77),
        (8, 1.23, 0.71, 13.65, 0.94, 2.32, 4.56),
        (8, 1.29, 0.49, 10.49, 0.9, 2.3, 1.52),
    ],
}
STACK_CPK, STACK_LEAST = 0.6, 0.05


def curved(terms, b, most, limits):
    """The study, and its least cost."""
    n = len(terms)
    text = "[dimensions]\n" + "".join(f"x{j} = {{ nominal = 0.0, tolerance = 0.2 }}\n" for j in range(n))
    formula = " + ".join(f"{a}*x{j} - {q}*x{j}^2" for j, (a, q) in enumerate(terms))
    between = "".join(f"{name} = {value}, " for name, value in zip(["lower", "upper"], limits) if value is not None)
    text += f'\n[characteristics]\nk = {{ formula = "{formula}", {between}require = {{ cpk = {CPK} }} }}\n\n[costs]\n'
    text += "".join(f'x{j} = {{ model = "reciprocal", b = {b[j]}, min = {LEAST}, max = {most[j]} }}\n' for j in range(n))
    a, q, b = np.array([t[0] for t in terms]), np.array([t[1] for t in terms]), np.array(b)

    def moments(x):
        s2 = np.exp(2 * x) / 9
        sigma = math.sqrt(a * a @ s2 + 2 * (q * q) @ (s2 * s2))
        return -q @ s2, sigma, -2 * q * s2, (a * a * s2 + 4 * q * q * s2 * s2) / sigma

    def row(sign, limit):
        value = lambda x: sign * (limit - moments(x)[0]) - 3 * CPK * moments(x)[1]
        slopes = lambda x: -sign * moments(x)[2] - 3 * CPK * moments(x)[3]
        return {"type": "ineq", "fun": value, "jac": slopes}

    rows = [row(sign, limit) for sign, limit in zip([-1, 1], limits) if limit is not None]
    low, high = np.log(np.full(n, LEAST)), np.log(most)
    rng = np.random.default_rng(1)
    starts = [np.log(np.full(n, 0.2)), low, high, (low + high) / 2] + [low + rng.random(n) * (high - low) for _ in range(90)]
    best = math.inf
    for start in starts:
        end = optimize.minimize(
            lambda x: ((b * np.exp(-x)).sum(), -b * np.exp(-x)),
            start,
            jac=True,
            method="SLSQP",
            bounds=list(zip(low, high)),
            constraints=rows,
            options={"ftol": 1e-15, "maxiter": 400},
        )
        if all(row["fun"](end.x) > -1e-10 for row in rows):
            best = min(best, float(end.fun))
    return text, best


def optima(parts, q, cost, shim, upper, most, most_shim):
    """The optima of a stack: cost, tolerance of a part, tolerance of the shim."""

    def at(t):
        s2 = t * t / 9
        sigma = (upper + parts * q * s2) / (3 * STACK_CPK)
        left = sigma**2 - parts * (s2 + 2 * (q * s2) ** 2)
        if left < (STACK_LEAST / 3) ** 2:
            return math.inf, 0.0
        own = min(3 * math.sqrt(left), most_shim)
        return parts * cost / t + shim / own, own

    grid = [math.exp(x) for x in np.linspace(math.log(STACK_LEAST), math.log(most), 20001)]
    costs = [at(t)[0] for t in grid]
    found = []
    for k in range(len(grid)):
        sides = [costs[j] for j in (k - 1, k + 1) if 0 <= j < len(grid)]
        if not math.isfinite(costs[k]) or any(side < costs[k] for side in sides):
            continue
        low, high = grid[max(k - 1, 0)], grid[min(k + 1, len(grid) - 1)]
        # Golden section: the cost has one valley between neighbours of the grid.
        for _ in range(80):
            left, right = high - 0.618033988749895 * (high - low), low + 0.618033988749895 * (high - low)
            low, high = (low, right) if at(left)[0] < at(right)[0] else (left, high)
        t = min([low, 0.5 * (low + high), high, grid[k]], key=lambda t: at(t)[0])
        found.append([at(t)[0], t, at(t)[1]])
    return sorted(found)


def stacks(all_stacks):
    """The study, and the optima of every stack."""
    dimensions, characteristics, costs = "[dimensions]\n", "\n[characteristics]\n", "\n[costs]\n"
    for name, (parts, q, cost, shim, upper, most, most_shim) in zip("abcdefgh", all_stacks):
        for j in range(parts):
            dimensions += f"{name}{j} = {{ nominal = 0.0, tolerance = 0.2 }}\n"
        dimensions += f"{name}shim = {{ nominal = 0.0, tolerance = 0.2 }}\n"
        formula = " + ".join(f"{name}{j} - {q}*{name}{j}^2" for j in range(parts)) + f" + {name}shim"
        characteristics += f'{name} = {{ formula = "{formula}", upper = {upper}, require = {{ cpk = {STACK_CPK} }} }}\n'
        costs += f'{name}0 = {{ model = "reciprocal", b = {cost}, min = {STACK_LEAST}, max = {most} }}\n'
        costs += "".join(f'{name}{j} = {{ same_as = "{name}0" }}\n' for j in range(1, parts))
        costs += f'{name}shim = {{ model = "reciprocal", b = {shim}, min = {STACK_LEAST}, max = {most_shim} }}\n'
    return dimensions + characteristics + costs, [optima(*one) for one in all_stacks]


def main():
    problems = []
    for name, of in CURVED.items():
        study, cost = curved(**of)
        problems.append({"name": name, "study": study, "cost": cost})
    for name, of in STACKS.items():
        study, ends = stacks(of)
        problems.append({"name": name, "study": study, "cost": sum(one[0][0] for one in ends), "stacks": ends})
    path = pathlib.Path(__file__).parent.parent / "allocation-optima.json"
    path.write_text(json.dumps({"problems": problems}, indent=1) + "\n")


if __name__ == "__main__":
    main()
