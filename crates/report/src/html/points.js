// Shares of a surface at points, where the page has no transform of it: products of inputs that are not normal. The same points serve all
// settings, so that the error of a change comes from the points that change sides only.
const points = (() => {
  "use strict";

  /// Points at most and at least, and numbers that all of them take.
  const MOST = 1 << 16, FEWEST = 1 << 10, NUMBERS = 1 << 20;
  /// Standard errors that bound an error, three for the points and one for the lines between nodes, and points that a count has been off at
  /// least.
  const ERRORS = 4, UNSEEN = 3;

  /// Uniform numbers below 1, the same on every page (Steele, Lea and Flood 2014, with 32 bits).
  const uniform = (seed) => () => {
    let x = seed = (seed + 0x9e3779b9) >>> 0;
    x = Math.imul(x ^ (x >>> 16), 0x21f0aaad);
    x = Math.imul(x ^ (x >>> 15), 0x735a2d97);
    return ((x ^ (x >>> 15)) >>> 0) / 4294967296 + 1.1641532182693481e-10;
  };

  /// The value of a standardised input below which this share lies: one of its values, or on lines between nodes with half their weight on
  /// either side.
  const quantile = ({ z, w, support, top }) => {
    const order = [...z.keys()].sort((a, b) => z[a] - z[b]), isListed = top === null;
    let sum = 0;
    const ends = support.map((end, side) => end ?? z[order.at(-side)]), places = [ends[0], ...order.map((q) => z[q]), ends[1]];
    const shares = [0, ...order.map((q) => (sum += w[q]) - (isListed ? 0 : 0.5 * w[q])), sum];
    return (u) => {
      let low = 0, high = shares.length - 1;
      while (low < high) {
        const middle = (low + high) >> 1;
        if (shares[middle] < u * sum) low = middle + 1;
        else high = middle;
      }
      const width = isListed || low === 0 ? 0 : shares[low] - shares[low - 1];
      return width > 0 ? places[low] - (places[low] - places[low - 1]) * (shares[low] - u * sum) / width : places[low];
    };
  };

  /// The standardised inputs with an effect at every point, and a normal variable last.
  const drawn = ({ parts, pairs: { j, k, a } }, shapes) => {
    const counts = parts.map((c, input) => c.some((x) => x !== 0) || a.some((x, i) => x !== 0 && (j[i] === input || k[i] === input)));
    const n = Math.max(FEWEST, Math.min(MOST, Math.floor(NUMBERS / (counts.filter(Boolean).length + 1 + a.length))));
    const normal = (u, next) => Math.sqrt(-2 * Math.log(u)) * Math.cos(2 * Math.PI * next());
    return [...counts, true].map((counts, input) => {
      if (!counts) return null;
      const next = uniform(Math.imul(input + 1, 0x9e3779b1)), of = input < parts.length ? quantile(shapes[input].law) : normal;
      return Float64Array.from({ length: n }, () => of(next(), next));
    });
  };

  const valuesAt = (z, { centre, parts, pairs: { j, k, a } }, unexplained) => {
    const y = z.at(-1).map((u) => centre + Math.sqrt(unexplained ?? 0) * u);
    parts.forEach((c, input) => z[input]?.forEach((u, i) => { y[i] += moments.polynomial(c, u); }));
    a.forEach((x, p) => x !== 0 && z[j[p]].forEach((u, i) => { y[i] += x * u * z[k[p]][i]; }));
    return y;
  };

  /// The counts of a surface beside those of the study's own, which keeps its points.
  const law = (one, state, study) => {
    const z = study.points ??= drawn(one, state.shapes), then = study.values ??= valuesAt(z, study.surrogate, one.unexplained);
    const now = state === study ? then : valuesAt(z, state.surrogate, one.unexplained), n = now.length, isSame = now.every((y, i) => y === then[i]);
    return {
      shares: (limit) => {
        const low = limit - one.rounding, high = limit + one.rounding;
        let below = 0, above = 0, changed = 0;
        for (let i = 0; i < n; i++) {
          below += now[i] < low;
          above += now[i] > high;
          changed += now[i] < low !== then[i] < low || now[i] > high !== then[i] > high;
        }
        return [below / n, above / n, isSame ? 0 : ERRORS * Math.sqrt(changed + UNSEEN) / n];
      },
    };
  };

  return { law };
})();
