"""Measured parts for the example compression-clearance: made up, for the paper gives no values of its own.

Of every dimension 60 parts of a process in the middle of its band, 1.2 times as wide as T/3: the paper's measured engines, 0.7321
to 0.9499 mm of 328, are as wide as 6 sigma of 0.0363, where T/3 gives 0.0302.

    python3 tests/data/generators/clearance_parts.py > examples/compression-clearance/parts.csv
"""

import random

NAMES = "ABCDEFGHJKLP"
NOMINAL = [334.5661, 40.03, 1.2, 65.0, 36.01, 36.0, 36.03, 210.0, 70.05, 70.0, 60.0, 80.0]
TOLERANCE = [0.05, 0.0105, 0.05, 0.04, 0.0035, 0.003, 0.0075, 0.02, 0.0195, 0.0095, 0.03, 0.011]

rng = random.Random(2022)
print(",".join(NAMES))
for _ in range(60):
    parts = (nominal + tolerance * rng.gauss(0.0, 1.2 / 3.0) for nominal, tolerance in zip(NOMINAL, TOLERANCE))
    print(",".join(f"{part:.4f}" for part in parts))
