"""Random points of six models in numpy and in numba, one thread, as one who knows them would write it: the peers of `simulate`.

Both sum four powers about a provisional centre. numpy goes over blocks of 8192 rows, numba over one point after the other; both draw
from PCG64. sensitol does more for each sample: quantiles, shares outside limits and a histogram besides four moments with
standard errors, which take moments up to the eighth.
"""

import math

import numpy as np

try:
    import numba
except ImportError:
    numba = None

BLOCK = 8192
DEG = math.pi / 180
FACTOR = np.linalg.cholesky(np.full((6, 6), 0.5) + 0.5 * np.eye(6))


class Moments:
    """Sums of four powers about the first block's mean."""

    def __init__(self):
        self.centre, self.n, self.sums = None, 0, np.zeros(4)

    def add(self, y):
        if self.centre is None:
            self.centre = y.mean()
        d = y - self.centre
        square = d * d
        self.n += len(y)
        self.sums += d.sum(), square.sum(), np.dot(square, d), np.dot(square, square)


def in_blocks(outputs, dimensions, evaluate):
    """A function of a generator and a number of samples that draws normals and adds up what `evaluate` makes of them."""

    def run(rng, samples):
        moments = [Moments() for _ in range(outputs)]
        for _ in range(samples // BLOCK):
            for one, y in zip(moments, evaluate(rng.standard_normal((dimensions, BLOCK)))):
                one.add(y)

    return run


def engine(z):
    angle, length = 0.00872 / 3, 0.00004 / 3
    a = 0.05 + 0.0001 / 3 * z[0]
    r, l, hp, hc = (nominal + length * z[1 + i] for i, nominal in enumerate((0.0425, 0.1345, 0.0973, 0.0372)))
    t = angle * z[5]
    scale, ratio, f, m = (0.427 + 0.597 * hc / (hc + hp)) * r * 628.3185**2, r / l, 0.0, 0.0
    for n, phi in enumerate((0.0, np.pi, 3 * np.pi, 2 * np.pi)):
        c = np.cos(t + (phi + angle * z[6 + n]))
        share = c + ratio * (2 * c * c - 1)
        f, m = f + share, m + n * share
    return scale * f, scale * a * m


def clutch(z):
    hub, roller, cage = 55.29 + 0.05 / 3 * z[0], 22.86 + 0.02 / 3 * z[1], 101.69 + 0.05 / 3 * z[2]
    return (np.arccos((hub + roller) / (cage - roller)),)


def blocks(z):
    a, b, c, e = (nominal + 0.1 * z[i] for i, nominal in enumerate((10, 30, 31.9, 55)))
    f, big, small, th = 75 + 0.5 / 3 * z[4], 40 + 0.1 * z[5], 10 + 0.1 / 3 * z[6], (17 + z[7] / 3) * DEG
    sine, cosine = np.sin(th), np.cos(th)
    tangent, q = sine / cosine, (big * sine + small) / (big - small)
    y = c + e / cosine + (a - b) * tangent - big * sine * tangent
    return (f - small - y + (big - small) * np.sqrt(1 - q * q),)


def uniforms(rng, samples):
    gap, rows = Moments(), BLOCK // 8
    for _ in range(samples // rows):
        gap.add(rng.uniform(0.9, 1.1, (rows, 1000)).sum(axis=1))


def correlated(z):
    x = FACTOR @ z
    return (sum((-1) ** j * (10 + 0.1 / 3 * x[j]) for j in range(6)),)


def gun(z):
    total = [0.0, 0.0, 0.0]
    for arm, s in ((z[:11], 1.0), (z[11:], -1.0)):
        middles, sigmas = (30 * s, 0, -30 * s, 0, 0), (1 / 6, 0.2, 1 / 6, 1 / 6, 0.2)
        angles = [(m + k * arm[i]) * DEG for m, k, i in zip(middles, sigmas, (7, 8, 5, 3, 4))]
        (sb, cb), (ss, cs), (sh, ch), (st, ct), (sy, cy) = ((np.sin(angle), np.cos(angle)) for angle in angles)
        front, rear, hang = 150 + 2 * arm[9] / 3, 120 + 2 * arm[6] / 3, -s * (70 + arm[10] / 6)
        ahead, up = front * cb + hang * sb, hang * cb - front * sb
        y, x = ahead * ss, rear + ahead * cs
        x, w = x * ch + up * sh, up * ch - x * sh
        y, w = y * ct - w * st, y * st + w * ct
        x, y = x * cy - y * sy, x * sy + y * cy
        total = [total[0] + s * (15 * s + arm[2] / 6 + w), total[1] + s * (arm[0] + x), total[2] + s * (arm[1] / 6 + y)]
    return total


NUMPY = {
    "engine": in_blocks(2, 10, engine),
    "clutch": in_blocks(1, 3, clutch),
    "blocks": in_blocks(1, 8, blocks),
    "uniforms": uniforms,
    "correlated": in_blocks(1, 6, correlated),
    "gun": in_blocks(3, 22, gun),
}
NUMBA = {}

if numba:
    jit = numba.njit

    @jit
    def _sums(sums, y):
        square = y * y
        sums[0] += y
        sums[1] += square
        sums[2] += square * y
        sums[3] += square * square

    @jit
    def _engine(rng, samples):
        sums, angle, length = np.zeros((2, 4)), 0.00872 / 3, 0.00004 / 3
        phi = (0.0, math.pi, 3 * math.pi, 2 * math.pi)
        for _ in range(samples):
            a = 0.05 + 0.0001 / 3 * rng.standard_normal()
            r, l = 0.0425 + length * rng.standard_normal(), 0.1345 + length * rng.standard_normal()
            hp, hc = 0.0973 + length * rng.standard_normal(), 0.0372 + length * rng.standard_normal()
            t, scale, ratio, f, m = angle * rng.standard_normal(), (0.427 + 0.597 * hc / (hc + hp)) * r * 628.3185**2, r / l, 0.0, 0.0
            for n in range(4):
                c = math.cos(t + phi[n] + angle * rng.standard_normal())
                share = c + ratio * (2 * c * c - 1)
                f += share
                m += n * share
            _sums(sums[0], scale * f - 12556.0)
            _sums(sums[1], scale * a * m - 941.0)
        return sums

    @jit
    def _clutch(rng, samples):
        sums = np.zeros(4)
        for _ in range(samples):
            hub, roller = 55.29 + 0.05 / 3 * rng.standard_normal(), 22.86 + 0.02 / 3 * rng.standard_normal()
            cage = 101.69 + 0.05 / 3 * rng.standard_normal()
            _sums(sums, math.acos((hub + roller) / (cage - roller)) - 0.13)
        return sums

    @jit
    def _blocks(rng, samples):
        sums = np.zeros(4)
        for _ in range(samples):
            a, b = 10 + 0.1 * rng.standard_normal(), 30 + 0.1 * rng.standard_normal()
            c, e = 31.9 + 0.1 * rng.standard_normal(), 55 + 0.1 * rng.standard_normal()
            f, big = 75 + 0.5 / 3 * rng.standard_normal(), 40 + 0.1 * rng.standard_normal()
            small, th = 10 + 0.1 / 3 * rng.standard_normal(), (17 + rng.standard_normal() / 3) * DEG
            sine, cosine = math.sin(th), math.cos(th)
            tangent, q = sine / cosine, (big * sine + small) / (big - small)
            y = c + e / cosine + (a - b) * tangent - big * sine * tangent
            _sums(sums, f - small - y + (big - small) * math.sqrt(1 - q * q) - 6.0)
        return sums

    @jit
    def _uniforms(rng, samples):
        sums = np.zeros(4)
        for _ in range(samples):
            gap = 0.0
            for _ in range(1000):
                gap += 0.9 + 0.2 * rng.random()
            _sums(sums, gap - 1000.0)
        return sums

    @jit
    def _correlated(rng, samples):
        sums, z = np.zeros(4), np.zeros(6)
        for _ in range(samples):
            for j in range(6):
                z[j] = rng.standard_normal()
            y = 0.0
            for j in range(6):
                x = 0.0
                for k in range(j + 1):
                    x += FACTOR[j, k] * z[k]
                y += (1 - 2 * (j % 2)) * (10 + 0.1 / 3 * x)
            _sums(sums, y)
        return sums

    @jit
    def _gun(rng, samples):
        sums, x, total = np.zeros((3, 4)), np.zeros(11), np.zeros(3)
        for _ in range(samples):
            total[:] = 0.0
            for arm in range(2):
                s = 1.0 - 2.0 * arm
                for j in range(11):
                    x[j] = rng.standard_normal()
                tilt, yaw, shut = x[3] / 6 * DEG, 0.2 * x[4] * DEG, (-30 * s + x[5] / 6) * DEG
                bend, skew = (30 * s + x[7] / 6) * DEG, 0.2 * x[8] * DEG
                front, rear, hang = 150 + 2 * x[9] / 3, 120 + 2 * x[6] / 3, -s * (70 + x[10] / 6)
                ahead = front * math.cos(bend) + hang * math.sin(bend)
                up = hang * math.cos(bend) - front * math.sin(bend)
                v, u = ahead * math.sin(skew), rear + ahead * math.cos(skew)
                u, w = u * math.cos(shut) + up * math.sin(shut), up * math.cos(shut) - u * math.sin(shut)
                v, w = v * math.cos(tilt) - w * math.sin(tilt), v * math.sin(tilt) + w * math.cos(tilt)
                u, v = u * math.cos(yaw) - v * math.sin(yaw), u * math.sin(yaw) + v * math.cos(yaw)
                total[0] += s * (15 * s + x[2] / 6 + w)
                total[1] += s * (x[0] + u)
                total[2] += s * (x[1] / 6 + v)
            for k in range(3):
                _sums(sums[k], total[k] - (10.0 if k == 0 else 0.0))
        return sums

    NUMBA = {"engine": _engine, "clutch": _clutch, "blocks": _blocks, "uniforms": _uniforms, "correlated": _correlated, "gun": _gun}
