// The Pearson law of four moments by one engine for all types: the counterpart of crates/numeric/src/pearson, with its names and constants.
const pearson = (() => {
  "use strict";
  const { add, multiply, times, twoProduct, twoSum, value } = mathematics;

  const NOTHING = 1e-100, LARGEST = 1e100, SMALL = 1e-18, EPSILON = Number.EPSILON;
  const TERMS = 48, ENDING_TERMS = 120, REACH = 0.28, DROP = 2, BEND = 0.8;
  const CORE = -45, REST = 1e-19, PANELS = 600, STEPS = 200;

  const kindOf = (s, second, discriminant) => {
    if (second === 0) return s === 0 ? "normal" : "III";
    if (second < 0) return s === 0 ? "II" : "I";
    if (s === 0) return "VII";
    return discriminant > 0 ? "VI" : discriminant < 0 ? "IV" : "V";
  };

  const rootsOf = (s, gap, c0, first, second, discriminant) => {
    if (s === 0 && second === 0) return { none: true };
    if (discriminant < 0) return { centre: -first / (2 * second), width: Math.sqrt(-discriminant) / (2 * second) };
    if (discriminant === 0) return { at: -first / (2 * second) };
    const root = Math.sqrt(discriminant);
    if (s === 0) {
      const far = 2 * c0 / root, end = { alpha: -3 * gap / second, k: -second / root, bk: 3 * gap / root };
      return { near: -far, far, ends: [end, end] };
    }
    const q = -0.5 * (first + root), near = c0 / q, far = second === 0 ? Infinity : q / second;
    const delta = s * (3 * gap - second) / root;
    const alpha = 12 * gap * (6 * gap - second) / (discriminant * (1 + delta)), beta = -3 * gap * (1 + delta) / second;
    const k = -second / root;
    return { near, far, ends: [{ alpha, k, bk: 3 * gap * (1 + delta) / root }, { alpha: beta, k, bk: alpha * k }] };
  };

  /// `(1 + c1 z + c2 z^2) p' = -(c1 + d z) p`; null where no law has these moments.
  const shapeOf = (skewness, base, excess) => {
    const s = skewness < NOTHING ? 0 : skewness, rounded = base + excess;
    if (!Number.isFinite(s) || !Number.isFinite(rounded) || s >= Math.max(rounded, 1) || rounded > LARGEST) return null;
    const b2 = twoSum(base, excess), b1 = twoProduct(s, s);
    const gap = value(add(add(b2, [-1, 0]), times(-1, b1)));
    if (!(gap > 0)) return null;
    const c0 = add(times(4, b2), times(-3, b1)), first = times(s, add(b2, [3, 0]));
    let second = add(times(2, add(b2, [-3, 0])), times(-3, b1));
    if (Math.abs(value(second)) < NOTHING) second = [0, 0];
    const discriminant = value(add(multiply(first, first), times(-4, multiply(c0, second))));
    const [c, f, g] = [c0, first, second].map(value);
    const shape = { kind: kindOf(s, g, discriminant), c1: f / c, c2: g / c, d: 1 + 3 * (g / c) };
    return { ...shape, roots: rootsOf(s, gap, c, f, g, discriminant) };
  };

  const infinityOf = ({ c2, d, roots }) => {
    if (c2 <= 0 || roots.none) return null;
    const r = d / c2 - 2;
    if (roots.width !== undefined) return { centre: roots.centre, kappa2: roots.width * roots.width, r };
    if (roots.at !== undefined) return { centre: roots.at, kappa2: 0, r };
    const half = 0.5 / Math.abs(roots.ends[0].k);
    return { centre: roots.near - half, kappa2: -half * half, r };
  };

  // ---- the outermost piece: a series at an end of the support, or one at infinity --------------------------------------

  const seriesOf = (next) => {
    const series = [1];
    let before = 0, last = 1;
    for (let n = 1; n < ENDING_TERMS; n++) {
      const term = next(n, last, before);
      series.push(term);
      if (Math.abs(term) < SMALL && Math.abs(last) < SMALL) return series;
      [before, last] = [last, term];
    }
    return null;
  };

  const ending = (finite, origin, sign, reach, exponent, series) => {
    if (series === null) return null;
    const relative = (z) => sign * (z - origin) / reach;
    const powers = (v) => finite ? v : 1 / v;
    const sum = (x) => series.reduceRight((total, d) => total * x + d, 0);
    return {
      finite, relative,
      border: origin + sign * reach,
      covers: (z) => finite ? relative(z) <= 1 : relative(z) >= 1,
      logDensity: (v) => {
        const factor = finite ? exponent - 1 : -(exponent + 2);
        return (factor === 0 ? 0 : factor * Math.log(v)) + Math.log(sum(powers(v)));
      },
      mills: (v) => {
        const x = powers(v), first = finite ? exponent : exponent + 1;
        return reach * v * series.reduceRight((total, d, k) => total * x + d / (first + k), 0) / sum(x);
      },
      /// The mass between `v` and `to`, farther inside: each term without cancellation.
      inner: (v, to) => {
        const log = Math.log(v / to);
        return reach * series.reduce((total, d, k) => {
          const power = exponent + k;
          return total + d * to ** power * -Math.expm1(power * log) / power;
        }, 0);
      },
    };
  };

  const finiteEnding = (at, side, { alpha, k, bk }) => {
    if (!Number.isFinite(at) || !Number.isFinite(alpha) || alpha > 1e6) return null;
    const reach = Math.min(0.3 / Math.abs(k), 2 / Math.abs(bk - k));
    return ending(true, at, -side, reach, alpha, seriesOf((n, last) => last * (k * n - bk) * reach / n));
  };

  const infiniteEnding = ({ centre, kappa2, r }, side, ratio) => {
    const odd = 0.5 * r * ratio, even = Math.abs(kappa2);
    const reach = Math.max(2.5 * Math.sqrt(even), 0.5 * Math.abs(odd), Math.sqrt(0.5 * r * even));
    if (!Number.isFinite(reach) || reach === 0 || !Number.isFinite(r)) return null;
    const [o, e] = [side * odd / reach, kappa2 / reach / reach];
    return ending(false, centre, side, reach, r, seriesOf((n, last, before) => -(o * last + e * (r + n) * before) / n));
  };

  // ---- the equation, and its solution near a point ---------------------------------------------------------------------

  // Positive nodes and weights of the Gauss-Legendre rule with 16 points (Abramowitz and Stegun 1964, table 25.4).
  const LEGENDRE = [
    [0.09501250983763744, 0.1894506104550685], [0.2816035507792589, 0.18260341504492358],
    [0.45801677765722737, 0.16915651939500254], [0.6178762444026438, 0.14959598881657674],
    [0.755404408355003, 0.12462897125553388], [0.8656312023878318, 0.09515851168249279],
    [0.9445750230732326, 0.062253523938647894], [0.9894009349916499, 0.027152459411754096],
  ];

  const equationOf = ({ c1, c2, d, roots }) => {
    const factor = (root, z) => Number.isFinite(root) ? (root - z) / root : 1;
    const c = (z) => {
      if (roots.none) return 1;
      if (roots.width !== undefined) {
        const scale = Math.hypot(roots.centre, roots.width);
        return ((z - roots.centre) / scale) ** 2 + (roots.width / scale) ** 2;
      }
      return roots.at !== undefined ? factor(roots.at, z) ** 2 : factor(roots.near, z) * factor(roots.far, z);
    };
    const distance = (z) => {
      if (roots.none) return Infinity;
      if (roots.width !== undefined) return Math.hypot(z - roots.centre, roots.width);
      if (roots.at !== undefined) return Math.abs(z - roots.at);
      return Math.min(Math.abs(z - roots.near), Math.abs(z - roots.far));
    };
    const slope = (z) => Math.abs((c1 + d * z) / c(z));
    const around = (middle, half) => {
      const ratio = half / c(middle), series = new Float64Array(TERMS);
      const right = [ratio * (c1 + d * middle), ratio * half * d];
      const left = [ratio * (c1 + 2 * c2 * middle), ratio * half * c2];
      series[0] = 1;
      let before = 0, last = 1;
      for (let n = 0; n < TERMS - 1; n++) {
        const next = -((right[0] + left[0] * n) * last + (right[1] + left[1] * (n - 1)) * before) / (n + 1);
        series[n + 1] = next;
        if (Math.abs(next) < SMALL && Math.abs(last) < SMALL) return panelOf(middle, half, series, n + 1);
        [before, last] = [last, next];
      }
      return null;
    };
    const panel = (z, sign) => {
      const far = distance(z);
      let half = far === Infinity ? Infinity : REACH * far / (1 + REACH);
      half = Math.min(half, DROP / slope(z), BEND * Math.sqrt(c(z) / Math.abs(d)));
      for (;;) {
        const middle = z + sign * half;
        if (!Number.isFinite(half) || half <= 4 * EPSILON * Math.abs(middle)) return null;
        const bend = half * Math.sqrt(Math.abs(d) / c(middle));
        const found = half * slope(middle) <= DROP && bend <= BEND ? around(middle, sign * half) : null;
        if (found !== null) return found;
        half *= 0.7;
      }
    };
    /// `log p(to) - log p(from)` where p falls all the way.
    const fall = (from, to) => {
      let at = from, integral = 0;
      while (at !== to) {
        const step = 0.6 * distance(at), next = Math.abs(to - at) <= step ? to : at + Math.sign(to - at) * step;
        if (next === at) break;
        const middle = 0.5 * (at + next), half = 0.5 * (next - at), one = (x) => x / c(x);
        integral += half * LEGENDRE.reduce((sum, [x, w]) => sum + w * (one(middle - half * x) + one(middle + half * x)), 0);
        at = next;
      }
      return -Math.log(c(to) / c(from)) - (1 + c2) * integral;
    };
    return { panel, fall };
  };

  const panelOf = (middle, half, series, terms) => ({
    middle, half,
    density: (u) => {
      let sum = 0;
      for (let k = terms - 1; k >= 0; k--) sum = sum * u + series[k];
      return sum;
    },
    mass: (u) => {
      let sum = 0;
      for (let k = terms - 1; k >= 0; k--) sum = sum * u + series[k] / (k + 1);
      return Math.abs(half) * u * sum;
    },
    end: middle + half,
  });

  // ---- one side, from an anchor outwards ---------------------------------------------------------------------------------

  const millsBeyond = (equation, last, sign, from) => {
    let mass = 0, density = 1, z = from;
    for (let i = 0; i < PANELS; i++) {
      if (last !== null && last.covers(z)) return mass + density * last.mills(last.relative(z));
      if (density < REST) break;
      const panel = equation.panel(z, sign);
      if (panel === null) break;
      const inner = panel.density(-1);
      mass += density * (panel.mass(1) - panel.mass(-1)) / inner;
      density *= panel.density(1) / inner;
      z = panel.end;
    }
    return mass;
  };

  const sideOf = (equation, anchor, sign, last, limit) => {
    const panels = [], covered = (z) => last !== null && last.covers(z);
    let edge = anchor, edgeLog = 0;
    while (!covered(edge) && edgeLog > CORE && panels.length < PANELS) {
      const panel = equation.panel(edge, sign);
      if (panel === null) break;
      const middleLog = edgeLog - Math.log(panel.density(-1));
      edgeLog = middleLog + Math.log(panel.density(1));
      edge = panel.end;
      panels.push({ panel, log: middleLog });
    }
    const endingLog = covered(edge) ? edgeLog - last.logDensity(last.relative(edge)) : null;
    let mills = millsBeyond(equation, last, sign, edge);
    const edgeMass = Math.exp(edgeLog + Math.log(mills));
    for (const piece of panels.slice().reverse()) {
      const { panel } = piece;
      piece.beyond = panel.mass(1) + panel.density(1) * mills;
      mills = (piece.beyond - panel.mass(-1)) / panel.density(-1);
      piece.from = sign * (panel.middle - panel.half - anchor);
    }
    const at = (z) => {
      if (!Number.isFinite(z) || sign * (limit - z) <= 0) return { logDensity: -Infinity, mills: 0 };
      if (sign * (z - edge) < 0) {
        const from = sign * (z - anchor);
        let index = 0;
        while (index + 1 < panels.length && panels[index + 1].from <= from) index++;
        const { panel, log, beyond } = panels[index];
        const u = Math.min(1, Math.max(-1, (z - panel.middle) / panel.half)), density = panel.density(u);
        return { logDensity: log + Math.log(density), mills: (beyond - panel.mass(u)) / density };
      }
      if (endingLog !== null) {
        const v = last.relative(z);
        return { logDensity: endingLog + last.logDensity(v), mills: last.mills(v) };
      }
      const logDensity = edgeLog + equation.fall(edge, z);
      return logDensity === -Infinity ? { logDensity, mills: 0 } : { logDensity, mills: millsBeyond(equation, last, sign, z) };
    };
    /// The mass between the anchor and `z` next to an end of the support that has nearly all of it.
    const inner = (z) => {
      if (endingLog === null || !last.finite || !last.covers(z)) return null;
      const own = Math.exp(endingLog) * last.inner(Math.max(0, last.relative(z)), last.relative(edge));
      return own + Math.max(0, mills - edgeMass);
    };
    return { anchor, sign, limit, mass: mills, at, inner };
  };

  const logMass = (place) => place.mills === 0 ? -Infinity : place.logDensity + Math.log(place.mills);

  /// Where the mass beyond has this logarithm: Newton's method on it, safeguarded.
  const withMassBeyond = (side, target) => {
    if (target === -Infinity) return side.limit;
    let low = side.anchor, high = side.limit, z = side.anchor, width = 1;
    for (let i = 0; i < STEPS; i++) {
      const place = side.at(z), error = logMass(place) - target;
      if (error > 0) low = z; else high = z;
      let next = z + side.sign * error * place.mills;
      if (!(side.sign * (next - low) > 0 && side.sign * (high - next) > 0)) {
        next = Number.isFinite(high) ? 0.5 * (low + high) : z + side.sign * (width *= 2);
      }
      const step = Math.abs(next - z);
      z = next;
      if (step <= 2 * EPSILON * Math.abs(z) || step < 1e-300) break;
    }
    return z;
  };

  // ---- the law -----------------------------------------------------------------------------------------------------------

  /// With mean, sigma above 0, skewness, and kurtosis over 3; null where no law has these moments.
  const law = (mean, sigma, skewness, excess) => {
    const shape = Number.isFinite(mean) && sigma > 0 ? shapeOf(Math.abs(skewness), 3, excess) : null;
    if (shape === null) return null;
    const { roots } = shape, equation = equationOf(shape);
    let lower = -Infinity, upper = Infinity, left = null, right = null;
    if (roots.ends !== undefined) {
      lower = roots.near;
      left = finiteEnding(roots.near, -1, roots.ends[0]);
      if (roots.far > 0) {
        upper = roots.far;
        right = finiteEnding(roots.far, 1, roots.ends[1]);
      }
    } else if (roots.at !== undefined) {
      lower = roots.at;
    }
    const infinity = infinityOf(shape);
    if (infinity !== null) {
      const ratio = shape.c1 / shape.c2;
      right = infiniteEnding(infinity, 1, ratio);
      if (lower === -Infinity) left = infiniteEnding(infinity, -1, ratio);
    }
    const anchor = left !== null && left.finite && left.covers(0) ? left.border : 0;
    const sides = [sideOf(equation, anchor, -1, left, lower), sideOf(equation, anchor, 1, right, upper)];
    const total = sides[0].mass + sides[1].mass, mirrored = skewness < 0;
    const z = (x) => (mirrored ? -1 : 1) * (x - mean) / sigma, turned = ([a, b]) => mirrored ? [b, a] : [a, b];
    const sideAt = (at) => at < anchor ? 0 : 1;
    return {
      kind: shape.kind,
      density: (x) => Math.exp(sides[sideAt(z(x))].at(z(x)).logDensity - Math.log(total)) / sigma,
      /// Probabilities below and above x, each with all its digits.
      tails: (x) => {
        const at = z(x), index = sideAt(at), side = sides[index], beyond = Math.exp(logMass(side.at(at)));
        const inner = Math.max(0, side.inner(at) ?? side.mass - beyond);
        const outer = Math.min(1, beyond / total), rest = Math.min(1, (sides[1 - index].mass + inner) / total);
        return turned(index === 0 ? [outer, rest] : [rest, outer]);
      },
      /// Where the probabilities below and above are these, whose sum is 1.
      quantile: (probabilities) => {
        const [below, above] = turned(probabilities);
        const found = below * total > sides[0].mass
          ? withMassBeyond(sides[1], Math.log(above * total))
          : withMassBeyond(sides[0], Math.log(below * total));
        return mean + sigma * (mirrored ? -found : found);
      },
    };
  };

  return { law };
})();
