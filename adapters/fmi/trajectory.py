"""One number of a trajectory.

A sample's largest value and the sample after a crossing jump from one sample to the next as a parameter changes, which spoils every
difference. So extremes are those of the parabola through three samples, and a crossing is the root of the cubic through four.
"""

import math

HOW = ("final", "max", "min", "mean", "crossing")
# Halvings of an interval: more than a double has digits.
HALVINGS = 80


def functional(time, values, how, level=None, direction="any"):
    """The value of these samples, None where there is none, such as a level that is not crossed."""
    time, values = [float(one) for one in time], [float(one) for one in values]
    if not all(map(math.isfinite, values)):
        return None
    if how == "final":
        return values[-1]
    if how == "max":
        return largest(time, values)
    if how == "min":
        return -largest(time, [-one for one in values])
    if how == "mean":
        steps = zip(time, time[1:], values, values[1:])
        return sum((b - a) * (x + y) / 2 for a, b, x, y in steps) / (time[-1] - time[0])
    return crossing(time, values, level, direction)


def largest(time, values):
    """The top of the parabola through the largest sample and its neighbours, or the sample itself at an end or event."""
    place = max(range(len(values)), key=values.__getitem__)
    if not 0 < place < len(values) - 1:
        return values[place]
    (a, b, c), (x, y, z) = time[place - 1 : place + 2], values[place - 1 : place + 2]
    if not a < b < c:
        return y
    left, right = (y - x) / (b - a), (z - y) / (c - b)
    bend = (right - left) / (c - a)
    if bend >= 0:
        return y
    slope = left + bend * (b - a)
    return y - slope * slope / (4 * bend)


def crossing(time, values, level, direction):
    """When the values first cross the level."""
    for k in range(len(values) - 1):
        before, after = values[k] - level, values[k + 1] - level
        up, down = before < 0 <= after, before > 0 >= after
        if (up and direction != "down") or (down and direction != "up"):
            return root(time, [one - level for one in values], k)
    return None


def root(time, values, k):
    """The root between samples k and k + 1."""
    first, last = max(k - 1, 0), min(k + 3, len(values))
    nodes = list(zip(time[first:last], values[first:last]))
    low, high = time[k], time[k + 1]
    if high <= low:
        return high
    if any(b[0] <= a[0] for a, b in zip(nodes, nodes[1:])):
        # An event: samples on its other side belong to another curve.
        nodes = [(low, values[k]), (high, values[k + 1])]

    def polynomial(t):
        total = 0.0
        for i, (at, value) in enumerate(nodes):
            for j, (other, _) in enumerate(nodes):
                if j != i:
                    value *= (t - other) / (at - other)
            total += value
        return total

    negative = values[k] < 0
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        if (polynomial(middle) < 0) == negative:
            low = middle
        else:
            high = middle
    return (low + high) / 2
