// The law of a surface by its characteristic function (Gil-Pelaez 1951; Davies 1973), for sums of single inputs and quadratic forms of normal
// ones. Beyond the period of the sum lies less than e^-36 of the mass, so that shares are good to 1e-14 where the function decays.
const surface = (() => {
  "use strict";

  const BEYOND = 36;
  /// Terms at first, at most, at most of a sum over nodes, and at most for a point of a density.
  const FIRST = 16, MOST = 16384, NODES = 2048, DRAWN = 1024;
  /// Size of the function at which a sum ends, and difference at which two windows agree.
  const ENDED = 1e-15, AGREED = 1e-13;

  /// A smooth step from 1 to 0, which ends a sum whose terms decay slowly.
  const step = (x) => 0.5 * (1 - Math.tanh(x * (1.1283791670955126 + 0.10089 * x * x)));

  const rotate = (of, p, q, step, count, c, s) => {
    for (let i = 0; i < count; i++, p += step, q += step) [of[p], of[q]] = [c * of[p] - s * of[q], s * of[p] + c * of[q]];
  };
  /// Eigenvalues of a symmetric matrix of n rows by Jacobi's rotations, which turn the vector b along.
  const diagonal = (n, h, b) => {
    const least = 1e-32 * h.reduce((sum, x) => sum + x * x, 0);
    for (let sweep = 0, isDone = false; sweep < 40 && !isDone; sweep++) {
      isDone = true;
      for (let j = 0; j < n; j++) for (let k = j + 1; k < n; k++) {
        const x = h[j * n + k];
        if (x * x <= least) continue;
        isDone = false;
        const ratio = (h[k * n + k] - h[j * n + j]) / (2 * x), t = (ratio < 0 ? -1 : 1) / (Math.abs(ratio) + Math.hypot(1, ratio));
        const c = 1 / Math.hypot(1, t), s = t * c;
        rotate(h, j, k, n, n, c, s);
        rotate(h, j * n, k * n, 1, n, c, s);
        rotate(b, j, k, 0, 1, c, s);
      }
    }
    return b.map((_, j) => h[j * n + j]);
  };

  /// The surface as independent terms: a normal one of this variance, `a u^2 + b u` of normal ones as `[a, b^2]`, uniform ones by their
  /// half-widths, and others as values with weights; with the ends of their sum, and the phase that the nodes resolve.
  const termsOf = ({ parts, pairs: { j, k, a } }, shapes, unexplained) => {
    const of = { variance: unexplained ?? 0, halves: [], singles: [], ends: [0, 0], top: Infinity };
    const paired = [...new Set(Array.from(a, (x, i) => x === 0 ? [] : [j[i], k[i]]).flat())], n = paired.length;
    const place = new Map(paired.map((input, at) => [input, at])), h = new Float64Array(n * n), b = paired.map((input) => parts[input][0]);
    paired.forEach((input, at) => { h[at * (n + 1)] = parts[input][1]; });
    a.forEach((x, i) => { if (x !== 0) h[place.get(j[i]) * n + place.get(k[i])] = h[place.get(k[i]) * n + place.get(j[i])] = 0.5 * x; });
    of.curved = diagonal(n, h, b).map((value, i) => [value, b[i] ** 2]);
    parts.forEach((c, i) => {
      const { law } = shapes[i], isCurved = c[2] !== 0 || c[3] !== 0;
      if (place.has(i) || c.every((x) => x === 0)) return;
      if (law.normal && !isCurved) return void of.curved.push([c[1], c[0] ** 2]);
      const isBounded = law.support.every((end) => end !== null), g = law.z.map((z) => moments.polynomial(c, z));
      const reached = isBounded ? [...g, ...law.support.map((end) => moments.polynomial(c, end))] : [-Infinity, Infinity];
      of.ends = [of.ends[0] + Math.min(...reached), of.ends[1] + Math.max(...reached)];
      if (!isCurved && c[1] === 0 && law.halves.length > 0) return void of.halves.push(...law.halves.map((half) => half * c[0]));
      of.singles.push({ g, w: law.w });
      const steepest = Math.max(...law.z.map((z) => Math.abs(c[0] + z * (2 * c[1] + z * (3 * c[2] + z * 4 * c[3])))));
      if (law.top !== null) of.top = Math.min(of.top, law.top / steepest);
    });
    if (of.variance > 0 || of.curved.length > 0) of.ends = [-Infinity, Infinity];
    return of;
  };

  /// Distance from the centre on this side beyond which there is nothing, or next to nothing by Chernoff's bound.
  const reach = ({ variance, curved, halves, singles, ends }, sign, sigma) => {
    const exponent = (theta) => {
      let sum = 0.5 * variance * theta * theta;
      for (const [a, b2] of curved) sum += 0.5 * b2 * theta * theta / (1 - 2 * a * theta) - 0.5 * Math.log(1 - 2 * a * theta);
      for (const half of halves) sum += (half * theta) ** 2 / 6;
      for (const { g, w } of singles) {
        const most = Math.max(...g.map((x) => theta * x));
        sum += most + Math.log(g.reduce((mass, x, q) => mass + w[q] * Math.exp(theta * x - most), 0));
      }
      return sum;
    };
    const slowest = Math.max(0, ...curved.map(([a]) => 2 * sign * a));
    const tilts = [0.25, 0.5, 1, 2, 4, 8, 16].map((tilt) => 1 / (sigma / tilt + slowest));
    return Math.min(sign * ends[sign < 0 ? 0 : 1], ...tilts.map((theta) => (exponent(sign * theta) + BEYOND) / theta));
  };

  /// The characteristic function at `(k + 1/2) h` for ascending k.
  const transform = function* ({ variance, curved, halves, singles }, h) {
    const turning = singles.map(({ g, w }) => {
      const [x, y] = [Math.cos, Math.sin].map((wave) => Float64Array.from(g, (g, q) => w[q] * wave(0.5 * h * g)));
      const [c, s] = [Math.cos, Math.sin].map((wave) => Float64Array.from(g, (g) => wave(h * g)));
      return { x, y, c, s };
    });
    for (let t = 0.5 * h; ; t += h) {
      let size = -0.5 * variance * t * t, angle = 0;
      for (const [a, b2] of curved) {
        const q = 2 * a * t, norm = 1 + q * q, f = 0.5 * b2 * t * t / norm;
        size -= f + 0.25 * Math.log(norm);
        angle += 0.5 * Math.atan(q) - f * q;
      }
      const uniform = halves.reduce((product, half) => product * Math.sin(half * t) / (half * t), Math.exp(size));
      let value = [uniform * Math.cos(angle), uniform * Math.sin(angle)];
      for (const { x, y, c, s } of turning) {
        let p = 0, q = 0;
        for (let m = 0; m < x.length; m++) {
          const a = x[m], b = y[m];
          p += a;
          q += b;
          x[m] = a * c[m] - b * s[m];
          y[m] = a * s[m] + b * c[m];
        }
        value = [value[0] * p - value[1] * q, value[0] * q + value[1] * p];
      }
      yield value;
    }
  };

  /// Of a surrogate with this sigma: shares below and above a value with their error, and the density.
  const law = (surrogate, shapes, unexplained, sigma) => {
    const of = termsOf(surrogate, shapes, unexplained), [low, high] = [-1, 1].map((sign) => reach(of, sign, sigma));
    const h = 2 * Math.PI / (low + high), most = Math.min(of.top / h, of.singles.length > 0 ? NODES : MOST), next = transform(of, h), known = [];
    /// The sum of the imaginary parts of `phi exp(-i t y)/(pi (k + 1/2))`, or of the real parts of `h phi exp(-i t y)/pi`, with its error.
    const along = (y, isShare, longest) => {
      for (let count = FIRST, before = Infinity, earlier = Infinity; ; count *= 2) {
        while (known.length < Math.min(count, most)) known.push(next.next().value);
        const n = Math.min(count, known.length);
        let sum = 0, faded = 0, left = 0;
        for (let k = 0; k < n; k++) {
          const t = (k + 0.5) * h, c = Math.cos(t * y), s = Math.sin(t * y), [re, im] = known[k];
          const term = (isShare ? (im * c - re * s) / (k + 0.5) : h * (re * c + im * s)) / Math.PI;
          sum += term;
          faded += term * step(10.4 * ((k + 0.5) / n - 0.5));
          if (4 * k > 3 * n) left = Math.max(left, Math.abs(re) + Math.abs(im));
        }
        if (left < ENDED) return [sum, 1e-14];
        // Sums that meet by chance once do not do so twice.
        const off = Math.abs(faded - before), apart = Math.max(off, earlier);
        if (apart < AGREED || n < count || count >= longest) return [faded, 4 * apart + 1e-14];
        [before, earlier] = [faded, off];
      }
    };
    return {
      shares: (y) => {
        const off = y - surrogate.centre, slack = 1e-12 * (Math.abs(surrogate.centre) + sigma);
        if (off <= slack - low || off >= high - slack) return off < 0 ? [0, 1, 0] : [1, 0, 0];
        const [value, error] = along(off, true, most), within = (x) => Math.min(1, Math.max(0, x));
        return [within(0.5 - value), within(0.5 + value), error];
      },
      density: (y) => y <= surrogate.centre - low || y >= surrogate.centre + high ? 0 : Math.max(0, along(y - surrogate.centre, false, DRAWN)[0]),
    };
  };

  return { law };
})();
