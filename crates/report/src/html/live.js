// What changed tolerances and means come to, from the surrogate in the page.
const live = (() => {
  "use strict";

  /// Shifts and stretches of all dimensions for these settings: the factor of the tolerance, and how far the mean moves.
  const moved = (data, settings) => {
    const shifts = new Float64Array(data.dimensions.length), stretches = new Float64Array(data.dimensions.length).fill(1);
    data.dimensions.forEach((of, i) => {
      const { factor, shift } = settings[i];
      // The middle of a band stays; the mean of a skewed law over it moves as the band scales, and what a normal law is off the
      // middle stays.
      const scaling = of.normal ? 0 : of.offset;
      shifts[i] = ((factor - 1) * scaling + shift) / of.sigma;
      stretches[i] = factor;
    });
    return { shifts, stretches };
  };

  const limited = (one, mean, sigma, tails) => {
    const { lower, upper, target } = one, known = (x) => x !== null;
    if (!known(lower) && !known(upper)) return { below: null, above: null, rejected: null, yield: null, cp: null, cpk: null, met: null };
    const below = known(lower) ? tails(lower)[0] : null, above = known(upper) ? tails(upper)[1] : null;
    const rejected = Math.min(1, (below ?? 0) + (above ?? 0));
    const sides = [known(lower) ? mean - lower : Infinity, known(upper) ? upper - mean : Infinity];
    return {
      below, above, rejected,
      yield: 1 - rejected,
      cp: known(lower) && known(upper) && sigma > 0 ? (upper - lower) / (6 * sigma) : null,
      cpk: sigma > 0 ? Math.min(...sides) / (3 * sigma) : null,
      met: target === null ? null : rejected <= 1 - target,
    };
  };

  /// One characteristic at these settings.
  const evaluate = (data, one, settings) => {
    const { shifts, stretches } = moved(data, settings);
    const shapes = data.dimensions.map((of) => data.shapes[of.shape]);
    const surrogate = mathematics.relocated(one, shifts, stretches);
    let found = mathematics.moments(surrogate, shapes);
    if (one.unexplained !== null) found = mathematics.beside(found, one.unexplained);
    const { mean, sigma, skewness, excess } = found;
    const shares = new Float64Array(surrogate.pairs.a.length);
    for (let i = 0; i < shares.length; i++) shares[i] = (surrogate.pairs.a[i] * found.perSigma) ** 2;
    const fit = skewness === null ? null : pearson.law(mean, sigma, skewness, excess);
    const none = { below: null, above: null, rejected: null, yield: null, cp: null, cpk: null, met: null };
    const of_fit = fit === null ? none : limited(one, mean, sigma, fit.tails);
    // Everything is in units of the scale.
    const scale = one.scale ?? 1;
    const here = { ...found, scale, kurtosis: excess === null ? null : 3 + excess, shares, fit, pearson: of_fit.yield };
    if (sigma === 0) {
      return { ...here, law: null, by: "surface", error: 0, ...limited(one, mean, sigma, (x) => [mean < x - one.rounding ? 1 : 0, mean > x + one.rounding ? 1 : 0]) };
    }
    // The law of the surface where the page can compute it; elsewhere the engine's with what points of the surface say of changes, and last
    // the Pearson fit, and the page says so.
    const law = one.law ? surface.law(surrogate, shapes, one.unexplained) : null;
    if (law !== null && !law.steps) {
      const tails = new Map([one.lower, one.upper].filter((limit) => limit !== null).map((limit) => [limit, law.tails(limit)]));
      if ([...tails.values()].flat().every(law.shown)) {
        const kept = limited(one, mean, sigma, (x) => tails.get(x).map((tail) => tail.value));
        const error = Math.hypot(one.lower === null ? 0 : tails.get(one.lower)[0].error, one.upper === null ? 0 : tails.get(one.upper)[1].error);
        return { ...here, law, by: "surface", error, ...kept };
      }
    }
    if (one.counted !== null) {
      const still = new Float64Array(shifts.length), unchanged = mathematics.relocated(one, still, new Float64Array(still.length).fill(1));
      const [below, above] = counting.shares(one, unchanged, surrogate, shapes);
      const kept = limited(one, mean, sigma, () => [below.value, above.value]);
      const error = Math.hypot(one.lower === null ? 0 : below.error, one.upper === null ? 0 : above.error);
      return { ...here, law: fit, by: "points", error, ...kept };
    }
    return { ...here, law: fit, by: "pearson", error: null, ...of_fit };
  };

  /// What these settings cost, by the cheapest process that holds the tightest member of each group, as the engine counts it
  /// (Priced::cost_to_hold); no finite number where no process does.
  const cost = (data, settings) => mathematics.exact(data.costs.map(({ members, others, parts, offers }) => {
    const t = Math.min(others ?? Infinity, ...members.map((i) => settings[i].factor * data.dimensions[i].half));
    const alone = offers.length === 1;
    const along = (points, held) => {
      const next = points.findIndex(([known]) => known >= held);
      // Of points nothing is known beyond them.
      if (next < 0 || held < points[0][0]) return Infinity;
      const [[low, dear], [high, cheap]] = [points[Math.max(next - 1, 0)], points[next]];
      return low === high ? cheap : cheap + (dear - cheap) * (1 / held - 1 / high) / (1 / low - 1 / high);
    };
    const at = ({ exponential, a, b, shape, points, max }) => {
      const held = alone ? t : Math.min(t, max);
      if (points) return parts * along(points, held);
      return parts * (b === 0 ? a : a + b * (exponential ? Math.exp(-held / shape) : held ** -shape));
    };
    const holds = ({ min, max }) => alone && min < max || min <= t * (1 + 1e-12);
    // What nothing holds makes the sum no number.
    return Math.min(...offers.filter(holds).map(at), Infinity);
  }));

  const KEY = /^[A-Za-z0-9_-]+$/;
  const quoted = (text) => JSON.stringify(text).replace(/\u007f/g, "\\u007f");
  const key = (name) => KEY.test(name) ? name : quoted(name);
  const number = (x) => Number.isInteger(x) && Math.abs(x) < 1e15 ? x.toFixed(1) : String(x);

  /// The keys of a dimension whose tolerance or mean has changed.
  const changed = (of, keys, { factor, shift }) => {
    const dropped = new Set(["tolerance", "limits", "fit", "sigma", "sigmas", "cp", "cpk", "side", "shift"]);
    const band = of.normal || of.band === null ? 0 : shift;
    const kept = keys.filter(([name]) => !dropped.has(name)), given = new Map(keys);
    const lines = kept.map(([name, text]) => {
      // A mode is a value of the dimension, and moves with the band.
      const mode = name === "distribution" && /\bmode = ([^,} ]+)/.exec(text);
      if (!mode) return [name, text];
      const middle = of.nominal + of.middle;
      return [name, text.replace(/\bmode = [^,} ]+/, `mode = ${number(middle + factor * (Number(mode[1]) - middle) + shift)}`)];
    });
    if (of.band !== null) {
      const [lower, upper] = of.band.map((end) => of.middle + factor * (end - of.middle) + band);
      lines.push(["tolerance", lower === -upper ? number(upper) : `[${number(lower)}, ${number(upper)}]`]);
    }
    if (of.normal) {
      lines.push(["sigma", number(factor * of.sigma)]);
      const off = of.offset + shift;
      if (off !== 0) lines.push(["shift", number(off)]);
    } else {
      for (const name of ["sigmas", "cp", "cpk"]) if (given.has(name)) lines.push([name, given.get(name)]);
    }
    return lines;
  };

  /// The section `[dimensions]` with what these settings change.
  const toml = (data, settings) => {
    const at = new Map(data.dimensions.map((of, i) => [of.name, i]));
    const lines = data.lines.map(([name, keys]) => {
      const i = at.get(name), set = i === undefined ? null : settings[i];
      const same = set === null || (set.factor === 1 && set.shift === 0);
      const written = same ? keys : changed(data.dimensions[i], keys, set);
      return `${key(name)} = { ${written.map(([k, text]) => `${key(k)} = ${text}`).join(", ")} }`;
    });
    return `[dimensions]\n${lines.join("\n")}\n`;
  };

  return { cost, evaluate, toml };
})();
