"""Monte Carlo in numpy beside `sensitol simulate`, one after the other in one run; CPU time of one thread.

    python -m venv /tmp/peers && /tmp/peers/bin/pip install numpy
    cargo build --release && /tmp/peers/bin/python benches/numpy/sampling.py [target/release/sensitol]

Every case is written in numpy as one who knows it would: blocks of 8192 rows, in place where that is simple, PCG64, sums of
powers about a provisional centre, one thread. sensitol does more for each sample: quantiles, shares outside limits and a
histogram besides four moments with standard errors, which take moments up to the eighth.
"""

import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time

os.environ["OMP_NUM_THREADS"] = "1"
import numpy as np

BLOCK = 8192
REPEATS = 7


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

    def moments(self):
        m1, m2, m3, m4 = self.sums / self.n
        variance = m2 - m1**2
        third = m3 - 3 * m1 * m2 + 2 * m1**3
        fourth = m4 - 4 * m1 * m3 + 6 * m1**2 * m2 - 3 * m1**4
        return self.centre + m1, variance**0.5, third / variance**1.5, fourth / variance**2


def engine(rng, samples, identity=False):
    """With `identity` cos 2x = 2 cos^2 x - 1 instead of a second cosine."""
    angle = 0.00872 / 3
    force, moment = Moments(), Moments()
    for _ in range(samples // BLOCK):
        z = rng.standard_normal((10, BLOCK))
        a = 0.05 + 0.0001 / 3 * z[0]
        r, l, hp, hc = (nominal + 0.00004 / 3 * z[1 + i] for i, nominal in enumerate((0.0425, 0.1345, 0.0973, 0.0372)))
        t = angle * z[5]
        scale = (0.427 + 0.597 * hc / (hc + hp)) * r * 628.3185**2
        ratio = r / l
        f = m = 0.0
        for n, phi in enumerate((0.0, np.pi, 3 * np.pi, 2 * np.pi)):
            x = t + (phi + angle * z[6 + n])
            c = np.cos(x)
            share = c + ratio * (2 * c * c - 1 if identity else np.cos(2 * x))
            f = f + share
            m = m + n * share
        force.add(scale * f)
        moment.add(scale * a * m)
    return [*force.moments(), *moment.moments()]


def engine_by_identity(rng, samples):
    return engine(rng, samples, identity=True)


def clutch(rng, samples):
    angle = Moments()
    for _ in range(samples // BLOCK):
        z = rng.standard_normal((3, BLOCK))
        hub, roller, cage = 55.29 + 0.05 / 3 * z[0], 22.86 + 0.02 / 3 * z[1], 101.69 + 0.05 / 3 * z[2]
        angle.add(np.arccos((hub + roller) / (cage - roller)))
    return angle.moments()


def chain(rng, samples):
    gap, rows = Moments(), BLOCK // 8
    for _ in range(samples // rows):
        gap.add(rng.uniform(0.9, 1.1, (rows, 1000)).sum(axis=1))
    return gap.moments()


ENGINE_AS_FORMULA = """
[constants]
MP = 0.427
MR = 0.597
omega = 628.3185

[dimensions]
a    = { nominal = 0.05, tolerance = 0.0001 }
R    = { nominal = 0.0425, tolerance = 0.00004 }
L    = { nominal = 0.1345, tolerance = 0.00004 }
hp   = { nominal = 0.0973, tolerance = 0.00004 }
hc   = { nominal = 0.0372, tolerance = 0.00004 }
t    = { nominal = 0, tolerance = 0.00872 }
phi1 = { nominal = 0, tolerance = 0.00872 }
phi2 = { nominal = 3.141592653589793, tolerance = 0.00872 }
phi3 = { nominal = 9.42477796076938, tolerance = 0.00872 }
phi4 = { nominal = 6.283185307179586, tolerance = 0.00872 }

[formulas]
scale = "(MP + MR*hc/(hc + hp))*R*omega^2"
k1 = "cos(t + phi1) + R/L*cos(2*(t + phi1))"
k2 = "cos(t + phi2) + R/L*cos(2*(t + phi2))"
k3 = "cos(t + phi3) + R/L*cos(2*(t + phi3))"
k4 = "cos(t + phi4) + R/L*cos(2*(t + phi4))"

[characteristics]
F = { formula = "scale*(k1 + k2 + k3 + k4)" }
M = { formula = "scale*a*(k2 + 2*k3 + 3*k4)" }
"""
CLUTCH = """
[dimensions]
hub    = { nominal = 55.29, tolerance = 0.05 }
roller = { nominal = 22.86, tolerance = 0.02 }
cage   = { nominal = 101.69, tolerance = 0.05 }

[characteristics]
angle = { formula = "acos((hub + roller)/(cage - roller))" }
"""
CHAIN = (
    "[dimensions]\n"
    + "".join(f'x{i} = {{ nominal = 1, tolerance = 0.1, distribution = "uniform" }}\n' for i in range(1000))
    + '[characteristics]\ngap = { formula = "' + " + ".join(f"x{i}" for i in range(1000)) + '" }\n'
)

# name, study, samples for us, sampler, numpy's function, its samples
CASES = [
    ("A: engine-balance, 10 normals, 2 outputs", None, 1 << 21, "random", engine, 1 << 20),
    ("A beside numpy with half the cosines", None, 1 << 21, "random", engine_by_identity, 1 << 20),
    ("A as formulas", ENGINE_AS_FORMULA, 1 << 21, "random", engine, 1 << 20),
    ("A by Sobol' points", None, 1 << 20, "sobol", engine, 1 << 20),
    ("B: clutch, 3 normals, acos, as a formula", CLUTCH, 1 << 22, "random", clutch, 1 << 22),
    ("D: sum of 1000 uniforms, as a formula", CHAIN, 1 << 16, "random", chain, 1 << 15),
]


def ours(binary, study, samples, sampler):
    """CPU seconds of a run."""
    command = [binary, "simulate", study, "--samples", str(samples), "--sampler", sampler, "--threads", "1", "-q"]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def peak(binary, study, samples):
    """Kilobytes that a run takes at most."""
    command = [binary, "simulate", study, "--samples", str(samples), "--threads", "1", "-q"]
    child, most = subprocess.Popen(command, stdout=subprocess.DEVNULL), 0
    while child.poll() is None:
        # Of the program alone; what `wait4` tells begins with this interpreter's own, from before it was started.
        with open(f"/proc/{child.pid}/status") as status:
            marks = [line.split()[1] for line in status if line.startswith("VmHWM")]
        most = max([most, *map(int, marks)])
        time.sleep(0.002)
    assert child.returncode == 0
    return most


def main():
    binary = sys.argv[1] if len(sys.argv) > 1 else "target/release/sensitol"
    root = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
    with tempfile.TemporaryDirectory() as folder:
        print(f"{'':44} {'sensitol':>10} {'numpy':>10} {'ratio':>7} {'range':>13}   million samples/s of one core")
        for index, (name, text, samples, sampler, peer, fewer) in enumerate(CASES):
            study = os.path.join(root, "examples/engine-balance/study.toml")
            if text:
                study = os.path.join(folder, f"{index}.toml")
                with open(study, "w") as file:
                    file.write(text)
            speeds, peers = [], []
            # What the process costs before the first sample is not the sampling's.
            start = statistics.median(ours(binary, study, 2, "random") for _ in range(3))
            for repeat in range(REPEATS):
                speeds.append(samples / (ours(binary, study, samples, sampler) - start))
                rng = np.random.Generator(np.random.PCG64(repeat))
                before = time.process_time()
                peer(rng, fewer)
                peers.append(fewer / (time.process_time() - before))
            ratios = sorted(one / other for one, other in zip(speeds, peers))
            print(
                f"{name:44} {statistics.median(speeds) / 1e6:10.2f} {statistics.median(peers) / 1e6:10.2f} "
                f"{statistics.median(ratios):7.1f} {ratios[0]:6.1f} ..{ratios[-1]:5.1f}",
                flush=True,
            )
            if "B:" in name:
                sizes = [peak(binary, study, 10**power) for power in (6, 7, 8)]
                print(f"{'   its peak memory at 1e6, 1e7, 1e8':44} {', '.join(f'{size / 1024:.1f}' for size in sizes)} MB")


main()
