// The surface at other tolerances and means, and its moments: the counterpart of Surrogate::relocated and of crates/numeric/src/moments.
const moments = (() => {
  "use strict";

  const polynomial = (c, u) => u * (c[0] + u * (c[1] + u * (c[2] + u * c[3])));

  /// The same function of the dimensions in terms of v, with `u = shift + stretch v`.
  const relocated = ({ centre, parts, pairs: { j, k, a } }, shifts, stretches) => {
    const slopes = new Float64Array(parts.length), scaled = a.map((x, i) => x * stretches[j[i]] * stretches[k[i]]);
    a.forEach((x, i) => {
      slopes[j[i]] += x * shifts[k[i]];
      slopes[k[i]] += x * shifts[j[i]];
    });
    const moved = parts.map(([c1, c2, c3, c4], i) => {
      const d = shifts[i], r = stretches[i];
      // The loop meets every product from both of its sides.
      centre += 0.5 * slopes[i] * d + polynomial([c1, c2, c3, c4], d);
      return [
        r * (c1 + d * (2 * c2 + d * (3 * c3 + d * 4 * c4)) + slopes[i]),
        r * r * (c2 + d * (3 * c3 + d * 6 * c4)),
        r * r * r * (c3 + d * 4 * c4),
        r * r * r * r * c4,
      ];
    });
    return { centre, parts: moved, pairs: { j, k, a: scaled } };
  };

  /// Joint cumulants of the part `g = p u + h` of an input u, by a rule that is exact for them.
  const part = (c, { s, k, parabola, ...table }) => {
    const { nodes, weights } = c[2] === 0 && c[3] === 0 ? parabola ?? table : table;
    const expected = (f) => weights.reduce((sum, weight, i) => sum + weight * f(nodes[i], i), 0);
    const mean = expected((u) => polynomial(c, u)), p = expected((u) => (polynomial(c, u) - mean) * u);
    const h = nodes.map((u) => polynomial(c, u) - mean - p * u);
    const joint = (a, b) => expected((u, i) => u ** a * h[i] ** b);
    const hh = joint(0, 2), uuh = joint(2, 1), uhh = joint(1, 2), uuuh = joint(3, 1), uuhh = joint(2, 2) - hh;
    return {
      mean, p, s, k, hh,
      q: p * s + uuh,
      w: p * p * s + 2 * p * uuh + uhh,
      k3: p ** 3 * s + 3 * p * p * uuh + 3 * p * uhh + joint(0, 3),
      c13: p * k + uuuh,
      c22: p * p * k + 2 * p * uuuh + uuhh,
      k4: p ** 4 * k + 4 * p ** 3 * uuuh + 6 * p * p * uuhh + 4 * p * joint(1, 3) + joint(0, 4) - 3 * hh * hh,
    };
  };

  /// Mean, sigma, skewness, excess kurtosis and shares of the variance, beside an independent normal part with this variance.
  const of = ({ centre, parts, pairs: { j, k, a } }, shapes, unexplained) => {
    const raw = parts.map((c, i) => part(c, shapes[i])), mean = raw.reduce((sum, one) => sum + one.mean, centre);
    const variance = raw.reduce((sum, { p, hh }) => sum + p * p + hh, 0) + a.reduce((sum, x) => sum + x * x, unexplained ?? 0);
    const sigma = Math.sqrt(variance), by = sigma > 0 ? 1 / sigma : 0, n = parts.length;
    const all = parts.map((c, i) => part(c.map((x) => by * x), shapes[i])), products = new Float64Array(n * n);
    a.forEach((x, i) => { products[j[i] * n + k[i]] = products[k[i] * n + j[i]] = by * x; });
    let skewness = 0, excess = 0;
    all.forEach(({ p, s, k, q, w, k3, c13, c22, k4 }, i) => {
      const row = products.subarray(i * n, (i + 1) * n);
      let rho = 0, ap = 0, aw = 0, ww = 0, cs = 0, bq = 0, bws = 0, bbk = 0;
      for (let l = 0; l < n; l++) {
        // An entry of the square of the matrix of products.
        let square = 0;
        for (let m = 0; m < n; m++) square += row[m] * products[l * n + m];
        const x = row[l], b = x * x, other = all[l];
        ww += square * square;
        rho += b;
        ap += x * other.p;
        aw += x * square;
        cs += b * x * other.s;
        bq += b * other.q;
        bws += b * square * other.s;
        bbk += b * b * other.k;
      }
      skewness += k3 + 3 * p * ap + 3 * q * rho + 0.5 * s * cs + aw;
      excess += k4 + 12 * w * ap + 6 * c22 * rho + 6 * q * bq + 12 * ap * ap + 4 * c13 * cs + 12 * s * rho * ap + 12 * q * aw
        + 3 * ww + 6 * s * bws + 3 * k * rho * rho + 0.5 * k * bbk;
    });
    return {
      mean, sigma,
      skewness: sigma > 0 ? skewness : null,
      excess: sigma > 0 ? excess : null,
      linear: all.map(({ p }) => p * p), curvature: all.map(({ hh }) => hh), interactions: Array.from(a, (x) => (by * x) ** 2),
    };
  };

  return { of, polynomial, relocated };
})();
