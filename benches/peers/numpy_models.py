"""Evaluations of the published models a second, one core, in numpy: the peer of `cargo bench --bench models`.

Every model is transcribed as one who knows numpy would: blocks of rows, whole columns at a time. Where a maximum over the crank
angle is asked for, numpy takes the largest of 49 (37) angles and the parabola through its neighbours, which is good to about 1e-3;
sensitol refines to rounding.

    OMP_NUM_THREADS=1 python3 benches/peers/numpy_models.py
"""

import time

import numpy as np

BLOCK = 8192
REPEATS = 5


def columns(nominal, rows):
    row = np.arange(rows)
    return [x * (1 + 1e-3 * np.sin(row * (d + 3))) for d, x in enumerate(nominal)]


def engine(x):
    mp, mr, omega, a, r, l, hp, hc, t, *phi = x
    scale, ratio, f, m = (mp + mr * hc / (hc + hp)) * r * omega**2, r / l, 0.0, 0.0
    for n in range(4):
        c = np.cos(t + phi[n])
        share = c + ratio * (2 * c * c - 1)
        f, m = f + share, m + n * share
    return scale * f, scale * a * m


def clearance(x):
    a, b, c, d, e, f, g, h, j, k, l, p = x
    return a + b + c - d - h - l + (e - f) / 2 + (g - f) / 2 + (j - k) / 2 - p / 2


def quick_return(x):
    r, d, e, q, c, h, s = x
    delta, gamma = np.arctan2(e, d), np.arcsin((r + s / 2) / np.hypot(d, e))

    def ram(b):
        return q * np.sin(b) + np.sqrt(c * c - (h - q * np.cos(b)) ** 2)

    return ram(delta + gamma) - ram(delta - gamma), (np.pi + 2 * gamma) / (np.pi - 2 * gamma)


def spot_weld(x):
    def tip(px, py, pz, tilt, yaw, close, rear, bend, skew, front, tip, sign):
        tilt, yaw, close, bend, skew = (np.radians(angle) for angle in (tilt, yaw, close, bend, skew))
        hang = -sign * tip
        ahead, up = front * np.cos(bend) + hang * np.sin(bend), hang * np.cos(bend) - front * np.sin(bend)
        x, y, z = rear + ahead * np.cos(skew), ahead * np.sin(skew), up
        x, z = x * np.cos(close) + z * np.sin(close), z * np.cos(close) - x * np.sin(close)
        y, z = y * np.cos(tilt) - z * np.sin(tilt), y * np.sin(tilt) + z * np.cos(tilt)
        x, y = x * np.cos(yaw) - y * np.sin(yaw), x * np.sin(yaw) + y * np.cos(yaw)
        return px + x, py + y, pz + z

    upper, lower = tip(*x[:11], 1), tip(*x[11:], -1)
    return upper[2] - lower[2], upper[0] - lower[0], upper[1] - lower[1]


def flywheel(x):
    j1, j2, k, c, jf, jc, kc, cc, t0 = x

    def second(j1, j2, k, c, w):
        return np.hypot(k, c * w) / (w * np.hypot((j1 + j2) * k - j1 * j2 * w * w, (j1 + j2) * c * w))

    def critical(j1, j2, k):
        return 30 / np.pi / 1.5 * np.sqrt(k * (1 / j1 + 1 / j2))

    w = 1.5 * np.pi / 30
    a, d, k2, c2 = (j1 * j2) ** 2, ((j1 + j2) * k) ** 2, k * k, c * c
    b = ((j1 + j2) * c) ** 2 - 2 * (j1 + j2) * k * j1 * j2
    rest = c2 * d - b * k2
    square = rest / (a * k2 + np.sqrt(a * a * k2 * k2 + a * c2 * rest))
    return (
        critical(j1, j2, k),
        critical(jf, jc, kc),
        t0 * second(j1, j2, k, c, 1000 * w),
        t0 * 1500 * w * second(j1, j2, k, c, 1500 * w),
        t0 * 1500 * w * second(jf, jc, kc, cc, 1500 * w),
        t0 * np.sqrt((k2 + c2 * square) / (d + square * (b + square * a))),
    )


