"""Random points of two assemblies by a batched Newton method in numpy, one thread: the peers of `simulate` on closure conditions.

Both go over blocks of 8192 rows, start from the nominal solution and its linear change, solve all small systems of a block by one call
of `numpy.linalg.solve`, and end when the longest step of the block is at rounding. The ring is solved by blocks of 1024 rows, whose
matrices stay in the cache.
"""

import numpy as np

from .sampling import BLOCK, DEG, Moments

RING = 18


def newton(x, nominal, u, equations):
    """The unknowns of every row of `x`, from those at the nominal dimensions."""
    residual, by_unknowns = equations(nominal[:, None], u[:, None])
    while np.abs(step := np.linalg.solve(by_unknowns, residual.T[..., None])[..., 0]).max() > 1e-13:
        u = u - step[0]
        residual, by_unknowns = equations(nominal[:, None], u[:, None])
    # Derivatives of the unknowns, by central differences of the equations: they serve the prediction only.
    size = 1e-6 * np.maximum(1.0, np.abs(nominal))
    shifted = lambda sign: equations(nominal[:, None] + sign * np.diag(size), np.repeat(u[:, None], len(nominal), 1))[0]
    slopes = -np.linalg.solve(by_unknowns[0], (shifted(1) - shifted(-1)) / (2 * size))
    found = u[:, None] + slopes @ (x - nominal[:, None])
    for _ in range(10):
        residual, by_unknowns = equations(x, found)
        step = np.linalg.solve(by_unknowns, residual.T[..., None])[..., 0].T
        found -= step
        # The error of a Newton step is about its square.
        if np.abs(step / np.maximum(1.0, np.abs(u))[:, None]).max() < 1e-8:
            return found
    raise ArithmeticError("no solution")


def blocks(x, u):
    """Two loops of the stacked blocks: height, contact along the slope, height of the round, direction to it."""
    a, b, c, e, _, big, small, th = x
    u1, u2, u3, phi = u
    th = th * DEG
    sine, cosine, sine_phi, cosine_phi = np.sin(th), np.cos(th), np.sin(phi), np.cos(phi)
    residual = np.stack([
        -e * sine + u2 * cosine + b - a + big * sine,
        c + e * cosine + u2 * sine - u3,
        (big - small) * cosine_phi - big * sine - small,
        u1 + (big - small) * sine_phi - u3,
    ])
    matrix = np.zeros((residual.shape[1], 4, 4))
    matrix[:, 0, 1], matrix[:, 1, 1] = cosine, sine
    matrix[:, 1, 2], matrix[:, 3, 2] = -1.0, -1.0
    matrix[:, 2, 3], matrix[:, 3, 3], matrix[:, 3, 0] = -(big - small) * sine_phi, (big - small) * cosine_phi, 1.0
    return residual, matrix


def ring(d, u):
    """Eighteen equations in a ring, `u_i^2 + 0.5 sin(u_(i+1)) + 0.3 exp(-u_(i+5)) = 1.5 d_i`."""
    following, far = np.roll(u, -1, axis=0), np.roll(u, -5, axis=0)
    decay = 0.3 * np.exp(-far)
    residual = u * u + 0.5 * np.sin(following) + decay - 1.5 * d
    matrix = np.zeros((u.shape[1], RING, RING))
    row = np.arange(RING)
    matrix[:, row, row] = 2 * u.T
    matrix[:, row, (row + 1) % RING] = 0.5 * np.cos(following).T
    matrix[:, row, (row + 5) % RING] = -decay.T
    return residual, matrix


def sampler(nominal, sigma, start, equations, output, rows):
    """A function of a generator and a number of samples that sums four powers of an output."""
    nominal, sigma, start = (np.array(values, dtype=float) for values in (nominal, sigma, start))

    def run(rng, samples):
        moments = Moments()
        for _ in range(samples // rows):
            x = nominal[:, None] + sigma[:, None] * rng.standard_normal((len(nominal), rows))
            moments.add(output(x, newton(x, nominal, start, equations)))
        return moments.centre + moments.sums[0] / moments.n

    return run


NUMPY = {
    "blocks": sampler(
        [10, 30, 31.9, 55, 75, 40, 10, 17],
        [0.1, 0.1, 0.1, 0.1, 0.5 / 3, 0.1, 0.1 / 3, 1 / 3],
        [60, -15, 80, 0.75],
        blocks,
        lambda x, u: x[4] - x[6] - u[0],
        BLOCK,
    ),
    "ring": sampler([1.0] * RING, [0.02 / 3] * RING, [1.0] * RING, ring, lambda _, u: u.sum(axis=0), BLOCK // 8),
}
