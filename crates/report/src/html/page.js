// The what-if of the page: sliders and number boxes in, results out.
(() => {
  "use strict";
  const data = JSON.parse(document.getElementById("data").textContent), panel = document.getElementById("what-if");
  const settings = data.dimensions.map(() => ({ factor: 1, shift: 0 }));
  const tried = data.characteristics.map((one, index) => ({ one, index })).filter(({ one }) => one.why === null);
  const cards = tried.map(({ index }) => panel.querySelector(`[data-kc="${index}"]`));
  const rows = data.dimensions.map((_, i) => panel.querySelector(`[data-dimension="${i}"]`));
  // Ten thousands of products are quicker as plain numbers.
  for (const { pairs } of data.characteristics) {
    Object.assign(pairs, { j: Int32Array.from(pairs.j), k: Int32Array.from(pairs.k), a: Float64Array.from(pairs.a) });
  }
  const bars = rows.map((row) => ({ rects: [...row.querySelectorAll(".bar rect")], text: row.querySelector("[data-share]") }));
  const before = tried.map(({ one }) => live.evaluate(data, one, settings));
  let results = before;
  const paid = live.cost(data, settings);

  const significant = (x, digits) => {
    if (x === 0) return "0";
    const text = Number(x.toPrecision(digits));
    return Math.abs(text) < 1e9 && (Math.abs(text) >= 1e-4 || text === 0) ? x.toPrecision(digits) : text.toExponential();
  };
  const beside = (x, sigma) => {
    const decimals = sigma > 0 ? 4 - Math.floor(Math.log10(sigma)) : 6;
    return decimals >= 0 && decimals <= 12 ? x.toFixed(decimals) : significant(x, 8);
  };
  // A yield in percent, with three digits of what is rejected.
  const share = (rejected) => {
    const percent = 100 * rejected;
    if (percent <= 0) return "100 %";
    if (percent < 1e-7) return "> 99.9999999 %";
    const text = (100 - percent).toFixed(Math.min(12, Math.max(2, 2 - Math.floor(Math.log10(percent)))));
    return `${/^100\.0*$/.test(text) ? "100" : /^0\.0*$/.test(text) ? "0" : text} %`;
  };
  const figures = (found) => {
    const or = (x, text) => x === null ? "-" : text(x), ppm = (x) => significant(1e6 * x, 4);
    return {
      mean: beside(found.scale * found.mean, found.scale * found.sigma),
      sigma: beside(found.scale * found.sigma, found.scale * found.sigma),
      skewness: or(found.skewness, (x) => x.toFixed(4).replace(/^-(0\.0*)$/, "$1")),
      kurtosis: or(found.kurtosis, (x) => x.toFixed(4)),
      yield: or(found.rejected, share),
      "ppm below": or(found.below, ppm),
      "ppm above": or(found.above, ppm),
      Cpk: or(found.cpk, (x) => x.toFixed(3)),
    };
  };

  // ---- drawing --------------------------------------------------------------------------------------------------------

  const POINTS = 160, WIDTH = 640, BASE = 198, TOP = 6;
  const drawing = (law, from, to) => {
    const points = [];
    for (let i = 0; law !== null && i <= POINTS; i++) {
      const x = from + (to - from) * i / POINTS;
      points.push([i * WIDTH / POINTS, law.density(x)]);
    }
    return points;
  };
  const path = (points, most) => points
    .map(([x, y], i) => `${i === 0 ? "M" : "L"}${x.toFixed(1)} ${(BASE - (BASE - TOP) * Math.min(1, y / most)).toFixed(1)}`).join("");

  const draw = (card, { one }, old, now) => {
    const ends = [old, now].filter((of) => of.law !== null)
      .flatMap((of) => [of.mean - 5 * of.sigma, of.mean + 5 * of.sigma]);
    const limits = [one.lower, one.upper].filter((limit) => limit !== null && Math.abs(limit - old.mean) < 12 * old.sigma);
    const from = Math.min(...ends, ...limits), to = Math.max(...ends, ...limits);
    if (!(from < to)) return;
    const [dashed, solid] = [old, now].map((of) => drawing(of.law, from, to));
    // A density that is infinite at its end is cut.
    const heights = dashed.concat(solid).map((point) => point[1]).filter(Number.isFinite);
    const most = Math.min(Math.max(...heights), 4 / Math.min(old.sigma || Infinity, now.sigma || Infinity));
    card.querySelector(".before").setAttribute("d", path(dashed, most));
    card.querySelector(".now").setAttribute("d", path(solid, most));
    // The Pearson fit as a thin line beside a better law.
    card.querySelector(".fit").setAttribute("d", now.by === "surface" ? path(drawing(now.fit, from, to), most) : "");
    for (const side of ["lower", "upper"]) {
      const x = one[side] === null ? NaN : WIDTH * (one[side] - from) / (to - from);
      card.querySelector(`[data-limit="${side}"]`).setAttribute("d", x >= 0 && x <= WIDTH ? `M${x.toFixed(1)} 0V200` : "");
    }
  };

  // The parts that dimensions have in the variance: straight line, curvature, half of each interaction.
  const shares = () => {
    const select = document.getElementById("share-of");
    const place = Math.max(0, tried.findIndex(({ index }) => String(index) === select.value));
    const { one } = tried[place], found = results[place];
    const half = new Float64Array(data.dimensions.length);
    found.shares.forEach((of, i) => {
      half[one.pairs.j[i]] += 0.5 * of;
      half[one.pairs.k[i]] += 0.5 * of;
    });
    // What has not changed to the eye is not drawn again.
    const set = (element, name, text) => {
      if (element.getAttribute(name) !== text) element.setAttribute(name, text);
    };
    bars.forEach(({ rects, text }, i) => {
      const parts = [found.linear[i], found.curvature[i], half[i]];
      let x = 0;
      rects.forEach((rect, k) => {
        set(rect, "x", x.toFixed(2));
        set(rect, "width", (100 * parts[k]).toFixed(2));
        x += 100 * parts[k];
      });
      const share = `${x.toFixed(2)} %`;
      if (text.textContent !== share) text.textContent = share;
    });
  };

  // The counterpart of the module `verdict`: the interval of the yield reaches as far as at the tolerances of the study, from the law
  // by which it was computed there.
  const judged = (found, then, { target, reach }) => {
    if (reach === null || found.by !== then.by) return "inconclusive";
    const counted = found.by === "points" ? found.error : 0;
    if (found.yield - reach[0] - counted >= target) return "met";
    return found.yield + reach[1] + counted < target ? "missed" : "inconclusive";
  };
  const source = (found, one) => {
    if (found.by === "surface") {
      const differs = found.pearson !== null && found.yield !== null && Math.abs(found.pearson - found.yield) > 0.01 * Math.max(1 - found.pearson, found.rejected);
      return `by the surface law${differs ? `; Pearson fit ${share(1 - found.pearson)}` : ""}`;
    }
    if (found.by === "points") {
      return `by the surface law; changes counted at points${found.error > 0 ? `, ± ${(100 * found.error).toPrecision(2)} %` : ""}`;
    }
    return `by the Pearson fit: ${one.law ? "the surface law is not accurate enough here" : one.why_fit}`;
  };

  const show = () => {
    tried.forEach((of, i) => {
      const texts = figures(results[i]), then = figures(before[i]), { met } = results[i];
      for (const [name, text] of Object.entries(texts)) {
        const cell = cards[i].querySelector(`[data-figure="${name}"]`);
        cell.textContent = text;
        cell.classList.toggle("changed", text !== then[name]);
        cards[i].querySelector(`[data-before="${name}"]`).textContent = then[name];
      }
      const by = cards[i].querySelector('[data-by]');
      by.textContent = source(results[i], of.one);
      const badge = cards[i].querySelector('[data-figure="verdict"]');
      const verdict = met === null ? null : judged(results[i], before[i], of.one);
      badge.textContent = verdict === null ? "" : verdict === "inconclusive" ? verdict : `target ${verdict}`;
      badge.classList.toggle("good", verdict === "met");
      badge.classList.toggle("bad", verdict === "missed");
      badge.classList.toggle("unsure", verdict === "inconclusive");
      draw(cards[i], of, before[i], results[i]);
    });
    shares();
    const total = document.getElementById("cost");
    if (total !== null) {
      const now = live.cost(data, settings), change = 100 * (now / paid - 1);
      total.textContent = !Number.isFinite(now) ? "no process holds these tolerances"
        : !Number.isFinite(paid) || Math.abs(change) < 0.005 ? significant(now, 6)
        : `${significant(now, 6)} (${Math.abs(change).toFixed(2)} % ${change < 0 ? "less" : "more"})`;
      total.classList.toggle("changed", now !== paid);
    }
    panel.classList.toggle("touched", settings.some(({ factor, shift }) => factor !== 1 || shift !== 0));
    const text = document.getElementById("toml");
    if (text !== null) text.value = live.toml(data, settings);
  };

  // ---- input ----------------------------------------------------------------------------------------------------------

  let waiting = false;
  const update = () => {
    results = tried.map(({ one }) => live.evaluate(data, one, settings));
    show();
  };
  /// Once a frame, however fast a slider moves.
  const soon = () => {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      update();
    });
  };
  const fill = (i, except) => {
    const row = rows[i], { half } = data.dimensions[i], { factor, shift } = settings[i];
    const set = (selector, text) => {
      const input = row.querySelector(selector);
      if (input !== null && input !== except) input.value = text;
    };
    set('[data-set="factor"]', Math.round(100 * factor));
    set('[data-number="factor"]', Number((factor * half).toPrecision(12)));
    set('[data-set="shift"]', Math.round(100 * shift / half));
    set('[data-number="shift"]', Number(shift.toPrecision(12)));
  };
  rows.forEach((row, i) => row.addEventListener("input", ({ target }) => {
    const { half } = data.dimensions[i], given = target.valueAsNumber;
    if (!Number.isFinite(given)) return;
    const of = settings[i], number = target.dataset.number !== undefined, what = target.dataset.set ?? target.dataset.number;
    if (what === "factor") {
      const factor = number ? given / half : given / 100;
      target.setCustomValidity(factor > 0 ? "" : "above 0");
      if (!(factor > 0)) return;
      // The study's own number is the study's own tolerance.
      of.factor = number && given === Number(half.toPrecision(12)) ? 1 : factor;
    } else {
      of.shift = number ? given : half * given / 100;
    }
    fill(i, target);
    soon();
  }));
  const reset = () => {
    settings.forEach((of, i) => {
      of.factor = 1;
      of.shift = 0;
      fill(i, null);
    });
    update();
  };
  document.getElementById("reset").addEventListener("click", reset);
  document.getElementById("share-of").addEventListener("change", shares);
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
  if (document.getElementById("share-of").options.length < 2) document.getElementById("share-of").closest("label").hidden = true;
  panel.hidden = false;
  // A browser may have kept what was typed before the page was loaded again.
  reset();
})();
