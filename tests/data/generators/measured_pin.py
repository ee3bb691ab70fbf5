"""The measured values of examples/measured-pin: 125 pins of one lot, in microns off 10 mm, as a measuring machine exports
them. Made up, and the same at every run: a slow drift of the tool, a scatter with a long side upwards (a gamma law with
shape 3), rounded to 0.1 micron; two cells without a value, and one pin that was measured with a chip on it. With the word
`checked`, that pin is left out.

    python3 measured_pin.py > ../../../examples/measured-pin/pin.csv
    python3 measured_pin.py checked > ../../../examples/measured-pin/checked.csv
"""
import random
import sys

rng = random.Random(1951)
print("part;time;d_mm;operator")
for i in range(125):
    drift = -0.0004 + 0.0008 * i / 124
    value = f"{9.9876 + drift + 0.0009 * rng.gammavariate(3.0, 1.0):.4f}".replace(".", ",")
    if i == 40:
        value = "" if "checked" in sys.argv else "10,0084"
    if i in (17, 88):
        value = ""
    print(f"{1001 + i};{6 + i // 25:02d}:{(i * 12 // 5) % 60:02d};{value};{'MK' if i < 70 else 'JT'}")
