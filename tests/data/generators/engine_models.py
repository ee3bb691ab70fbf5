"""Checks tests/data/connecting-rod.json and dual-mass-flywheel.json: nominal values and gradients again, with 40 digits.

The equations are written here a second time, straight from the model's documentation, and maxima over the angle are zeros of the
derivative; a gradient is a central difference over 1e-12 of an input. Independent of sensitol: mpmath alone.

    python3 engine_models.py
"""

import json
import os

from mpmath import cos, diff, exp, findroot, fabs, mp, mpf, pi, radians, sin, sqrt

mp.dps = 40
HERE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")


def rod(x, theta, w, gas, mass_centre=None, inertia=1):
    r, l, mc, m, mp_, ig = x["r"] / 1000, x["L"] / 1000, x["MC"] / 1000, x["M_rod"] / 1000, x["M_p"] / 1000, x["I_g"] / mpf(10) ** 6
    mc, ig = (mc if mass_centre is None else mass_centre), ig * inertia
    s = r * sin(theta) / l
    c = -sqrt(1 - s * s)
    rate = r * w * cos(theta) / (l * c)
    turn = (l * rate**2 * s - r * w**2 * sin(theta)) / (l * c)
    piston = -r * w**2 * cos(theta) + l * turn * s + l * rate**2 * c
    ax = -mc * (rate**2 * c + turn * s) + piston
    ay = -mc * rate**2 * s + mc * turn * c
    along = 0
    if gas:
        ratio, degrees = mpf("133.6") / 41, theta * 180 / pi
        v = 1 + mpf("4.75") * (ratio + 1 - cos(theta) - sqrt(ratio**2 - sin(theta) ** 2))
        u = (degrees - x["ths"]) / 55
        rest = exp(-5 * u**3) if u > 0 else mpf(1)
        p = rest * 10**5 * (mpf("10.5") / v) ** mpf("1.32") + (1 - rest) * x["p3"] * 10**5 * v ** mpf("-1.28")
        along = -(p - 101325) * pi * (x["D"] / 1000) ** 2 / 4 - mp_ * piston
    side = (-ig * turn - m * ax * (l - mc) * s + m * ay * (l - mc) * c + along * l * s) / (l * c)
    torque = -side * (r * cos(theta) - l * c) + m * ay * (r * cos(theta) - (l - mc) * c) - m * ax * mc * s + ig * turn
    return -side * s - along * c, side * c - along * s, torque


def section(x, k3):
    t, k1, k2 = x["t"] / 1000, x["k1"], x["k2"]
    area = (2 * k1 + k2 * k3) * t**2
    across = t**4 * (k1 / 6 + k2 * k3**3 / 12 + k1 * (k3 + 1) ** 2 / 2)
    return area, across, t**4 * (2 * k1**3 + k3 * k2**3) / 12


def top(function, near):
    at = findroot(lambda theta: diff(function, theta), radians(mpf(near)))
    return function(at)


def rod_values(x, settings, angles):
    w = 100 * pi
    cubes = lambda centre, l: centre**3 + (l - centre) ** 3
    reference, eyes = mpf("0.105"), mpf("0.1336")
    moved = lambda key: mpf(str(settings[key])) + x["MC"] / 1000 - reference
    mc_f = mpf(str(settings["mc_F"]))
    optimum = lambda theta: rod(x, theta, w, False, moved("mc_F"), cubes(mc_f, eyes) / cubes(reference, eyes))[1]
    tied = cubes(moved("mc_T"), x["L"] / 1000) / cubes(reference, x["L"] / 1000)
    r, l, fast = x["r"] / 1000, x["L"] / 1000, 200 * pi
    area = pi * (x["D"] / 1000) ** 2 / 4
    compression = top(lambda theta: -rod(x, theta, w, True)[0], angles["F_comp_3000"])
    web = x["H"] / x["t"] - 2
    shank = (x["L"] - x["r_is"] - x["t_s"] - x["t_b"] - x["r_ib"]) / 1000
    buckling = pi**2 * x["E"] * 10**9 / (l**2 * compression)
    return {
        "F_tens_6000": x["M_p"] / 1000 * fast**2 * r * (1 + r / l) + 1325 * area,
        "F_comp_3000": compression,
        "T_peak_3000": top(lambda theta: -rod(x, theta, w, True)[2], angles["T_peak_3000"]),
        "Fn_rod_3000": top(lambda theta: rod(x, theta, w, False)[1], angles["Fn_rod_3000"]),
        "T_rod_3000": top(lambda theta: rod(x, theta, w, False)[2], angles["T_rod_3000"]),
        "Fn_opt_lobeA": top(optimum, angles["Fn_opt_lobeA"]),
        "Fn_opt_lobeB": top(lambda theta: -optimum(theta), angles["Fn_opt_lobeB"]),
        "T_opt_tied": top(lambda theta: -rod(x, theta, w, False, moved("mc_T"), tied)[2], angles["T_opt_tied"]),
        "n_zz": buckling * section(x, web)[1],
        "n_yy": 4 * buckling * section(x, web)[2],
        "m_shank": 1000 * x["rho"] * section(x, web)[0] * shank,
    }