def top(values):
    """The largest over the angles, by the parabola through it and its neighbours."""
    best = np.clip(values.argmax(axis=0), 1, len(values) - 2)
    column = np.arange(values.shape[1])
    low, mid, high = values[best - 1, column], values[best, column], values[best + 1, column]
    return mid - (high - low) ** 2 / (8 * (high - 2 * mid + low))


def rod(theta, r, l, mc, m, mp, ig, d, p3, ths, gas):
    sin, cos = np.sin(theta)[:, None], np.cos(theta)[:, None]
    w, area = 100 * np.pi, np.pi * d * d / 4
    sa = r * sin / l
    ca = -np.sqrt(1 - sa * sa)
    rate = (r * w * cos / (l * ca)) ** 2
    turn = (l * rate * sa - r * w * w * sin) / (l * ca)
    piston = -r * w * w * cos + l * turn * sa + l * rate * ca
    ax = -mc * (rate * ca + turn * sa) + piston
    ay = -mc * rate * sa + mc * turn * ca
    along = 0.0
    if gas:
        ratio = 133.6 / 41
        v = 1 + 4.75 * (ratio + 1 - cos - np.sqrt(ratio**2 - sin**2))
        u = np.maximum(0, (np.degrees(theta)[:, None] - ths) / 55)
        rest = np.exp(-5 * u**3)
        p = rest * 1e5 * (10.5 / v) ** 1.32 + (1 - rest) * p3 * v**-1.28
        along = -(p - 1.01325e5) * area - mp * piston
    side = (-ig * turn + m * (l - mc) * (ay * ca - ax * sa) + along * l * sa) / (l * ca)
    return side * sa + along * ca if gas else side * ca


ROD = [0.041, 0.1336, 0.105, 0.529, 0.41, 1.34e-3, 0.0785, 9.55e6, -15.0]


def compression(x):
    return top(rod(np.radians(np.arange(-60.0, 180.1, 5)), *x, gas=True))


def normal(x):
    return top(rod(np.radians(np.arange(0.0, 180.1, 5)), *x, gas=False))


PHI = [0.0, np.pi, 3 * np.pi, 2 * np.pi]
ARM = [0.0, 0.0, 15.0, 0.0, 0.0, -30.0, 120.0, 30.0, 0.0, 150.0, 70.0]
CASES = [
    ("engine-balance", engine, [0.427, 0.597, 628.3185, 0.05, 0.0425, 0.1345, 0.0973, 0.0372, 0.0] + PHI, BLOCK),
    ("compression-clearance", clearance, [334.5661, 40.03, 1.2, 65, 36.01, 36, 36.03, 210, 70.05, 70, 60, 80], BLOCK),
    ("quick-return", quick_return, [56.6, 140, 8, 220, 180, 235, 0.05], BLOCK),
    ("spot-weld", spot_weld, ARM + [-x if i in (2, 5, 7) else x for i, x in enumerate(ARM)], BLOCK),
    ("dual-mass-flywheel", flywheel, [0.29, 0.04, 327.844, 1.5, 0.33, 0.019, 2000, 2, 420], BLOCK),
    ("connecting-rod F_comp_3000", compression, ROD, 1024),
    ("connecting-rod Fn_rod_3000", normal, ROD, 1024),
]


def main():
    for name, function, nominal, block in CASES:
        x = columns(nominal, block)
        first = function(x)
        first = first[0] if isinstance(first, tuple) else first
        count = max(1, (1 << 19) // block // (16 if "rod" in name else 1))
        speeds = []
        for _ in range(REPEATS):
            before = time.process_time()
            for _ in range(count):
                function(x)
            speeds.append(count * block / (time.process_time() - before))
        print(f"{name:28} {sorted(speeds)[REPEATS // 2] / 1e6:8.3f} million/s   (first value {first[0]:.6g})", flush=True)


main()
