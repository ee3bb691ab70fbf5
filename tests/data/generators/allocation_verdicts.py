"""Cheapest tolerances of studies on which derivatives do not follow the model: kinks, jumps, eccentric bands, uniform inputs at 1 ppm.

Yields by one-dimensional quadrature or in closed form, tolerances by nested minimisation: nothing is shared with the engine. Python 3.11
without packages. `python3 allocation_verdicts.py` writes ../allocation-verdicts.json; it takes a minute.
"""

import itertools
import json
import math
import os


def cdf(z):
    return 0.5 * math.erfc(-z / math.sqrt(2))


def simpson(f, a, b, steps):
    if b <= a:
        return 0.0
    h = (b - a) / (2 * steps)
    inner = sum((4 if k % 2 else 2) * f(a + k * h) for k in range(1, 2 * steps))
    return (f(a) + inner + f(b)) * h / 3


def density(z):
    return math.exp(-0.5 * z * z) / math.sqrt(2 * math.pi)


FAR = 9.0


def kink(t):
    """y = a + 6 max(0, c - 0.05) above 0.18."""
    a, c = t[0] / 3, t[1] / 3
    knee = 0.05 / c
    beyond = simpson(lambda z: density(z) * cdf(-(0.18 - 6 * (c * z - 0.05)) / a), min(knee, FAR), FAR, 200)
    return cdf(knee) * cdf(-0.18 / a) + beyond


def jump(t):
    """y = a + b + 0.2 (b > 0.07) above 0.2."""
    a, b = t[0] / 3, t[1] / 3
    step = 0.07 / b
    before = simpson(lambda z: density(z) * cdf(-(0.2 - b * z) / a), -FAR, min(step, FAR), 400)
    return before + simpson(lambda z: density(z) * cdf(b * z / a), min(step, FAR), FAR, 200)


def eccentric(t):
    """play = hole - pin - 2 |e| outside 0 .. 0.09, with bands that begin at the nominal sizes: the mean moves with both."""
    mean, sigma = 0.02 + t[0] + t[1], math.hypot(t[0], t[1]) / 3

    def of(z):
        play = mean - 2 * t[2] / 3 * z
        return 2 * density(z) * (cdf(-play / sigma) + cdf(-(0.09 - play) / sigma))

    return simpson(of, 0.0, FAR, 60)


def uniform(t):
    """a - b - c of uniform dimensions beyond 0.3 on either side, by inclusion and exclusion."""
    total = 0.0
    for signs in range(8):
        lengths = [2 * t[k] * (signs >> k & 1) for k in range(3)]
        rest = sum(t) - 0.3 - sum(lengths)
        total += (-1) ** bin(signs).count("1") * max(rest, 0.0) ** 3
    return 2 * total / (6 * 8 * t[0] * t[1] * t[2])


def last(rejects, allowed, fixed, low, high):
    """The largest last tolerance with the others fixed; None where none keeps it. A wide one may move the mean the right way, so that the
    search goes down from the widest."""
    steps = 40
    grid = [low * (high / low) ** (k / steps) for k in range(steps + 1)]
    above = high
    for t in reversed(grid):
        if rejects(fixed + [t]) <= allowed:
            low, high = t, above
            break
        above = t
    else:
        return None
    for _ in range(40):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if rejects(fixed + [middle]) <= allowed else (low, middle)
    return low


def optimum(rejects, allowed, costs, bounds):
    low, high = bounds

    def with_last(fixed):
        t = last(rejects, allowed, fixed, low, high)
        if t is None:
            return 1e9 * (1 + rejects(fixed + [low])), fixed + [low]
        return len(costs) + sum(b / t for b, t in zip(costs, fixed + [t])), fixed + [t]

    # No valley is left out: a grid first, then a compass of ever smaller steps from its best places.
    free, steps = len(costs) - 1, 160 if len(costs) == 2 else 16
    grid = [low * (high / low) ** (k / steps) for k in range(steps + 1)]
    places = sorted((with_last(list(at))[0], at) for at in itertools.product(grid, repeat=free))
    ways = [way for way in itertools.product([-1, 0, 1], repeat=free) if any(way)]
    found = []
    for cost, at in places[:3]:
        step = math.log(high / low) / steps
        while step > 1e-9:
            around = [[min(max(t * math.exp(step * w), low), high) for t, w in zip(at, way)] for way in ways]
            next_cost, next_at = min((with_last(to)[0], to) for to in around)
            if next_cost < cost:
                cost, at = next_cost, next_at
            else:
                step /= 2
        found.append((cost, list(at)))
    cost, at = min(found)
    return cost, with_last(at)[1]


