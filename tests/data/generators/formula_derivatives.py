"""First and second derivatives of formulas in x0, x1, x2 by differences with 100 digits. Independent of sensitol: mpmath
only, whose functions are not differentiated but evaluated.

    python3 formula_derivatives.py > ../formula-derivatives.json
"""
import json
import random

from mpmath import mp, mpf

mp.dps = 100
STEP = mpf(10) ** -25  # errors of order 1e-50 of truncation and 1e-50 of rounding

NAMES = {
    name: getattr(mp, name)
    for name in "sqrt exp ln log10 sin cos tan asin acos atan atan2 sinh cosh tanh hypot floor ceil sign pi".split()
}
NAMES.update(deg=mp.pi / 180, abs=abs, min=min, max=max, iff=lambda c, a, b: a if c else b)

WRITTEN = """
x0*x1*x2
x0/x1
x0/x1/x2
1/x0
x0^2 + x1^3 + x2^4
x0^5
x0^-1
x0^-2.5
x0^0.5
x0^(1/3)
(0 - x0)^3
(0 - x0)^5 + (0 - x1)^6
(0 - x0)^-3
x0^0 + x1^1
x0^x1
2.5^x0
(x0*x1)^(x2/x0)
sqrt(x0*x1 + x2)
exp(x0/x1)
ln(x0*x1^2)
log10(x0 + x1*x2)
sin(x0*x1)
cos(x0/x2)
tan(x0*0.3)
asin(x0/7)
acos(x0*x1/50)
asin(1 - 1e-6*x0)
atan(x0*x1 - x2)
atan(1e8*x0)
atan2(x0 - 2, x1)
atan2(x1, x0 - 8)
atan2(x1 - 9, x0 - 8)
sinh(x0) - cosh(x1)
tanh(x0 - x1)
tanh(9*x0)
hypot(x0, x1)
hypot(x0 - x1, 1e-3*x2)
hypot(1e200*x0, 1e200*x1)/1e200
1e200*x0/(1e200*x1)
abs(x0 - x1)*x2
floor(x0)*x1 + ceil(x1)*x0 + sign(x0 - x1)*x2^2
min(x0, x1)*max(x1, x2)
min(x0^2, x1*x2, 3)
iff(x0 > x1, x0*x1, x0/x1)
iff(x0 > 5, sqrt(x0 - 5), (5 - x0)^2)*x1
(x0 < x1)*x0^2 + (x0 >= x1)*x1^2
31.9 + x0/cos(17*deg) + (x1 - x2)*tan(x0*deg)
acos((x0*sin(x1*deg) + 1)/(x0 - 1))
sqrt(x0^2 - (x1*sin(x2))^2/40) + x1*cos(x2)
ln(exp(x0) + exp(x1))
1/(1/x0 + 1/x1)
x0 - x0
sin(x0)^2 + cos(x0)^2
"""

UNARY = "-{} sin({}) cos({}) atan({}) tanh({}) sqrt(1+({})^2) exp(-abs({})) ln(2+abs({}))".split()
BINARY = ["({} + {})", "({} - {})", "({} * {})", "({} / (1.5 + ({})^2))", "hypot({}, 1 + {})", "atan2({}, 2 + sin({}))",
          "min({}, {})", "max({}, {})", "iff({} < 1, {}, x1*x2)", "(1.1 + cos({}))^{}"]


def tree(rng, depth):
    if depth == 0 or rng.random() < 0.1:
        return rng.choice(["x0", "x1", "x2", f"{rng.uniform(0.1, 4):.3f}"])
    if rng.random() < 0.4:
        return "(" + rng.choice(UNARY).replace("{}", tree(rng, depth - 1), 1) + ")"
    form = rng.choice(BINARY)
    return form.replace("{}", tree(rng, depth - 1), 1).replace("{}", tree(rng, depth - 1), 1)


def evaluate(text, x):
    value = eval(compiled(text), NAMES, dict(x0=x[0], x1=x[1], x2=x[2]))
    return mpf(value)


def compiled(text):
    return compile(text.replace("^", "**").strip(), text, "eval")


def derivatives(text, at):
    x = [mpf(value) for value in at]

    def f(*moves):
        y = list(x)
        for d, sign in moves:
            y[d] += sign * STEP
        return evaluate(text, y)

    here = f()
    first, second = [], []
    for j in range(3):
        up, down = f((j, 1)), f((j, -1))
        first.append((up - down) / (2 * STEP))
        row = []
        for k in range(3):
            if k == j:
                row.append((up - 2 * here + down) / STEP**2)
            else:
                cross = f((j, 1), (k, 1)) - f((j, 1), (k, -1)) - f((j, -1), (k, 1)) + f((j, -1), (k, -1))
                row.append(cross / (4 * STEP**2))
        second.append(row)
    return here, first, second


def main():
    rng = random.Random(5)
    texts = [line for line in WRITTEN.strip().splitlines()]
    texts += [tree(rng, 5) for _ in range(150)]
    cases = []
    for text in texts:
        for _ in range(2):
            x = [float(f"{rng.uniform(1.2, 4.8):.4f}") for _ in range(3)]
            try:
                value, first, second = derivatives(text, x)
            except (TypeError, ZeroDivisionError, OverflowError, ValueError):
                continue  # no real value there
            small = lambda number: 0.0 if abs(number) < mpf(10) ** -40 else float(number)
            row = {"formula": text.replace("iff(", "if("), "x": x, "value": small(value)}
            row["first"] = [small(number) for number in first]
            row["second"] = [[small(number) for number in line] for line in second]
            tiny = 0 < abs(value) < 1e-15
            if not tiny and all(abs(number) < 1e12 for number in row["first"] + sum(row["second"], [])):
                cases.append(row)
    print("[\n" + ",\n".join(json.dumps(case) for case in cases) + "\n]")


main()
