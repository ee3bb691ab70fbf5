// The law of a surface over independent inputs, by its transform along a contour through the saddle point: the counterpart of crates/numeric/src/law for
// sums of single inputs and quadratic forms of normal ones. crates/cli/tests/reports/html.rs holds the two together.
const surface = (() => {
  "use strict";

  /// The tilt by sigma: the least, and the largest where the domain has no end; and below which a tail is too heavy to be tilted.
  const LEAST = 1.2, MOST = 300, LEAST_TILT = 0.3;
  /// Logarithms of what neighbours of the sum may weigh, on the side of the limit and towards an end of the domain.
  const NEIGHBOUR = 28, ROOM = 60;
  const FIRST = 64, CHEAP = 16384, LAST = 2048;
  /// A term below this part of the sum ends it; two windows agree.
  const ENDED = 1e-12, AGREED = 1e-9;
  /// A law with a larger relative error of its smaller tail is not shown.
  const SHOWN = 1e-3;
  /// An end at which an unbounded input is cut weighs nothing where the logarithm of its weight is so far below the largest.
  const NOTHING = 25;

  const polynomial = ([c1, c2, c3, c4], u) => u * (c1 + u * (c2 + u * (c3 + u * c4)));
  const slope = ([c1, c2, c3, c4], u) => c1 + u * (2 * c2 + u * (3 * c3 + u * 4 * c4));

  /// A smooth step from 1 to 0.
  const step = (x) => 0.5 * (1 - Math.tanh(x * (1.1283791670955126 + 0.10089 * x * x)));

  /// Eigenvalues of a symmetric matrix by Jacobi's rotations, which turn a vector along.
  const diagonal = (n, h, b) => {
    for (let sweep = 0; sweep < 40; sweep++) {
      let off = 0, all = 0;
      for (let j = 0; j < n; j++) {
        all += h[j * n + j] ** 2;
        for (let k = j + 1; k < n; k++) off += 2 * h[j * n + k] ** 2;
      }
      if (off <= 1e-30 * (off + all)) break;
      for (let j = 0; j < n; j++) {
        for (let k = j + 1; k < n; k++) {
          const x = h[j * n + k];
          if (x === 0) continue;
          const ratio = (h[k * n + k] - h[j * n + j]) / (2 * x);
          const t = Math.sign(ratio || 1) / (Math.abs(ratio) + Math.hypot(1, ratio));
          const c = 1 / Math.hypot(1, t), s = t * c;
          for (let i = 0; i < n; i++) {
            const p = h[j * n + i], q = h[k * n + i];
            h[j * n + i] = c * p - s * q;
            h[k * n + i] = s * p + c * q;
          }
          for (let i = 0; i < n; i++) {
            const p = h[i * n + j], q = h[i * n + k];
            h[i * n + j] = c * p - s * q;
            h[i * n + k] = s * p + c * q;
          }
          [b[j], b[k]] = [c * b[j] - s * b[k], s * b[j] + c * b[k]];
        }
      }
    }
    return Array.from({ length: n }, (_, j) => h[j * n + j]);
  };

  /// What the inputs add: `straight` variance and parabolas `[a, b^2]` of normal variables, half widths of uniform ones, and all others
  /// as values with the logarithms of their weights.
  const components = ({ parts, pairs }, shapes, unexplained) => {
    const straight = { of: unexplained ?? 0 }, curved = [], halves = [], singles = [], paired = new Set();
    for (let i = 0; i < pairs.a.length; i++) if (pairs.a[i] !== 0) paired.add(pairs.j[i]).add(pairs.k[i]);
    const push = (a, b) => { if (a === 0) straight.of += b * b; else curved.push([a, b * b]); };
    const members = [...paired].sort((a, b) => a - b), n = members.length;
    if (n > 0) {
      const place = new Map(members.map((j, at) => [j, at])), h = new Float64Array(n * n);
      members.forEach((j, at) => { h[at * n + at] = parts[j][1]; });
      for (let i = 0; i < pairs.a.length; i++) {
        const j = place.get(pairs.j[i]), k = place.get(pairs.k[i]);
        if (pairs.a[i] !== 0) h[j * n + k] = h[k * n + j] = 0.5 * pairs.a[i];
      }
      const b = members.map((j) => parts[j][0]), values = diagonal(n, h, b);
      const largest = Math.max(...values.map(Math.abs));
      values.forEach((a, i) => push(Math.abs(a) > 1e-14 * largest ? a : 0, b[i]));
    }
    const range = [n > 0 || straight.of > 0 ? -Infinity : 0, n > 0 || straight.of > 0 ? Infinity : 0];
    parts.forEach((c, i) => {
      if (paired.has(i) || c.every((x) => x === 0)) return;
      const { law } = shapes[i], straightPart = c[1] === 0 && c[2] === 0 && c[3] === 0;
      if (law.normal && c[2] === 0 && c[3] === 0) {
        push(c[1], c[0]);
        range[0] = -Infinity;
        range[1] = Infinity;
        return;
      }
      const g = Float64Array.from(law.z, (z) => polynomial(c, z));
      const bounded = law.support.every((end) => end !== null);
      const ends = bounded ? law.support.map((end) => polynomial(c, end)) : [];
      range[0] += bounded ? Math.min(...ends, ...g) : -Infinity;
      range[1] += bounded ? Math.max(...ends, ...g) : Infinity;
      if (straightPart && law.halves.length > 0) {
        halves.push(...law.halves.map((half) => Math.abs(half * c[0])));
        return;
      }
      const logs = Float64Array.from(law.w, Math.log);
      singles.push({ g, logs, z: law.z, open: law.support.map((end) => end === null && law.top !== null), steepest: (live) => Math.max(...law.z.map((z, q) => live[q] ? Math.abs(slope(c, z)) : 0)), top: law.top });
    });
    return { straight: straight.of, curved, halves, singles, range };
  };

  /// Of one input of nodes under a tilt: [K, K', K''].
  const tilted = ({ g, logs }, theta) => {
    let most = -Infinity;
    for (let q = 0; q < g.length; q++) most = Math.max(most, theta * g[q] + logs[q]);
    let mass = 0, first = 0, second = 0;
    for (let q = 0; q < g.length; q++) {
      const w = Math.exp(theta * g[q] + logs[q] - most);
      mass += w;
      first += w * g[q];
      second += w * g[q] * g[q];
    }
    const mean = first / mass;
    return [most + Math.log(mass), mean, Math.max(0, second / mass - mean * mean)];
  };

  /// `log(sinh x/x)` and its first two derivatives by x.
  const hat = (x) => {
    const size = Math.abs(x);
    if (size < 0.05) {
      const q = x * x;
      return [q / 6 - q * q / 180 + q * q * q / 2835, x * (1 / 3 - q / 45 + 2 * q * q / 945), 1 / 3 - q / 15 + 2 * q * q / 189];
    }
    const small = Math.exp(-2 * size), coth = (1 + small) / (1 - small);
    return [size + Math.log1p(-small) - Math.log(2 * size), Math.sign(x) * (coth - 1 / size), 1 / (size * size) - 4 * small / (1 - small) ** 2];
  };

  const cumulants = ({ straight, curved, halves, singles }, s) => {
    let [k, k1, k2] = [0.5 * straight * s * s, straight * s, straight];
    for (const [a, b2] of curved) {
      const q = 1 - 2 * a * s;
      k += b2 * s * s / (2 * q) - 0.5 * Math.log(q);
      k1 += b2 * s * (1 - a * s) / (q * q) + a / q;
      k2 += b2 / (q * q * q) + 2 * a * a / (q * q);
    }
    for (const a of halves) {
      const [own, first, second] = hat(a * s);
      k += own;
      k1 += a * first;
      k2 += a * a * second;
    }
    for (const one of singles) {
      const [own, first, second] = tilted(one, s);
      k += own;
      k1 += first;
      k2 += second;
    }
    return [k, k1, k2];
  };

  /// Whether no end at which an unbounded input is cut weighs anything under a tilt.
  const bears = ({ singles }, theta) => singles.every(({ g, logs, z, open }) => {
    if (!open[0] && !open[1]) return true;
    let most = -Infinity;
    for (let q = 0; q < g.length; q++) most = Math.max(most, theta * g[q] + logs[q]);
    const low = Math.min(...z), high = Math.max(...z), edge = 0.03 * (high - low);
    return g.every((value, q) => theta * value + logs[q] <= most - NOTHING
      || !(open[0] && z[q] < low + edge) && !(open[1] && z[q] > high - edge));
  });

  /// One contour `s = theta + i t` with the transform by itself at theta, as far as it has been asked.
  const contourOf = (of, theta, log, spacing) => {
    const h = 2 * Math.PI / spacing, re = [], im = [];
    let farthest = Infinity;
    const turning = of.singles.map((one) => {
      let most = -Infinity;
      for (let q = 0; q < one.g.length; q++) most = Math.max(most, theta * one.g[q] + one.logs[q]);
      const live = one.g.map((g, q) => theta * g + one.logs[q] > most - 40 ? 1 : 0), kept = [];
      live.forEach((alive, q) => { if (alive) kept.push(q); });
      const [own] = tilted(one, theta), g = Float64Array.from(kept, (q) => one.g[q]);
      // Beyond, the nodes do not resolve the phase.
      if (one.top !== null) farthest = Math.min(farthest, one.top / one.steepest(live));
      return {
        x: Float64Array.from(kept, (q) => Math.exp(theta * one.g[q] + one.logs[q] - own)), y: new Float64Array(kept.length),
        c: g.map((g) => Math.cos(h * g)), s: g.map((g) => Math.sin(h * g)),
      };
    });
    const most = Math.floor(farthest / h);
    const to = (count) => {
      for (let k = re.length; k < Math.min(count, most); k++) {
        const t = h * k, sr = theta * theta - t * t, si = 2 * theta * t;
        let lr = 0.5 * of.straight * (sr - theta * theta), li = 0.5 * of.straight * si;
        for (const [a, b2] of of.curved) {
          const qr = 1 - 2 * a * theta, qi = -2 * a * t, norm = qr * qr + qi * qi, f = 0.5 * b2 / norm;
          lr += f * (sr * qr + si * qi) - 0.5 * b2 * theta * theta / qr - 0.25 * Math.log(norm / (qr * qr));
          li += f * (si * qr - sr * qi) - 0.5 * Math.atan2(qi, qr);
        }
        const size = Math.exp(lr);
        let r = size * Math.cos(li), i = size * Math.sin(li);
        for (const a of of.halves) {
          // sinh(x + iy)/(x + iy) by sinh(x)/x, over exp(x)/2.
          const x = a * Math.abs(theta), y = a * t * Math.sign(theta), small = Math.exp(-2 * x), over = (1 - small) / x;
          const p = (1 - small) * Math.cos(y), q = (1 + small) * Math.sin(y), norm = (x * x + y * y) * over;
          const hr = (p * x + q * y) / norm, hi = (q * x - p * y) / norm;
          [r, i] = [r * hr - i * hi, r * hi + i * hr];
        }
        for (const { x, y, c, s } of turning) {
          let p = 0, q = 0;
          for (let j = 0; j < x.length; j++) {
            const a = x[j], b = y[j];
            p += a;
            q += b;
            x[j] = a * c[j] - b * s[j];
            y[j] = a * s[j] + b * c[j];
          }
          [r, i] = [r * p - i * q, r * q + i * p];
        }
        re.push(r);
        im.push(i);
      }
    };
    return { theta, log, h, re, im, to };
  };

  /// `1/pi int Re[ exp(K - s y)/s ] dt`, or without 1/s the density; with its error.
  const along = (contour, y, tail, most) => {
    const { theta, log, h, re, im, to } = contour, terms = [];
    const level = Math.exp(log - theta * y) * h / Math.PI;
    let before = NaN, earlier = NaN;
    for (let count = FIRST; ; count *= 2) {
      to(count);
      for (let k = terms.length; k < Math.min(count, re.length); k++) {
        const t = h * k, c = Math.cos(t * y), s = Math.sin(t * y);
        let r = re[k] * c + im[k] * s;
        const i = im[k] * c - re[k] * s;
        if (tail) r = (r * theta + i * t) / (theta * theta + t * t) * Math.sign(theta);
        terms.push(k === 0 ? 0.5 * r : r);
      }
      const n = terms.length, sum = terms.reduce((sum, term) => sum + term, 0);
      // Sizes of the transform, for a term may pass 0.
      let left = 0;
      for (let k = n - (n >> 2); k < n; k++) left = Math.max(left, Math.hypot(re[k], im[k]) / (tail ? Math.hypot(theta, h * k) : 1));
      if (left * n < ENDED * Math.abs(sum)) return { value: level * sum, error: level * (left * n + 1e-14 * n) + 1e-11 * level * Math.abs(sum) };
      const now = terms.reduce((sum, term, k) => sum + term * step(10.4 * (k / n - 0.5)), 0), off = Math.abs(now - before);
      // Sums that meet by chance once do not do so twice.
      const apart = Math.max(off, earlier);
      if (apart < AGREED * Math.abs(now) || count >= most || n < count) {
        return { value: level * now, error: level * (Number.isNaN(apart) ? Math.abs(now) : 4 * apart + 1e-11 * Math.abs(now)) };
      }
      [before, earlier] = [now, off];
    }
  };

  /// Of a surrogate as `mathematics.relocated` makes it; null where a tail is too heavy.
  const law = (surrogate, shapes, unexplained) => {
    const of = components(surrogate, shapes, unexplained);
    const [, mean, variance] = cumulants(of, 0), sigma = Math.sqrt(variance), { centre } = surrogate;
    if (!(sigma > 0) || !bears(of, LEAST_TILT / sigma) || !bears(of, -LEAST_TILT / sigma)) return null;
    const slack = 1e-12 * (Math.abs(centre) + sigma);
    const closed = of.singles.every(({ top }) => top === null), most = closed ? CHEAP : LAST;
    const ends = [-1, 1].map((sign) => {
      let end = Math.min(Infinity, ...of.curved.filter(([a]) => sign * a > 0).map(([a]) => 0.5 / Math.abs(a)));
      if (of.singles.some(({ open }) => open[0] || open[1])) {
        let t = LEAST_TILT;
        while (t < MOST && bears(of, sign * 1.25 * t / sigma)) t *= 1.25;
        end = Math.min(end, t / sigma);
      }
      return end;
    });
    const contours = new Map();
    /// The contour of a limit, counted from the centre, on one side, good up to another one that lies farther out: the nearest of tilts in
    /// steps of a fifth.
    const contour = (sign, y, farthest = y) => {
      const end = ends[sign < 0 ? 0 : 1], least = Math.min(LEAST / sigma, 0.5 * end), largest = Math.min(0.75 * end, MOST / sigma);
      let size = least;
      while (size < largest && sign * (y - cumulants(of, sign * size)[1]) > 0) size = Math.min(1.2 * size, largest);
      const theta = sign * size, [log, , spread] = cumulants(of, theta), room = end - size;
      const needed = Math.max((NEIGHBOUR + Math.max(0, theta * farthest - log)) / size, room < Infinity ? ROOM / room : 0, 10 * Math.sqrt(spread));
      const doubled = 2 ** Math.ceil(2 * Math.log2(needed * sigma)), spacing = Math.sqrt(doubled) / sigma, key = `${theta} ${spacing}`;
      if (!contours.has(key)) contours.set(key, contourOf(of, theta, log, spacing));
      return contours.get(key);
    };
    const one = (y, sign) => {
      if (sign * (y - centre - of.range[sign < 0 ? 0 : 1]) >= -slack) return { value: 0, error: 0 };
      if (sign * (y - centre - of.range[sign < 0 ? 1 : 0]) < slack) return { value: 1, error: 0 };
      const off = y - centre, other = sign * (off - mean) < -1.5 * sigma;
      const side = other ? -sign : sign, { value, error } = along(contour(side, off), off, true, most);
      const within = Math.min(1, Math.max(0, value));
      return { value: other ? 1 - within : within, error };
    };
    return {
      tails: (y) => [one(y, -1), one(y, 1)],
      shown: (tail) => tail.error <= SHOWN * Math.min(tail.value, 1 - tail.value) || tail.error <= 1e-12,
      density: (y) => {
        if (y - centre <= of.range[0] || y - centre >= of.range[1]) return 0;
        // All places of one side share a contour, of a limit at two sigma or well within the range.
        const off = y - centre, sign = off < mean ? -1 : 1, room = sign * (of.range[sign < 0 ? 0 : 1] - mean);
        const [near, far] = [Math.min(2 * sigma, 0.5 * room), Math.min(6 * sigma, room)];
        return Math.max(0, along(contour(sign, mean + sign * near, mean + sign * far), off, false, 1024).value);
      },
      steps: of.straight === 0 && of.curved.length === 0 && of.halves.length === 0 && closed,
    };
  };

  return { law };
})();
