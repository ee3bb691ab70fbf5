// What changed tolerances and means come to, from the surrogate in the page.
const live = (() => {
  "use strict";

  const isUnchanged = ({ factor, shift }) => factor === 1 && shift === 0;

  /// The law of a characteristic by each source, best first; null where a source has none.
  const SOURCES = {
    surface: (one, { surrogate, shapes, mean, sigma }) => sigma === 0
      ? { shares: (y) => [mean < y - one.rounding, mean > y + one.rounding, 0].map(Number) }
      : one.law ? surface.law(surrogate, shapes, one.unexplained, sigma) : null,
    points: (one, state, study) => one.counted ? { ...points.law(one, state, study), density: state.fit?.density } : null,
    pearson: (_, { fit }) => fit,
  };
  /// Largest error of a share by a transform. Beyond it the nodes of an input resolve too little of it.
  const LARGEST = 1e-3;

  /// The shares beyond the limits by a source; null where it has none.
  const sharesBy = (source, one, state, study) => {
    const law = SOURCES[source](one, state, study), of = ([below, above, error], side) => ({ value: [below, above][side], error });
    const shares = law && one.limits.map((y, side) => y === null ? null : of(law.shares(y), side));
    return shares?.every((share) => share === null || source !== "surface" || share.error <= LARGEST) ? { law, shares } : null;
  };

  /// The surface of a characteristic at these settings, its moments and their Pearson fit. The middle of a band stays. The mean of a skewed
  /// law moves as the band scales, and what a normal law is off the middle stays.
  const surfaceAt = ({ dimensions, shapes }, one, settings) => {
    const shifts = dimensions.map((of, i) => ((settings[i].factor - 1) * (of.normal ? 0 : of.offset) + settings[i].shift) / of.sigma);
    const surrogate = moments.relocated(one, shifts, settings.map(({ factor }) => factor)), inputs = dimensions.map((of) => shapes[of.shape]);
    const found = moments.of(surrogate, inputs, one.unexplained);
    const fit = found.skewness === null ? null : pearson(found.mean, found.sigma, found.skewness, found.excess);
    return { surrogate, shapes: inputs, fit, by: {}, ...found };
  };

  /// Rejects of a side: the report's own, changed as the shares of one source change. Where fewer are rejected, the difference of report
  /// and source shrinks with them.
  const rejectsOf = (own, now, then) => {
    if (own === null || then === null) return now && { ...now, low: null, high: null };
    const off = (own.value - then.value) * (now.value < then.value ? now.value / then.value : 1), error = now.error + then.error;
    const value = Math.min(1, Math.max(0, now.value + off)), end = (known, sign) => known === null ? null : known + value - own.value + sign * error;
    return { value, error, low: end(own.low, -1), high: end(own.high, 1) };
  };

  /// One characteristic at these settings. Its intervals reach as far as those of the report and the error of the change.
  const studies = new WeakMap();
  const evaluate = (data, one, settings) => {
    const same = settings.every(isUnchanged);
    if (!studies.has(one)) studies.set(one, surfaceAt(data, one, settings.map(() => ({ factor: 1, shift: 0 }))));
    const study = studies.get(one), found = same ? study : surfaceAt(data, one, settings);
    const known = (state, source) => state.by[source] ??= sharesBy(source, one, state, study), none = { law: null, shares: [null, null] };
    const by = Object.keys(SOURCES).find((source) => known(found, source) !== null);
    const { law, shares } = found.by[by] ?? none, then = (by && known(study, by)) ?? none;
    const rejects = one.rejects.map((own, side) => same && own ? { ...own, error: 0 } : rejectsOf(own, shares[side], then.shares[side]));
    const sum = (sides, of) => sides.reduce((sum, side) => sum + (side?.[of] ?? 0), 0), error = sum(rejects, "error");
    const rejected = rejects.every((side) => side === null) ? null : Math.min(1, sum(rejects, "value"));
    const isTied = one.interval !== null && rejects.every((side) => side === null || side.low !== null);
    const [lower, upper] = one.limits, room = Math.min(found.mean - (lower ?? -Infinity), (upper ?? Infinity) - found.mean);
    return {
      ...found, by, law, shares, same, rejects, rejected, error,
      interval: isTied ? one.interval.map((end, at) => end + sum(one.rejects, "value") - rejected + (at === 0 ? -error : error)) : null,
      cpk: found.sigma > 0 && room < Infinity ? room / (3 * found.sigma) : null,
    };
  };

  /// What these settings cost, by the cheapest process that holds the tightest member of each group, as the engine counts it
  /// (Priced::cost_to_hold); no finite number where no process does.
  const cost = (data, settings) => data.costs.map(({ members, shares, others, parts, offers }) => {
    const t = Math.min(others ?? Infinity, ...members.map((i, k) => settings[i].factor * data.dimensions[i].half / (shares?.[k] ?? 1)));
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
      return parts * (points ? along(points, held) : b === 0 ? a : a + b * (exponential ? Math.exp(-held / shape) : held ** -shape));
    };
    const holds = ({ min, max }) => alone && min < max || min <= t * (1 + 1e-12);
    // What nothing holds makes the sum no number.
    return Math.min(...offers.filter(holds).map(at), Infinity);
  }).reduce((sum, one) => sum + one, 0);

  const key = (name) => /^[A-Za-z0-9_-]+$/.test(name) ? name : JSON.stringify(name).replace(/\u007f/g, "\\u007f");
  const number = (x) => Number.isInteger(x) && Math.abs(x) < 1e15 ? x.toFixed(1) : String(x);

  /// The keys of a dimension whose tolerance or mean has changed.
  const changed = (of, keys, { factor, shift }) => {
    const dropped = new Set(["tolerance", "limits", "fit", "sigma", "sigmas", "cp", "cpk", "side", "shift"]);
    const band = of.normal || of.band === null ? 0 : shift;
    // A mode is a value of the dimension, and moves with the band.
    const middle = of.nominal + of.middle, mode = (_, at) => `mode = ${number(middle + factor * (Number(at) - middle) + shift)}`;
    const lines = keys.filter(([name]) => !dropped.has(name))
      .map(([name, text]) => [name, name === "distribution" ? text.replace(/\bmode = ([^,} ]+)/, mode) : text]);
    if (of.band !== null) {
      const [lower, upper] = of.band.map((end) => of.middle + factor * (end - of.middle) + band);
      lines.push(["tolerance", lower === -upper ? number(upper) : `[${number(lower)}, ${number(upper)}]`]);
    }
    if (of.normal) {
      lines.push(["sigma", number(factor * of.sigma)]);
      if (of.offset + shift !== 0) lines.push(["shift", number(of.offset + shift)]);
    } else {
      lines.push(...keys.filter(([name]) => ["sigmas", "cp", "cpk"].includes(name)));
    }
    return lines;
  };

  /// The section `[dimensions]` with what these settings change.
  const toml = (data, settings) => {
    const lines = data.lines.map(([name, keys]) => {
      const i = data.dimensions.findIndex((of) => of.name === name);
      const written = i < 0 || isUnchanged(settings[i]) ? keys : changed(data.dimensions[i], keys, settings[i]);
      return `${key(name)} = { ${written.map(([k, text]) => `${key(k)} = ${text}`).join(", ")} }`;
    });
    return `[dimensions]\n${lines.join("\n")}\n`;
  };

  return { cost, evaluate, toml };
})();
