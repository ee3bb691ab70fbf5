"use strict";
// Studies as a table shows them, and as the text that the engine reads. Nothing here knows a page.
const study = (() => {
  const KINDS = ["normal", "truncated-normal", "uniform", "triangular", "trapezoidal", "beta", "arcsine", "u-shaped", "curvilinear-trapezoid", "student", "lognormal", "gamma", "weibull", "exponential", "rayleigh"];
  const UNITS = ["mm", "in", "µm", "deg", "rad", "K", "1"];
  // A number of TOML, and what spreadsheets write in its place.
  const NUMBER = /^[+-]?(0|[1-9]\d*)(\.\d+)?([eE][+-]?\d+)?$/;
  const spoken = (text) => {
    let plain = String(text).trim().replaceAll("−", "-").replaceAll(/[\s\u00a0\u202f']/g, "");
    // 1.234,5 is German, 1,234.5 English; a comma alone is a decimal one.
    if (/^[+-]?\d{1,3}(\.\d{3})+,\d+$/.test(plain)) plain = plain.replaceAll(".", "");
    else if (/^[+-]?\d{1,3}(,\d{3})+\.\d+$/.test(plain)) plain = plain.replaceAll(",", "");
    return plain.replace(",", ".");
  };
  // The number that a cell means, as TOML writes it; null where it means none.
  const number = (text) => {
    const plain = spoken(text);
    if (plain === "" || !Number.isFinite(Number(plain))) return null;
    return NUMBER.test(plain) ? plain : String(Number(plain));
  };
  const isNumber = (text) => number(text) !== null;
  const numeric = (text) => ({ number: text });

  const blank = (unit = "mm") => ({ name: "", nominal: "", tolerance: "", unit, distribution: "", more: {} });
  const asked = (name, formula = "") => ({ name, formula, unit: "mm", lower: "", upper: "", target: "99.73", more: {} });
  const empty = () => ({ title: "", dims: [], formulas: [], kcs: [], rest: {} });

  const shown = (value) => (value === undefined || value === null ? "" : typeof value === "object" ? JSON.stringify(value) : String(value));
  // A product by 100 adds digits that nobody wrote.
  const percent = (share) => (typeof share === "number" ? String(Number((100 * share).toPrecision(12))) : shown(share));

  // From the keys of a study, as the engine writes them in JSON.
  const of = (keys) => {
    const { title, dimensions = {}, formulas = {}, characteristics = {}, ...rest } = keys;
    const dims = Object.entries(dimensions).map(([name, entry]) => {
      const { nominal, tolerance, limits, fit, sigma, unit, distribution, ...more } = entry;
      const dim = { name, nominal: typeof nominal === "number" ? shown(nominal) : "", tolerance: "", unit: shown(unit), distribution: "", more };
      if (nominal !== undefined && typeof nominal !== "number") more.nominal = nominal;
      if (Array.isArray(tolerance) && tolerance.every((end) => typeof end === "number")) dim.tolerance = tolerance.join(" / ");
      else if (typeof tolerance === "number" || typeof tolerance === "string") dim.tolerance = shown(tolerance);
      else if (tolerance !== undefined) more.tolerance = tolerance;
      const others = { limits, fit, sigma };
      if (dim.tolerance === "" && Array.isArray(limits) && limits.every((end) => typeof end === "number")) {
        [dim.tolerance, others.limits] = [limits.join(" .. "), undefined];
      } else if (dim.tolerance === "" && typeof fit === "string") [dim.tolerance, others.fit] = [fit, undefined];
      else if (dim.tolerance === "" && typeof sigma === "number") [dim.tolerance, others.sigma] = [`sigma ${sigma}`, undefined];
      Object.entries(others).forEach(([key, value]) => { if (value !== undefined) more[key] = value; });
      if (typeof distribution === "string") dim.distribution = distribution;
      else if (distribution && Object.values(distribution).every((value) => typeof value !== "object")) {
        const { kind, ...parameters } = distribution;
        dim.distribution = [kind, ...Object.entries(parameters).map(([key, value]) => `${key}=${value}`)].join(" ");
      } else if (distribution) more.distribution = distribution;
      return dim;
    });
    const kcs = Object.entries(characteristics).map(([name, entry]) => {
      const { formula, unit, lower, upper, target_yield: target, ...more } = entry;
      return { name, formula: shown(formula), unit: shown(unit), lower: shown(lower), upper: shown(upper), target: percent(target), more };
    });
    const texts = Object.entries(formulas).filter(([, formula]) => typeof formula === "string");
    const others = Object.entries(formulas).filter(([, formula]) => typeof formula !== "string");
    if (others.length > 0) rest.formulas = Object.fromEntries(others);
    return { title: shown(title), dims, formulas: texts.map(([name, formula]) => ({ name, formula })), kcs, rest };
  };

  // What a cell of tolerances means, as keys of a study.
  const tolerance = (text) => {
    const plain = text.trim().replaceAll("−", "-").replace(/^(±|\+-|\+\/-)\s*/, "");
    if (plain === "") return {};
    if (isNumber(plain)) return { tolerance: numeric(number(plain)) };
    // A class comes first: s6 is a fit, not a sigma of 6.
    if (/^[A-Za-z]{1,2}\d{1,2}$/.test(plain)) return { fit: plain };
    const sigma = /^(?:sigma|σ|s)\s*=?\s*(.+)$/i.exec(plain);
    if (sigma && isNumber(sigma[1])) return { sigma: numeric(number(sigma[1])) };
    const limits = plain.split(/\s*(?:\.\.|…)\s*/);
    if (limits.length === 2 && limits.every(isNumber)) return { limits: limits.map((end) => numeric(number(end))) };
    let ends = plain.split(/\s*[/;]\s*/);
    if (ends.length !== 2) ends = plain.split(/\s+/);
    if (ends.length === 2 && ends.every(isNumber)) {
      return { tolerance: ends.map(number).sort((a, b) => Number(a) - Number(b)).map(numeric) };
    }
    return { tolerance: plain };
  };

  // `beta alpha=2 beta=5` as the table of a study.
  const distribution = (text) => {
    const [kind, ...parameters] = text.trim().replaceAll(/[(),]/g, " ").split(/\s+/);
    if (parameters.length === 0) return kind;
    const table = { kind };
    for (const parameter of parameters) {
      const [key, value] = parameter.split("=");
      table[key] = value !== undefined && isNumber(value) ? numeric(number(value)) : value ?? "";
    }
    return table;
  };

  // ---------- as TOML, with the place of every cell
  const bare = (key) => (/^[A-Za-z0-9_-]+$/.test(key) ? key : JSON.stringify(key));
  const literal = (text) => {
    if (/^[^'\u0000-\u0008\u000a-\u001f\u007f]*$/.test(text)) return [`'${text}'`, 1];
    if (/^[^\u0000-\u0008\u000b-\u001f\u007f]*$/.test(text) && !text.includes("'''") && !text.endsWith("'")) return [`'''\n${text}'''`, 4];
    return [JSON.stringify(text).replaceAll("\u007f", "\\u007f"), 1];
  };
  const quoted = (text) => (/["\\\u0000-\u001f\u007f]/.test(text) ? literal(text)[0] : `"${text}"`);
  const value = (one) => {
    if (typeof one === "number") return Number.isFinite(one) ? String(one) : "nan";
    if (typeof one === "string") return quoted(one);
    if (Array.isArray(one)) return `[${one.map(value).join(", ")}]`;
    if (one && typeof one === "object") {
      if (Object.keys(one).length === 1 && typeof one.number === "string" && isNumber(one.number)) return one.number;
      return `{ ${Object.entries(one).map(([key, part]) => `${bare(key)} = ${value(part)}`).join(", ")} }`;
    }
    return String(one);
  };

  // The text of a study, and its cells: { start, end, cell, inner } in characters, inner where the cell's own text begins.
  const toml = (state) => {
    let text = "";
    const cells = [];
    const put = (written, cell, inner = 0) => {
      if (cell) cells.push({ start: text.length, end: text.length + written.length, cell, inner: text.length + inner });
      text += written;
    };
    const entry = (name, parts, cell) => {
      put(bare(name), cell("name"));
      put(" = {");
      let first = true;
      const begin = text.length;
      for (const [key, one, column, inner] of parts) {
        put(first ? " " : ", ");
        first = false;
        // The key belongs to the cell: what is missing or does not apply is told of it.
        put(`${bare(key)} = `, cell(column));
        put(one, cell(column), inner);
      }
      put(first ? "}" : " }");
      cells.push({ start: begin, end: text.length, cell: cell("name"), inner: begin });
      put("\n");
    };
    if (state.title) put(`title = ${quoted(state.title)}\n`);
    const sections = Object.entries(state.rest).filter(([key]) => key !== "formulas");
    const isTable = (one) => one !== null && typeof one === "object" && !Array.isArray(one);
    sections.filter(([, one]) => !isTable(one)).forEach(([key, one]) => put(`${bare(key)} = ${value(one)}\n`));
    put(`${text ? "\n" : ""}[dimensions]\n`);
    state.dims.forEach((dim, i) => {
      // A row with a unit only is an empty one.
      const untouched = Object.entries(dim).every(([column, cell]) => column === "unit" || column === "more" || cell === "");
      if (untouched && Object.keys(dim.more).length === 0) return;
      const parts = [];
      const add = (key, one, column) => parts.push([key, value(one), column, typeof one === "string" ? 1 : 0]);
      if (dim.nominal.trim() !== "") add("nominal", isNumber(dim.nominal) ? numeric(number(dim.nominal)) : dim.nominal, "nominal");
      Object.entries(tolerance(dim.tolerance)).forEach(([key, one]) => add(key, one, "tolerance"));
      if (dim.unit.trim() !== "") add("unit", dim.unit.trim(), "unit");
      if (dim.distribution.trim() !== "" && !["normal"].includes(dim.distribution.trim())) add("distribution", distribution(dim.distribution), "distribution");
      Object.entries(dim.more).forEach(([key, one]) => add(key, one, "name"));
      entry(dim.name, parts, (column) => ({ of: "dims", i, column }));
    });
    const formulas = state.formulas.length > 0 || state.rest.formulas;
    if (formulas) {
      put("\n[formulas]\n");
      state.formulas.forEach((one, i) => {
        const [written, inner] = literal(one.formula);
        put(bare(one.name), { of: "formulas", i, column: "name" });
        put(" = ");
        put(written, { of: "formulas", i, column: "formula" }, inner);
        put("\n");
      });
      Object.entries(state.rest.formulas ?? {}).forEach(([key, one]) => put(`${bare(key)} = ${value(one)}\n`));
    }
    sections.filter(([, one]) => isTable(one)).forEach(([key, one]) => {
      put(`\n[${bare(key)}]\n`);
      Object.entries(one).forEach(([name, part]) => put(`${bare(name)} = ${value(part)}\n`));
    });
    put("\n[characteristics]\n");
    state.kcs.forEach((kc, i) => {
      const parts = [];
      const add = (key, cell, column) => {
        if (cell.trim() !== "") parts.push([key, isNumber(cell) ? number(cell) : quoted(cell), column, isNumber(cell) ? 0 : 1]);
      };
      if (kc.formula.trim() !== "") parts.push(["formula", ...(([written, inner]) => [written, "formula", inner])(literal(kc.formula))]);
      if (kc.unit.trim() !== "") parts.push(["unit", quoted(kc.unit.trim()), "unit", 1]);
      add("lower", kc.lower, "lower");
      add("upper", kc.upper, "upper");
      if (isNumber(kc.target)) parts.push(["target_yield", String(Number((Number(number(kc.target)) / 100).toPrecision(12))), "target", 0]);
      else add("target_yield", kc.target, "target");
      Object.entries(kc.more).forEach(([key, one]) => parts.push([key, value(one), "name", 0]));
      entry(kc.name, parts, (column) => ({ of: "kcs", i, column }));
    });
    return { text, cells };
  };

  // The cell at which a fault of the engine stands: by its place in bytes, or by its key.
  const placed = (state, { text, cells }, fault) => {
    if (fault.start !== null && fault.start !== undefined) {
      const bytes = new TextEncoder().encode(text);
      const at = new TextDecoder().decode(bytes.slice(0, fault.start)).length;
      const end = new TextDecoder().decode(bytes.slice(0, fault.end)).length;
      const around = cells.filter((cell) => cell.start <= at && at < Math.max(cell.end, cell.start + 1));
      around.sort((a, b) => a.end - a.start - (b.end - b.start));
      if (around.length > 0) {
        const found = around[0];
        // Of a key that is not there, the whole entry: its cell is known by the key.
        const column = fault.key.split(".").at(-1);
        const cell = found.cell.column === "name" && ["nominal", "tolerance", "unit", "distribution", "formula", "lower", "upper"].includes(column) ? { ...found.cell, column } : found.cell;
        return { ...cell, at: at - found.inner, length: Math.max(1, end - at) };
      }
    }
    const [section, name, column = "name"] = fault.key.split(".");
    const of = { dimensions: "dims", formulas: "formulas", characteristics: "kcs" }[section];
    const i = of ? state[of].findIndex((one) => one.name === name) : -1;
    return i < 0 ? null : { of, i, column, at: 0, length: 1 };
  };

  // ---------- spreadsheets
  const COLUMNS = ["name", "nominal", "tolerance", "unit", "distribution"];
  // Rows of tab-separated text at a cell, as the state with them; null where the text is one cell.
  const pasted = (state, text, row, column) => {
    const lines = text.replaceAll("\r\n", "\n").replaceAll("\r", "\n").replace(/\n+$/, "").split("\n");
    let rows = lines.map((line) => line.split("\t").map((cell) => cell.trim()));
    if (rows.length === 1 && rows[0].length === 1) return null;
    // A header has words where the others have numbers.
    const first = COLUMNS.indexOf(column);
    const words = (cells) => cells.slice(first === 0 ? 1 : 0, 3).every((cell) => cell !== "" && !isNumber(cell) && !/\d/.test(cell));
    if (rows.length > 1 && rows[0].length > 1 && words(rows[0])) rows = rows.slice(1);
    const next = structuredClone(state);
    rows.forEach((cells, k) => {
      const i = row + k;
      while (next.dims.length <= i) next.dims.push(blank());
      const dim = next.dims[i];
      const kept = (text) => (isNumber(text) ? number(text) : text);
      if (first === 0 && cells.length >= 4 && cells.slice(1, 4).every(isNumber)) {
        // name, nominal, +, -, unit, distribution: the sign may be left to the column.
        const ends = [Number(number(cells[2])), Number(number(cells[3]))];
        const signed = ends[0] >= 0 && ends[1] > 0 ? [ends[0], -ends[1]] : ends;
        const [low, high] = signed.toSorted((a, b) => a - b);
        Object.assign(dim, { name: cells[0], nominal: kept(cells[1]), tolerance: low === -high ? String(high) : `${low} / ${high}` });
        if (cells[4]) dim.unit = cells[4];
        if (cells[5]) dim.distribution = cells[5].toLowerCase();
        return;
      }
      cells.forEach((cell, j) => {
        const key = COLUMNS[first + j];
        if (key !== undefined) dim[key] = key === "nominal" || key === "tolerance" ? kept(cell) : key === "distribution" ? cell.toLowerCase() : cell;
      });
    });
    return { state: next, rows: rows.length };
  };
  // The same form back.
  const copied = (state) => state.dims.map((dim) => COLUMNS.map((column) => dim[column]).join("\t")).join("\n");

  // Names that a formula uses.
  const uses = (formula) => new Set([...formula.matchAll(/`([^`]*)`|([A-Za-z_][A-Za-z_0-9]*)/g)].map((match) => match[1] ?? match[2]));

  return { KINDS, UNITS, COLUMNS, blank, asked, empty, of, toml, placed, pasted, copied, uses, isNumber, number, tolerance };
})();
