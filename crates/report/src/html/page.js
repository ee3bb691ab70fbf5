// The what-if of the page: sliders and number boxes in, results out.
(() => {
  "use strict";
  const data = JSON.parse(document.getElementById("data").textContent), panel = document.getElementById("what-if");
  const settings = data.dimensions.map(() => ({ factor: 1, shift: 0 }));
  const tried = data.characteristics.flatMap((one, index) => one.why === null ? [{ one, index, card: panel.querySelector(`[data-kc="${index}"]`) }] : []);
  const rows = data.dimensions.map((_, i) => panel.querySelector(`[data-dimension="${i}"]`));
  const before = tried.map(({ one }) => live.evaluate(data, one, settings)), paid = live.cost(data, settings);
  let results = before;

  // Numbers as the report has them: document/number.rs and document/rejects.rs.
  const magnitude = (x) => Math.floor(Math.log10(Math.abs(x))), within = (x, least, most) => Math.min(most, Math.max(least, x));
  const significant = (x, digits) => {
    const size = magnitude(x.toPrecision(digits));
    if (x === 0) return "0";
    return size < -4 || size > 8 ? String(Number(x.toPrecision(digits)).toExponential()) : x.toFixed(Math.max(0, digits - 1 - size));
  };
  /// With so many decimals at most, and down to the second digit of the error.
  const carried = (x, most, error) => x.toFixed(within(error > 0 ? 1 - magnitude(error) : most, 0, most)).replace(/^-(0\.?0*)$/, "$1");
  const beside = (x, sigma, error) => {
    // Six digits, but at least three and at most five of sigma, as in the report.
    const decimals = sigma > 0 ? within(5 - magnitude(x), 2 - magnitude(sigma), 4 - magnitude(sigma)) : 6;
    return decimals > 9 || Math.abs(x) > 1e9 ? significant(x, 8) : carried(x, Math.max(0, decimals), error);
  };
  // The last digit of yields and rejects is the first one of the standard error, and what an interval does not tell from none is a bound. No law
  // is known beyond one part in 10^9.
  const FEWEST = 1e-9;
  const upwards = (x, unit) => Math.ceil(x / unit - 1e-9) * unit, twoDigits = (x) => upwards(x, 10 ** (magnitude(x) - 1));
  const ppm = ({ value, low, high, error }) => {
    const [from, to] = low === null ? [value - error, value + error] : [low, high], isFew = value > 0 && value < FEWEST;
    if (isFew || value < 0.5 * (to - from)) return `< ${significant(twoDigits(1e6 * within(to, FEWEST, 1)), 2)}`;
    const digits = to > from ? within(magnitude(value) - magnitude(0.25 * (to - from)) + 1, 1, 4) : 4;
    return significant(digits < 4 ? Number((1e6 * value).toPrecision(digits)) : 1e6 * value, digits);
  };
  const share = (rejected, reach = 0) => {
    const decimals = (x) => within(-magnitude(x), 0, 12), most = 100 * twoDigits(Math.max(FEWEST, rejected + reach));
    if (rejected > 0 && rejected < FEWEST || rejected < reach) {
      return most < 100 ? `> ${(100 - upwards(most, 10 ** -decimals(most))).toFixed(decimals(most))} %` : "unknown";
    }
    const digits = rejected > 0 ? within(2 - magnitude(100 * rejected), 2, 12) : 0;
    return `${(100 - 100 * rejected).toFixed(reach > 0 ? Math.min(digits, decimals(50 * reach)) : digits).replace(/^(100|0)\.0*$/, "$1")} %`;
  };
  const figures = ({ scale = 1, errors }, found) => {
    const [mean, sigma] = [found.mean, found.sigma].map((x) => scale * x), or = (x, text) => x === null ? "-" : text(x);
    return {
      mean: beside(mean, sigma, errors[0]),
      sigma: beside(sigma, sigma, errors[1]),
      skewness: or(found.skewness, (x) => carried(x, 4, errors[2])),
      kurtosis: or(found.excess, (x) => carried(3 + x, 4, errors[3])),
      yield: or(found.rejected, (x) => share(x, found.interval === null ? found.error : 1 - x - found.interval[0])),
      "ppm below": or(found.rejects[0], ppm),
      "ppm above": or(found.rejects[1], ppm),
      Cpk: or(found.cpk, (x) => x.toFixed(3)),
    };
  };
  // The counterpart of the module `verdict`, with its rounding of a target.
  const judged = ({ interval, rejected }, { target }) => {
    if (target === null || rejected === null) return "";
    const least = target - 1e-8 * (1 - target);
    return interval === null || interval[0] < least && interval[1] >= least ? "inconclusive" : interval[0] >= least ? "target met" : "target missed";
  };
  const source = ({ by, same, fit, rejected, shares }, one) => {
    if (rejected === null) return "";
    const sum = (sides) => sides.reduce((sum, side) => sum + (side ?? 0), 0), own = sum(shares.map((side) => side?.value));
    const fitted = by === "surface" && fit !== null ? sum(one.limits.map((y, side) => y === null ? 0 : fit.shares(y)[side])) : own;
    const how = {
      surface: "the surface law", points: "points of the surface",
      pearson: `the Pearson fit: ${one.law ? "the surface law is not accurate enough here" : one.why_fit}`,
    }[by];
    const changes = same || one.source === how ? `by ${one.source ?? how}` : one.source === null ? `by ${how}` : `by ${one.source}; changes by ${how}`;
    return changes + (Math.abs(fitted - own) > Math.max(FEWEST, 0.01 * Math.max(fitted, own)) ? `; Pearson fit ${share(fitted)}` : "");
  };

  const POINTS = 160, WIDTH = 640, BASE = 198, TOP = 6;
  const draw = (card, { limits }, old, now) => {
    const ends = [old, now].filter((of) => of.law?.density).flatMap((of) => [of.mean - 5 * of.sigma, of.mean + 5 * of.sigma]);
    const near = limits.filter((limit) => limit !== null && Math.abs(limit - old.mean) < 12 * old.sigma);
    const from = Math.min(...ends, ...near), to = Math.max(...ends, ...near);
    if (!(from < to)) return;
    // The Pearson fit as a thin line beside a better law.
    const densities = { before: old.law?.density, now: now.law?.density, fit: now.by === "surface" ? now.fit?.density : undefined };
    const line = (density) => Array.from({ length: density ? POINTS + 1 : 0 }, (_, i) => density(from + (to - from) * i / POINTS));
    const lines = Object.entries(densities).map(([name, density]) => [name, line(density)]);
    // A density that is infinite at its end is cut.
    const heights = lines.flatMap(([name, line]) => name === "fit" ? [] : line).filter(Number.isFinite);
    const most = Math.min(Math.max(...heights), 4 / Math.min(old.sigma || Infinity, now.sigma || Infinity));
    const point = (y, i) => `${i === 0 ? "M" : "L"}${(i * WIDTH / POINTS).toFixed(1)} ${(BASE - (BASE - TOP) * Math.min(1, y / most)).toFixed(1)}`;
    for (const [name, line] of lines) card.querySelector(`.${name}`).setAttribute("d", line.map(point).join(""));
    ["lower", "upper"].forEach((side, i) => {
      const x = limits[i] === null ? NaN : WIDTH * (limits[i] - from) / (to - from);
      card.querySelector(`[data-limit="${side}"]`).setAttribute("d", x >= 0 && x <= WIDTH ? `M${x.toFixed(1)} 0V200` : "");
    });
  };

  // The parts that dimensions have in the variance: straight line, curvature, half of each interaction.
  const select = document.getElementById("share-of");
  const shares = () => {
    const place = Math.max(0, tried.findIndex(({ index }) => String(index) === select.value)), { pairs } = tried[place].one, found = results[place];
    const half = new Float64Array(data.dimensions.length);
    found.interactions.forEach((of, i) => {
      half[pairs.j[i]] += 0.5 * of;
      half[pairs.k[i]] += 0.5 * of;
    });
    rows.forEach((row, i) => {
      let x = 0;
      [found.linear[i], found.curvature[i], half[i]].forEach((part, k) => {
        const rect = row.querySelectorAll(".bar rect")[k];
        rect.setAttribute("x", x.toFixed(2));
        rect.setAttribute("width", (100 * part).toFixed(2));
        x += 100 * part;
      });
      row.querySelector("[data-share]").textContent = `${x.toFixed(2)} %`;
    });
  };

  const show = () => {
    tried.forEach(({ one, card, index }, i) => {
      const then = figures(one, before[i]), verdict = judged(results[i], one), badge = card.querySelector('[data-figure="verdict"]');
      for (const [name, text] of Object.entries(figures(one, results[i]))) {
        const cell = card.querySelector(`[data-figure="${name}"]`);
        cell.textContent = text;
        cell.classList.toggle("changed", text !== then[name]);
        card.querySelector(`[data-before="${name}"]`).textContent = then[name];
      }
      card.querySelector("[data-by]").textContent = source(results[i], one);
      badge.textContent = verdict;
      // One line of the figures that matter, which stays on the screen.
      const line = panel.querySelector(`[data-line="${index}"] span`), shown = figures(one, results[i]);
      const names = shown.yield === "-" ? ["mean", "sigma"] : shown.Cpk === "-" ? ["yield"] : ["yield", "Cpk"];
      const told = (name) => `${name === "yield" ? "" : `${name} `}${then[name] === shown[name] ? shown[name] : `${then[name]} → ${shown[name]}`}`;
      line.textContent = names.map(told).join(", ");
      line.classList.toggle("changed", names.some((name) => then[name] !== shown[name]));
      for (const [name, word] of [["good", "target met"], ["bad", "target missed"], ["unsure", "inconclusive"]]) badge.classList.toggle(name, verdict === word);
      draw(card, one, before[i], results[i]);
    });
    shares();
    const total = document.getElementById("cost"), text = document.getElementById("toml");
    if (total !== null) {
      const now = live.cost(data, settings), change = 100 * (now / paid - 1);
      total.textContent = !Number.isFinite(now) ? "no process holds these tolerances"
        : !Number.isFinite(paid) || Math.abs(change) < 0.005 ? significant(now, 6)
        : `${significant(now, 6)} (${Math.abs(change).toFixed(2)} % ${change < 0 ? "less" : "more"})`;
      total.classList.toggle("changed", now !== paid);
    }
    panel.classList.toggle("touched", results.some(({ same }) => !same));
    if (text !== null) text.value = live.toml(data, settings);
  };

  let isWaiting = false;
  const update = () => {
    isWaiting = false;
    results = tried.map(({ one }) => live.evaluate(data, one, settings));
    show();
  };
  const fill = (i, except) => {
    const { half } = data.dimensions[i], { factor, shift } = settings[i];
    const texts = {
      "set=factor": Math.round(100 * factor), "number=factor": factor * half,
      "set=shift": Math.round(100 * shift / half), "number=shift": shift,
    };
    for (const [name, value] of Object.entries(texts)) {
      const input = rows[i].querySelector(`[data-${name}]`);
      if (input !== null && input !== except) input.value = Number(value.toPrecision(12));
    }
  };
  rows.forEach((row, i) => row.addEventListener("input", ({ target }) => {
    const { half } = data.dimensions[i], given = target.valueAsNumber, { set, number } = target.dataset;
    if (!Number.isFinite(given)) return;
    const relative = number === undefined ? given / 100 : given / half;
    if ((set ?? number) === "factor") {
      target.setCustomValidity(relative > 0 ? "" : "above 0");
      if (!(relative > 0)) return;
      // The study's own number is the study's own tolerance.
      settings[i].factor = number !== undefined && given === Number(half.toPrecision(12)) ? 1 : relative;
    } else {
      settings[i].shift = number === undefined ? half * relative : given;
    }
    fill(i, target);
    // Once a frame, however fast a slider moves.
    if (!isWaiting) requestAnimationFrame(update);
    isWaiting = true;
  }));
  const reset = () => {
    settings.forEach((of) => Object.assign(of, { factor: 1, shift: 0 }));
    settings.forEach((_, i) => fill(i, null));
    update();
  };
  document.getElementById("reset").addEventListener("click", reset);
  select.addEventListener("change", shares);
  document.getElementById("copy")?.addEventListener("click", () => {
    const text = document.getElementById("toml"), told = document.getElementById("copied");
    text.closest("details").open = true;
    text.select();
    const done = (ok) => { told.textContent = ok ? "copied" : "select the text below and copy it"; };
    // Where a page from disk may not use the clipboard, the selection is what there is.
    const byHand = () => done(document.execCommand("copy"));
    if (navigator.clipboard === undefined) byHand();
    else navigator.clipboard.writeText(text.value).then(() => done(true), byHand);
  });
  select.closest("label").hidden = select.options.length < 2;
  panel.hidden = false;
  // A browser may have kept what was typed before the page was loaded again.
  reset();
})();
