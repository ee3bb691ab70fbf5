"""The least cost of examples/door-hinge by another route than samples: the exact sigma of the smaller of two clearances.

Both clearances have the same mean and are symmetric about it, so that with D their difference and s1, s2 their sigmas

    Var min = (s1^2 + s2^2)/2 - (E|D|/2)^2,     E|D| = (2/pi) int (1 - phi_D(t))/t^2 dt,

phi_D the product of the characteristic functions of four normal and three uniform dimensions. The sigma grows in proportion to all
tolerances together, and Lagrange's condition gives each of them: T_i^3 = c_i T_i^2 / (lambda d Var/d ln T_i).

Inputs: github.com/EinmalmitProfis/Statistical-Tolerance-Analysis-and-Synthesis-with-Python, common_analysis.py and
statistical_tolerance_optimization_NumPyallworkers.py: T are whole bands, sigma = T/6 of normal ones.

python3 door_hinge.py prints the whole bands and the cost: 129.7394.
"""

import math

NORMAL = [True, False, True, False, True, True, False]
SLOPE = [1, 0.5, 1, 0.5, 1, 1, 0.5]
COST = [1, 9, 5, 15, 2, 11, 18]
SIGMA, MOST = 0.1, 0.7


def variance(bands):
    sigma = [(band / 6 if normal else band / math.sqrt(12)) * slope for band, normal, slope in zip(bands, NORMAL, SLOPE)]
    whole = sum(s * s for s in sigma)
    normal = sum(s * s for s, is_normal in zip(sigma, NORMAL) if is_normal)
    halves = [band * slope / 2 for band, is_normal, slope in zip(bands, NORMAL, SLOPE) if not is_normal]

    def phi(t):
        value = math.exp(-normal * t * t / 2)
        for half in halves:
            x = half * t
            value *= math.sin(x) / x if x > 1e-8 else 1 - x * x / 6
        return value

    # What a normal difference of the same sigma has is known; the rest is integrated by Gauss with three points a step.
    steps, end, total = 4000, 60 / math.sqrt(whole), 0.0
    for k in range(steps):
        for place, weight in ((0.5 - math.sqrt(0.15), 5 / 18), (0.5, 8 / 18), (0.5 + math.sqrt(0.15), 5 / 18)):
            t = (k + place) * end / steps
            total += weight * end / steps * (math.exp(-whole * t * t / 2) - phi(t)) / (t * t)
    distance = math.sqrt(2 * whole / math.pi) + 2 / math.pi * total
    return whole / 2 - distance * distance / 4


def optimum():
    bands = [0.3] * 7
    for _ in range(400):
        def slope(i, step=1e-4):
            up, down = bands[:], bands[:]
            up[i] *= math.exp(step)
            down[i] *= math.exp(-step)
            return (variance(up) - variance(down)) / (2 * step)

        shape = [(cost * band * band / slope(i)) ** (1 / 3) for i, (cost, band) in enumerate(zip(COST, bands))]
        low, high = 1e-3, 10.0
        for _ in range(60):
            factor = math.sqrt(low * high)
            found = [min(MOST, factor * band) for band in shape]
            low, high = (low, factor) if variance(found) > SIGMA**2 else (factor, high)
        far = max(abs(math.log(a / b)) for a, b in zip(found, bands))
        bands = found
        if far < 1e-9:
            break
    return bands


if __name__ == "__main__":
    found = optimum()
    print(found, sum(cost / band for cost, band in zip(COST, found)))
