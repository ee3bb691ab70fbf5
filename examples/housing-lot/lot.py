"""The lot of this example: 60 measured sets of parts and 40 measured assemblies. Made up, and the same at every run.

The housings are 0.03 mm too deep; everything else is as the study assumes. The assemblies are of other parts of the same lot.

    python3 lot.py
"""

import random
from pathlib import Path

rng = random.Random(59)
FOLDER = Path(__file__).parent
LAWS = {"depth": (42.03, 0.02), "bearing": (15.0, 0.01), "spacer": (24.8, 0.0133), "ring": (2.0, 0.01)}


def part():
    return {name: rng.gauss(mean, sigma) for name, (mean, sigma) in LAWS.items()}


lines = ["part;time;machine;depth;bearing;spacer;ring"]
for i in range(60):
    values = ";".join(f"{value:.4f}".replace(".", ",") for value in part().values())
    lines.append(f"{101 + i};{6 + i // 10:02d}:{i % 10 * 6:02d};{'M1' if i % 2 else 'M2'};{values}")
FOLDER.joinpath("parts.csv").write_text("\n".join(lines) + "\n")

lines = ["assembly;play"]
for i in range(40):
    p = part()
    play = p["depth"] - p["bearing"] - p["spacer"] - p["ring"]
    lines.append(f"A{i + 1};{play:.4f}".replace(".", ","))
FOLDER.joinpath("assemblies.csv").write_text("\n".join(lines) + "\n")
