"""Lists under additive rows with their least costs, by HiGHS; writes ../allocation-lists.json.

Needs highspy 1.15 (pip). The problems follow from seeds by arithmetic that every language rounds alike; tests/allocation/allocation_lists.rs makes
them again. `--time` prints milliseconds of HiGHS, one thread, in place of writing.
"""

import json
import math
import pathlib
import sys
import time

import highspy

MASK = (1 << 64) - 1
SIZES = [(20, 5), (30, 8), (40, 6), (50, 10), (60, 8)]
# Proportional costs under several rows: larger ones take HiGHS minutes.
HARD = [(12, 4), (15, 5), (20, 5), (25, 4)]


def splitmix(seed):
    """S. Vigna's splitmix64 as numbers in [0, 1)."""
    state = seed
    while True:
        state = (state + 0x9E3779B97F4A7C15) & MASK
        z = state
        z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & MASK
        z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & MASK
        yield ((z ^ (z >> 31)) >> 11) * 2.0**-53


def lists(seed, count, options, rows, squares, proportional):
    """[list][option] of (cost, uses), every row with capacity 1."""
    u = splitmix(seed)
    all_lists = []
    for _ in range(count):
        size = 0.02 + 0.08 * next(u)
        b = 0.5 + 1.5 * next(u)
        kind = math.floor(3.0 * next(u))
        slopes = []
        for r in range(rows):
            slope = 0.3 + 1.2 * next(u)
            absent = next(u) < 0.3
            slopes.append(0.0 if r > 0 and absent else slope)
        own = []
        for _ in range(options):
            factor = 0.3 + 2.7 * next(u)
            tolerance = size * factor
            noise = next(u)
            power = [1.0, math.sqrt(1.0 / factor), 1.0 / factor * math.sqrt(1.0 / factor)][kind]
            power = 1.0 / factor if kind == 0 else power
            linear = [slope * tolerance for slope in slopes]
            uses = [x * x for x in linear] if squares else linear
            own.append((b * power * (0.97 + 0.06 * noise), uses, noise))
        if proportional:
            sums = []
            for _, uses, _ in own:
                total = 0.0
                for use in uses:
                    total += use
                sums.append(total)
            most = max(sums)
            own = [(110.0 * most - 100.0 * total * (0.98 + 0.04 * noise), uses, noise)
                   for (_, uses, noise), total in zip(own, sums)]
        all_lists.append([(cost, uses) for cost, uses, _ in own])
    for r in range(rows):
        tight = loose = 0.0
        for own in all_lists:
            tight += min(uses[r] for _, uses in own)
            loose += max(uses[r] for _, uses in own)
        room = tight + 0.35 * (loose - tight)
        for own in all_lists:
            for _, uses in own:
                uses[r] /= room
    return all_lists


def problems():
    """Forty: sizes by rows by rss and worst case, some of them proportional."""
    seed = 0
    for rows in (1, 2, 3):
        plain = [(size, squares) for size in SIZES for squares in (True, False)]
        for (count, options), squares in plain[:9]:
            seed += 1
            yield dict(seed=seed, lists=count, options=options, rows=rows, squares=squares, proportional=False)
    for rows, sizes in ((1, SIZES), (2, HARD), (3, HARD)):
        for place, (count, options) in enumerate(sizes):
            seed += 1
            yield dict(seed=seed, lists=count, options=options, rows=rows, squares=place % 2 == 0, proportional=True)


def solved(own):
    """Least cost and milliseconds."""
    highs = highspy.Highs()
    for option, value in (("output_flag", False), ("threads", 1), ("mip_rel_gap", 0.0), ("mip_abs_gap", 0.0),
                          ("mip_feasibility_tolerance", 1e-9), ("time_limit", 1500.0)):
        highs.setOptionValue(option, value)
    rows = len(own[0][0][1])
    costs = [cost for options in own for cost, _ in options]
    columns = len(costs)
    highs.addVars(columns, [0.0] * columns, [1.0] * columns)
    highs.changeColsIntegrality(columns, list(range(columns)), [highspy.HighsVarType.kInteger] * columns)
    highs.changeColsCost(columns, list(range(columns)), costs)
    first = 0
    for options in own:
        highs.addRow(1.0, 1.0, len(options), list(range(first, first + len(options))), [1.0] * len(options))
        first += len(options)
    for r in range(rows):
        uses = [uses[r] for options in own for _, uses in options]
        highs.addRow(-highspy.kHighsInf, 1.0, columns, list(range(columns)), uses)
    begun = time.perf_counter()
    highs.run()
    took = 1e3 * (time.perf_counter() - begun)
    assert highs.getModelStatus() == highspy.HighsModelStatus.kOptimal, highs.getModelStatus()
    values = highs.getSolution().col_value
    cost, used, at = 0.0, [0.0] * rows, 0
    for options in own:
        pick = max(range(len(options)), key=lambda i: values[at + i])
        cost += options[pick][0]
        for r in range(rows):
            used[r] += options[pick][1][r]
        at += len(options)
    assert max(used) <= 1.0 + 1e-9, used
    return cost, took


def main():
    """Writes the file, or prints times."""
    found = []
    for problem in problems():
        cost, took = solved(lists(**{("count" if key == "lists" else key): value for key, value in problem.items()}))
        found.append({**problem, "cost": cost})
        if "--time" in sys.argv:
            print(f"{problem['seed']} {took:.3f}", flush=True)
    if "--time" not in sys.argv:
        path = pathlib.Path(__file__).parent.parent / "allocation-lists.json"
        lines = ",\n".join("  " + json.dumps(one) for one in found)
        path.write_text(f'{{\n "problems": [\n{lines}\n ]\n}}\n')


if __name__ == "__main__":
    main()
