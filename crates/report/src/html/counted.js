// The law of a surface counted at points, where the page has no contour for it: products of inputs that are not normal. What other settings
// change is counted at the same points before and after, and added to the engine's own shares; unchanged settings then give those.
const counting = (() => {
  "use strict";

  /// Points at most and at least, and numbers that all of them take.
  const MOST = 1 << 16, FEWEST = 1 << 10, NUMBERS = 1 << 20;
  /// Standard errors that bound an error, three for the points and one for the lines between nodes, and points that a count has been off at
  /// least.
  const ERRORS = 4, UNSEEN = 3;

  /// Uniform numbers below 1, the same on every page (Steele, Lea and Flood 2014, with 32 bits).
  const uniform = (seed) => () => {
    seed = (seed + 0x9e3779b9) >>> 0;
    let x = seed;
    x = Math.imul(x ^ (x >>> 16), 0x21f0aaad);
    x = Math.imul(x ^ (x >>> 15), 0x735a2d97);
    return ((x ^ (x >>> 15)) >>> 0) / 4294967296 + 1.1641532182693481e-10;
  };

  /// The value of a standardised input below which this share lies, by its nodes: half the weight of a node lies on either side of it.
  const quantile = ({ z, w, support, top }) => {
    const order = [...z.keys()].sort((a, b) => z[a] - z[b]), places = order.map((q) => z[q]), shares = [];
    let sum = 0;
    for (const q of order) {
      shares.push(top === null ? sum + w[q] : sum + 0.5 * w[q]);
      sum += w[q];
    }
    const ends = [support[0] ?? places[0], support[1] ?? places[places.length - 1]];
    return (u) => {
      const p = u * sum;
      let low = 0, high = shares.length;
      while (low < high) {
        const middle = (low + high) >> 1;
        if (shares[middle] < p) low = middle + 1;
        else high = middle;
      }
      // Every value has a share of its own.
      if (top === null) return places[Math.min(low, places.length - 1)];
      const [before, from] = low > 0 ? [shares[low - 1], places[low - 1]] : [0, ends[0]];
      const [after, to] = low < shares.length ? [shares[low], places[low]] : [sum, ends[1]];
      return after > before ? from + (to - from) * (p - before) / (after - before) : from;
    };
  };

  /// The points of one characteristic: only inputs that count take numbers.
  const drawn = ({ parts, pairs }, shapes) => {
    const counts = parts.map((c, j) => c.some((x) => x !== 0) || pairs.a.some((a, i) => a !== 0 && (pairs.j[i] === j || pairs.k[i] === j)));
    const inputs = counts.filter((own) => own).length + 1;
    const n = Math.max(FEWEST, Math.min(MOST, Math.floor(NUMBERS / (inputs + pairs.a.length))));
    const tables = new Map(), z = parts.map((_, j) => {
      if (!counts[j]) return null;
      if (!tables.has(shapes[j])) tables.set(shapes[j], quantile(shapes[j].law));
      const next = uniform(0x51ed270b ^ Math.imul(j + 1, 0x9e3779b1)), of = tables.get(shapes[j]);
      return Float64Array.from({ length: n }, () => of(next()));
    });
    const next = uniform(0x7f4a7c15);
    const beside = Float64Array.from({ length: n }, () => Math.sqrt(-2 * Math.log(next())) * Math.cos(2 * Math.PI * next()));
    return { n, z, beside };
  };

  /// On which side of the limits each point lies: -1, 0 or 1.
  const sides = ({ n, z, beside }, { centre, parts, pairs }, { lower, upper, rounding, unexplained }) => {
    const y = new Float64Array(n).fill(centre);
    parts.forEach(([c1, c2, c3, c4], j) => {
      if (z[j] === null) return;
      for (let i = 0; i < n; i++) {
        const u = z[j][i];
        y[i] += u * (c1 + u * (c2 + u * (c3 + u * c4)));
      }
    });
    pairs.a.forEach((a, p) => {
      if (a === 0) return;
      const one = z[pairs.j[p]], other = z[pairs.k[p]];
      for (let i = 0; i < n; i++) y[i] += a * one[i] * other[i];
    });
    if (unexplained !== null) for (let i = 0; i < n; i++) y[i] += Math.sqrt(unexplained) * beside[i];
    return Int8Array.from(y, (y) => lower !== null && y < lower - rounding ? -1 : upper !== null && y > upper + rounding ? 1 : 0);
  };

  /// What the engine's settings gave, by characteristic: its points, and the side of each.
  const known = new WeakMap();

  /// Shares below and above the limits with their error, of a characteristic whose surface has become this one.
  const shares = (one, unchanged, surrogate, shapes) => {
    if (!known.has(one)) {
      const points = drawn(unchanged, shapes);
      known.set(one, { points, then: sides(points, unchanged, one) });
    }
    const { points, then } = known.get(one), now = sides(points, surrogate, one);
    const moved = [0, 0], changed = [0, 0];
    for (let i = 0; i < points.n; i++) {
      if (now[i] === then[i]) continue;
      [-1, 1].forEach((side, at) => {
        const by = (now[i] === side) - (then[i] === side);
        moved[at] += by;
        changed[at] += Math.abs(by);
      });
    }
    const same = surrogate === unchanged || unchanged.centre === surrogate.centre && changed[0] + changed[1] === 0
      && unchanged.parts.every((part, j) => part.every((c, k) => c === surrogate.parts[j][k]));
    const value = (at) => Math.min(1, Math.max(0, (one.counted[at] ?? 0) + moved[at] / points.n));
    const error = (at) => same ? 0 : ERRORS * Math.sqrt(changed[at] + UNSEEN) / points.n;
    return [0, 1].map((at) => ({ value: value(at), error: error(at) }));
  };

  return { shares };
})();