def wheel_values(x):
    second = lambda j1, j2, k, c, w: fabs((k + 1j * c * w) / (1j * w * ((j1 + j2) * (k + 1j * c * w) - j1 * j2 * w**2)))
    first = lambda j1, j2, k, c, w: fabs((k - j2 * w**2 + 1j * c * w) / (1j * w * ((j1 + j2) * (k + 1j * c * w) - j1 * j2 * w**2)))
    dual, single = [x[k] for k in ("J1", "J2", "k", "c")], [x[k] for k in ("J_f", "J_c", "k_c", "c_c")]
    order = lambda n: mpf("1.5") * n * pi / 30
    acceleration = lambda shaft, n: x["T0"] * order(n) * second(*shaft, order(n))
    critical = lambda j1, j2, k, c: 20 / pi * sqrt(k * (1 / j1 + 1 / j2))
    return {
        "n_crit_DMF": critical(*dual),
        "n_crit_SMF": critical(*single),
        "dW2_1000": x["T0"] * second(*dual, order(1000)),
        "dW1_1000": x["T0"] * first(*dual, order(1000)),
        "A_DMF_1500": acceleration(dual, 1500),
        "A_SMF_1500": acceleration(single, 1500),
        "A_ratio_1500": acceleration(dual, 1500) / acceleration(single, 1500),
        "n_cross": findroot(lambda n: acceleration(dual, n) - acceleration(single, n), mpf(837)),
        "A_peak_DMF": acceleration(dual, findroot(lambda n: diff(lambda n: acceleration(dual, n), n), mpf(589))),
    }


def check(title, case, values):
    nominal = {one["name"]: mpf(str(one["nominal"])) for one in case["inputs"]}
    at = values(nominal)
    worst = max(abs(float(at[name] / mpf(case["kcs"][name]["nominal"]) - 1)) for name in at)
    slopes = 0.0
    for place, one in enumerate(case["inputs"]):
        h = mpf(10) ** -12 * max(abs(nominal[one["name"]]), 1)
        above, below = (values({**nominal, one["name"]: nominal[one["name"]] + sign * h}) for sign in (1, -1))
        for name in at:
            slope, sigma = (above[name] - below[name]) / (2 * h), one["tolerance"] / 3
            off = abs(float(slope - mpf(case["kcs"][name]["gradient"][place]))) * sigma
            slopes = max(slopes, off / case["kcs"][name]["second_order"]["sigma"])
    print(f"{title}: {len(at)} nominal values within {worst:.1e}, slopes within {slopes:.1e} of sigma")


def main():
    with open(os.path.join(HERE, "connecting-rod.json")) as file:
        rods = json.load(file)
    for variant, case in rods.items():
        angles = {name: kc["theta"] for name, kc in case["kcs"].items() if "theta" in kc}
        check(f"connecting rod {variant}", case, lambda x: rod_values(x, case["settings"], angles))
    with open(os.path.join(HERE, "dual-mass-flywheel.json")) as file:
        check("dual-mass flywheel", json.load(file), wheel_values)


main()