def study(dimensions, characteristic, costs):
    lines = ["[dimensions]"] + [f"{name} = {{ {entry} }}" for name, entry in dimensions.items()]
    lines += ["[characteristics]", f"y = {{ {characteristic} }}", "[costs]"]
    return "\n".join(lines + [f"{name} = {{ {entry} }}" for name, entry in costs.items()]) + "\n"


def reciprocal(b, low=0.001, high=1.0):
    return f'model = "reciprocal", a = 1.0, b = {b}, min = {low}, max = {high}'


PLAIN = "nominal = 0.0, tolerance = 0.05"
CASES = {
    "kink": (
        kink, 0.002, [0.03, 0.04], (0.001, 1.0),
        study({"a": PLAIN, "c": PLAIN}, 'formula = "a + 6*max(0, c - 0.05)", upper = 0.18, target_yield = 0.998',
              {"a": reciprocal(0.03), "c": reciprocal(0.04)}),
    ),
    "jump": (
        jump, 0.001, [0.03, 0.04], (0.001, 1.0),
        study({"a": PLAIN, "b": PLAIN}, 'formula = "a + b + if(b > 0.07, 0.2, 0)", upper = 0.2, target_yield = 0.999',
              {"a": reciprocal(0.03), "b": reciprocal(0.04)}),
    ),
    "eccentric": (
        eccentric, 0.0027, [0.02, 0.05, 0.05], (0.001, 0.2),
        study({"hole": "nominal = 25.0, tolerance = [0.0, 0.02]", "pin": "nominal = 24.98, tolerance = [-0.02, 0.0]",
               "e": "nominal = 0.0, tolerance = 0.01"},
              'formula = "hole - pin - 2*abs(e)", lower = 0.0, upper = 0.09, target_yield = 0.9973',
              {"hole": reciprocal(0.02, 0.001, 0.2) + ', fixed_side = "lower"',
               "pin": reciprocal(0.05, 0.001, 0.2) + ', fixed_side = "upper"', "e": reciprocal(0.05, 0.001, 0.2)}),
    ),
    "uniform-ppm": (
        uniform, 1e-6, [0.1, 0.4, 0.2], (0.001, 1.0),
        study({name: f'nominal = {nominal}, tolerance = 0.09, distribution = "uniform"'
               for name, nominal in [("a", 10.0), ("b", 6.0), ("c", 3.0)]},
              'formula = "a - b - c", lower = 0.7, upper = 1.3, target_yield = 0.999999',
              {"a": reciprocal(0.1), "b": reciprocal(0.4), "c": reciprocal(0.2)}),
    ),
}

PROCESSES = {
    "a": [("p1", 0.03, 4.0), ("p2", 0.05, 3.0), ("p3", 0.1, 2.0), ("p4", 0.15, 1.5), ("p5", 0.25, 1.0)],
    "c": [("p1", 0.03, 4.0), ("p2", 0.05, 3.0), ("p3", 0.08, 2.0), ("p4", 0.15, 1.5)],
}


def lists():
    of = lambda name, t, cost: f'{{ name = "{name}", tolerance = {t}, cost = {cost} }}'
    costs = {name: "processes = [" + ", ".join(of(*one) for one in all) + "]" for name, all in PROCESSES.items()}
    text = study({"a": PLAIN, "c": PLAIN}, 'formula = "a + 6*max(0, c - 0.05)", upper = 0.18, target_yield = 0.998', costs)
    kept = [(a[2] + c[2], [a[1], c[1]]) for a in PROCESSES["a"] for c in PROCESSES["c"] if kink([a[1], c[1]]) <= 0.002]
    cost, tolerances = min(kept)
    return {"study": text, "cost": cost, "tolerances": tolerances, "rejects": kink(tolerances)}


def main():
    found = {}
    for name, (rejects, allowed, costs, bounds, text) in CASES.items():
        cost, tolerances = optimum(rejects, allowed, costs, bounds)
        found[name] = {"study": text, "cost": cost, "tolerances": tolerances, "rejects": rejects(tolerances)}
        print(name, cost, tolerances, rejects(tolerances))
    found["kink-lists"] = lists()
    print("kink-lists", found["kink-lists"]["cost"], found["kink-lists"]["tolerances"], found["kink-lists"]["rejects"])
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "allocation-verdicts.json")
    with open(path, "w") as file:
        json.dump(found, file, indent=2)
        file.write("\n")


if __name__ == "__main__":
    main()
