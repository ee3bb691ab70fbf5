// The moments of a surrogate and their Pearson law, as the engine computes them: crates/numeric/src/surrogate/relocation.rs, crates/numeric/src/moments and
// crates/numeric/src/pearson, of which every function here has its counterpart. tests/browser holds the two together.
const mathematics = (() => {
  "use strict";

  // ---- sums and products without loss -------------------------------------------------------------------------------

  /// Compensated sum (Neumaier 1974).
  const exact = (terms) => {
    let sum = 0, lost = 0;
    for (const term of terms) {
      const next = sum + term;
      lost += Math.abs(sum) >= Math.abs(term) ? (sum - next) + term : (term - next) + sum;
      sum = next;
    }
    return sum + lost;
  };

  // Numbers of twice the precision as [high, low].
  const twoSum = (a, b) => {
    const sum = a + b, part = sum - a;
    return [sum, (a - (sum - part)) + (b - part)];
  };
  const split = (a) => {
    const scaled = 134217729 * a, high = scaled - (scaled - a);
    return [high, a - high];
  };
  const twoProduct = (a, b) => {
    const product = a * b, [ah, al] = split(a), [bh, bl] = split(b);
    return [product, ((ah * bh - product) + ah * bl + al * bh) + al * bl];
  };
  const add = (a, b) => {
    const [s, e] = twoSum(a[0], b[0]), [t, f] = twoSum(a[1], b[1]);
    const [u, g] = twoSum(s, e + t);
    return twoSum(u, g + f);
  };
  const multiply = (a, b) => {
    const [p, e] = twoProduct(a[0], b[0]);
    return twoSum(p, e + (a[0] * b[1] + a[1] * b[0]));
  };
  const times = (factor, a) => multiply([factor, 0], a);
  const value = (a) => a[0] + a[1];

  // ---- the surrogate where inputs have moved ------------------------------------------------------------------------

  const polynomial = (c, u) => u * (c[0] + u * (c[1] + u * (c[2] + u * c[3])));

  /// `u = shift + stretch v`: the same function of the dimensions, in terms of v.
  const relocated = (one, shifts, stretches) => {
    const n = one.parts.length, slopes = new Float64Array(n), { j, k, a } = one.pairs;
    for (let i = 0; i < a.length; i++) {
      slopes[j[i]] += a[i] * shifts[k[i]];
      slopes[k[i]] += a[i] * shifts[j[i]];
    }
    const centres = [one.centre];
    const parts = one.parts.map(([c1, c2, c3, c4], i) => {
      const d = shifts[i], r = stretches[i];
      // Every product is met from both of its sides.
      centres.push(0.5 * slopes[i] * d, polynomial([c1, c2, c3, c4], d));
      return [
        r * (c1 + d * (2 * c2 + d * (3 * c3 + d * 4 * c4))) + slopes[i] * r,
        r * r * (c2 + d * (3 * c3 + d * 6 * c4)),
        r * r * r * (c3 + d * 4 * c4),
        r * r * r * r * c4,
      ];
    });
    const scaled = new Float64Array(a.length);
    for (let i = 0; i < a.length; i++) scaled[i] = stretches[j[i]] * stretches[k[i]] * a[i];
    return { centre: exact(centres), parts, pairs: { j, k, a: scaled } };
  };

  // ---- moments ------------------------------------------------------------------------------------------------------

  const expectation = (rule, f) => rule.weights.reduce((sum, weight, i) => sum + weight * f(i), 0);

  const term = (c, shape) => {
    if (c[2] === 0 && c[3] === 0) {
      return { linear: c[0], curvature: c[1], mean: c[1], largest: Math.max(Math.abs(c[0]), Math.abs(c[1])), shape };
    }
    const values = shape.nodes.map((u) => polynomial(c, u));
    const mean = expectation(shape, (i) => values[i]);
    return { values, mean, largest: Math.max(...values.map((v) => Math.abs(v - mean))), shape };
  };

  /// `factor g - E = p u + h`: the slope, and the cumulants of the rest.
  const parted = (of, factor) => {
    const { shape } = of, { s, k, m5, m6, h6, h7, h8 } = shape;
    if (of.values === undefined) {
      const a = factor * of.curvature, p = factor * of.linear + a * s, s2 = s * s;
      const vv = k + 2, uvv = m5 - 2 * s, vvv = m6 - 3 * (3 + k) + 2, uuuv = m5 - 4 * s;
      return {
        p,
        hh: a * a * (vv - s2),
        uuh: a * (vv - s2),
        uhh: a * a * (uvv - 2 * s * vv + s2 * s),
        hhh: a ** 3 * (vvv - 3 * s * uvv + 3 * s2 * vv - s2 * s2),
        uuuh: a * (uuuv - s * k),
        uuhh: a * a * (h6 - 2 * s * uuuv + s2 * k),
        uhhh: a ** 3 * (h7 - 3 * s * h6 + 3 * s2 * uuuv - s2 * s * k),
        hhhh: a ** 4 * (h8 - 4 * s * h7 + 6 * s2 * h6 - 4 * s2 * s * uuuv + s2 * s2 * k),
      };
    }
    const u = shape.nodes, centred = of.values.map((v) => factor * (v - of.mean));
    const p = expectation(shape, (i) => centred[i] * u[i]);
    const h = centred.map((g, i) => g - p * u[i]);
    const mean = (f) => expectation(shape, (i) => f(u[i], h[i]));
    const hh = mean((u, h) => h * h);
    return {
      p,
      hh,
      uuh: mean((u, h) => u * u * h),
      uhh: mean((u, h) => u * h * h),
      hhh: mean((u, h) => h * h * h),
      uuuh: mean((u, h) => u * u * u * h),
      uuhh: mean((u, h) => (u * u - 1) * h * h),
      uhhh: mean((u, h) => u * h * h * h),
      hhhh: mean((u, h) => h ** 4) - 3 * hh * hh,
    };
  };

  const part = (of, factor) => {
    const { p, hh, uuh, uhh, hhh, uuuh, uuhh, uhhh, hhhh } = parted(of, factor), { s, k } = of.shape;
    return {
      p, s, k,
      curved: hh,
      q: p * s + uuh,
      w: p * p * s + 2 * p * uuh + uhh,
      k3: p * p * p * s + 3 * p * p * uuh + 3 * p * uhh + hhh,
      c13: p * k + uuuh,
      c22: p * p * k + 2 * p * uuuh + uuhh,
      k4: p ** 4 * k + 4 * p ** 3 * uuuh + 6 * p * p * uuhh + 4 * p * uhhh + hhhh,
    };
  };

  /// For every row of `A` the sums that the cumulants need. `W = A A` is as symmetric as `A`: each entry is made once, in a row
  /// of which only what lies right of the diagonal is held.
  const rows = (parts, pairs, factor) => {
    const n = parts.length, all = new Float64Array(n * n), w = new Float64Array(n), where = new Int32Array(n + 3);
    for (let i = 0; i < pairs.a.length; i++) {
      all[pairs.j[i] * n + pairs.k[i]] = all[pairs.k[i] * n + pairs.j[i]] = factor * pairs.a[i];
    }
    const sums = parts.map(() => ({ rho: 0, ap: 0, aw: 0, ww: 0, cs: 0, bq: 0, bws: 0, bbk: 0 }));
    const meets = (row, a, wk, other) => {
      const b = a * a;
      row.rho += b;
      row.ap += a * other.p;
      row.aw += a * wk;
      row.cs += b * a * other.s;
      row.bq += b * other.q;
      row.bws += b * wk * other.s;
      row.bbk += b * b * other.k;
    };
    for (let j = 0; j < n; j++) {
      let count = 0;
      for (let i = 0; i < n; i++) if (all[j * n + i] !== 0) where[count++] = i;
      // Four rows at a time: every sum is taken up and laid down a fourth as often. The places after the last are of no
      // weight.
      where.fill(j, count, count + 3);
      w.fill(0, j);
      for (let i = 0; i < count; i += 4) {
        const e = where[i] * n, f = where[i + 1] * n, g = where[i + 2] * n, h = where[i + 3] * n;
        const ae = all[e + j], af = all[f + j], ag = all[g + j], ah = all[h + j];
        for (let l = j; l < n; l++) w[l] += ae * all[e + l] + af * all[f + l] + ag * all[g + l] + ah * all[h + l];
      }
      sums[j].ww += w[j] * w[j];
      for (let k = j + 1; k < n; k++) {
        const a = all[j * n + k], squared = w[k] * w[k];
        sums[j].ww += squared;
        sums[k].ww += squared;
        if (a === 0) continue;
        meets(sums[j], a, w[k], parts[k]);
        meets(sums[k], a, w[k], parts[j]);
      }
    }
    return sums;
  };

  /// Mean, sigma, skewness, excess kurtosis and shares of the variance.
  const moments = (surrogate, shapes) => {
    const terms = surrogate.parts.map((c, i) => term(c, shapes[i])), { pairs } = surrogate;
    const mean = exact([surrogate.centre, ...terms.map((of) => of.mean)]);
    let largest = Math.max(0, ...terms.map((of) => of.largest));
    for (let i = 0; i < pairs.a.length; i++) largest = Math.max(largest, Math.abs(pairs.a[i]));
    if (largest === 0) {
      const none = terms.map(() => 0);
      return { mean, sigma: 0, skewness: null, excess: null, linear: none, curvature: none, perSigma: 0 };
    }
    const n = terms.length, variances = new Float64Array(n + pairs.a.length);
    terms.forEach((of, i) => {
      const { p, hh } = parted(of, 1 / largest);
      variances[i] = p * p + hh;
    });
    for (let i = 0; i < pairs.a.length; i++) variances[n + i] = (pairs.a[i] / largest) ** 2;
    const relative = Math.sqrt(exact(variances)), perSigma = 1 / largest / relative;
    const parts = terms.map((of) => part(of, perSigma)), sums = rows(parts, pairs, perSigma);
    const over = (f) => exact(parts.map((one, i) => f(one, sums[i])));
    const skewness = exact([
      over((one) => one.k3),
      3 * over((one, row) => one.p * row.ap),
      3 * over((one, row) => one.q * row.rho),
      0.5 * over((one, row) => one.s * row.cs),
      over((_, row) => row.aw),
    ]);
    const excess = exact([
      over((one) => one.k4),
      12 * over((one, row) => one.w * row.ap),
      6 * over((one, row) => one.c22 * row.rho),
      6 * over((one, row) => one.q * row.bq),
      12 * over((_, row) => row.ap * row.ap),
      4 * over((one, row) => one.c13 * row.cs),
      12 * over((one, row) => one.s * row.rho * row.ap),
      12 * over((one, row) => one.q * row.aw),
      3 * over((_, row) => row.ww),
      6 * over((one, row) => one.s * row.bws),
      3 * over((one, row) => one.k * row.rho * row.rho),
      0.5 * over((one, row) => one.k * row.bbk),
    ]);
    const linear = parts.map((one) => one.p * one.p), curvature = parts.map((one) => one.curved);
    return { mean, sigma: largest * relative, skewness, excess, linear, curvature, perSigma };
  };

  /// The same beside an independent normal part with this variance.
  const beside = (of, variance) => {
    const sigma = Math.hypot(of.sigma, Math.sqrt(variance));
    if (sigma === of.sigma) return of;
    const share = of.sigma / sigma, scale = (shares) => shares.map((one) => one * share * share);
    return {
      mean: of.mean,
      sigma,
      skewness: (of.skewness ?? 0) * share ** 3,
      excess: (of.excess ?? 0) * share ** 4,
      linear: scale(of.linear),
      curvature: scale(of.curvature),
      perSigma: of.perSigma * share,
    };
  };

  return { add, beside, exact, moments, multiply, relocated, times, twoProduct, twoSum, value };
})();
