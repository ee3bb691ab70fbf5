// The Pearson law of four moments, of every type by one equation. With Q = 1 + c1 z + c2 z^2 and dz/dt = Q, z(t) is closed, and the
// mass by dt obeys d log w/dt = -(1 + c2) z: smooth to the ends of the support, which lie at infinite t or at a pole of z.
const pearson = (mean, sigma, skewness, excess) => {
  "use strict";

  /// Positive nodes and weights of the Gauss-Legendre rule with 8 points (Abramowitz and Stegun 1964, table 25.4).
  const LEGENDRE = [
    [0.1834346424956498, 0.3626837833783620], [0.5255324099163290, 0.3137066458778873],
    [0.7966664774136267, 0.2223810344533745], [0.9602898564975363, 0.1012285362903763],
  ];
  /// Logarithm of the part of the mass at which a tail ends, and the most panels of a tail.
  const ENDED = -45, PANELS = 400;

  const b1 = skewness * skewness, b2 = 3 + excess;
  if (!(sigma > 0 && excess - b1 > -2 && Number.isFinite(b2))) return null;
  const c0 = 4 * b2 - 3 * b1, c1 = skewness * (b2 + 3) / c0, c2 = (2 * excess - 3 * b1) / c0, half = 0.5 * c1;
  const bend = c2 - half * half, k = Math.sqrt(Math.abs(bend));
  const tangent = (t) => bend > 0 ? Math.tan(k * t) / k : bend < 0 ? Math.tanh(k * t) / k : t;
  const place = (t) => 1 / (1 / tangent(t) - half);
  const time = (z) => {
    const below = 1 + half * z;
    return bend > 0 ? Math.atan2(k * z, below) / k : bend < 0 ? Math.atanh(k * z / below) / k : z / below;
  };
  /// Where z has its pole on this side, if it has one.
  const pole = (sign) => bend > 0 ? Math.atan2(k, sign * half) / k : sign * half <= k ? Infinity
    : bend < 0 ? Math.atanh(k / (sign * half)) / k : 1 / (sign * half);

  const integral = (f, a, b) => {
    const middle = 0.5 * (a + b), reach = 0.5 * (b - a);
    return reach * LEGENDRE.reduce((sum, [x, weight]) => sum + weight * (f(middle - reach * x) + f(middle + reach * x)), 0);
  };
  const fall = (from, to) => -(1 + c2) * integral(place, from, to);
  /// The next end of a panel: before the pole, with a fall that a rule resolves.
  const next = (t, sign) => {
    const slope = (1 + c2) * Math.abs(place(t));
    return t + sign * Math.min(0.4 * (pole(sign) - sign * t), 2 / slope, 0.3 / (1 + k) + 0.5 * Math.abs(t));
  };
  const ends = new Map([[-1, [[0, 0]]], [1, [[0, 0]]]]);
  const logAt = (t) => {
    const sign = t < 0 ? -1 : 1, known = ends.get(sign);
    for (let i = 0; ; i++) {
      const [from, log] = known[i], to = next(from, sign);
      if (sign * (to - t) >= 0 || i === PANELS) return log + fall(from, t);
      if (known.length === i + 1) known.push([to, log + fall(from, to)]);
    }
  };
  const beyond = (t, sign) => {
    const first = logAt(t);
    let from = t, log = first, mass = 0;
    for (let i = 0; log > first + ENDED && i < PANELS; i++) {
      const [start, own, to] = [from, log, next(from, sign)];
      mass += sign * integral((u) => Math.exp(own + fall(start, u)), start, to);
      log += fall(start, to);
      from = to;
    }
    return mass;
  };
  const total = beyond(0, 1) + beyond(0, -1);
  const parabola = (z) => 1 + z * (c1 + z * c2);
  const inside = (z) => parabola(z) > 0 && (bend > 0 || 1 + half * z > 0);
  return {
    density: (x) => {
      const z = (x - mean) / sigma;
      return inside(z) ? Math.exp(logAt(time(z))) / (total * sigma * parabola(z)) : 0;
    },
    /// Probabilities below and above x, and their error beside that of the fit.
    shares: (x) => {
      const z = (x - mean) / sigma, sign = z < 0 ? -1 : 1;
      const tail = inside(z) ? beyond(time(z), sign) / total : 0;
      return sign < 0 ? [tail, 1 - tail, 0] : [1 - tail, tail, 0];
    },
  };
};
