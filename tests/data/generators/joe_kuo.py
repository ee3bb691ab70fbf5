"""Joe and Kuo's table as the bits that the library holds, crates/numeric/src/sampling/joe_kuo.bin, of the text tests/data/joe-kuo.txt.

Their notice as text, and a byte 0; then for every dimension a byte by which the word of its polynomial's coefficients grows, all but the
last coefficient, highest first; then the initial numbers m_1 .. m_s of every dimension, in which (m_k - 1)/2 has k - 1 bits, lowest first.
"""

import pathlib

HERE = pathlib.Path(__file__).parent
lines = (HERE.parent / "joe-kuo.txt").read_text().splitlines()
notice = "\n".join(line.removeprefix("#").strip() for line in lines if line.startswith("#"))
steps, bits, before = bytearray(), [], 0
for line in lines:
    if line.startswith("#"):
        continue
    degree, middle, *initial = map(int, line.split())
    polynomial = 1 << (degree - 1) | middle
    steps.append(polynomial - before)
    before = polynomial
    assert len(initial) == degree
    for k, number in enumerate(initial):
        assert number % 2 == 1 and number < 2 << k
        bits += [number >> 1 + bit & 1 for bit in range(k)]
packed = bytes(sum(bit << place for place, bit in enumerate(bits[at:at + 8])) for at in range(0, len(bits), 8))
(HERE.parents[2] / "crates/numeric/src/sampling/joe_kuo.bin").write_bytes(notice.encode() + b"\0" + steps + packed)
