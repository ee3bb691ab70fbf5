"""sin, cos, tan, exp, ln and acos of doubles with 60 digits, the nearest double and what it lacks. Independent of sensitol:
mpmath.

    python elementary.py > ../elementary.json
"""

import json
import random

from mpmath import mp, mpf, sin, cos, tan, exp, log, acos, pi

mp.dps = 60


def angles(rng):
    yield from (0.5, 1.0, 3.0, 1e-300, 5e-324, 1e-9, -2e-8, 0.785398163397448, 0.7853981633974484, 1.6e6, 1599999.5)
    # The doubles next to multiples of pi/2, and near the places where the reduction goes over to the next one.
    for n in (1, 2, 3, 4, 5, 6, 11, 100, 1001, 4098, 65537, 1000000):
        for quarters in (mpf(n), n + mpf(1) / 2):
            near = float(quarters * pi / 2)
            yield from (near, -near, near * (1 + 1e-12), near * (1 - 3e-9), near + 1e-6)
    for _ in range(200):
        yield rng.choice((-1, 1)) * 10 ** rng.uniform(-12, 6.2)
    for _ in range(100):
        yield rng.uniform(-7, 14)


def cases(rng):
    for x in angles(rng):
        for name, function in (("sin", sin), ("cos", cos), ("tan", tan)):
            yield name, function, x
    for _ in range(150):
        yield "exp", exp, rng.uniform(-707, 707)
        yield "exp", exp, rng.choice((-1, 1)) * 10 ** rng.uniform(-18, 1)
        yield "ln", log, 10 ** rng.uniform(-300, 300)
        yield "ln", log, 1 + rng.choice((-1, 1)) * 10 ** rng.uniform(-15, -0.5)
        yield "acos", acos, rng.uniform(-1, 1)
        yield "acos", acos, rng.choice((-1, 1)) * (1 - 10 ** rng.uniform(-15, -0.2))
    for x in (0.5, -0.5, 0.49999999999999994, -0.5000000000000001, 1e-20, -1e-300):
        yield "acos", acos, x


rows = []
for name, function, x in cases(random.Random(1)):
    x = float(x)
    exact = function(mpf(x))
    value = float(exact)
    rows.append([name, x, value, float(exact - mpf(value))])
print("[\n" + ",\n".join(json.dumps(row) for row in rows) + "\n]")
