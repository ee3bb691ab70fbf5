"use strict";
// The page: a state, its steps back and forth, what is shown of it, and what the engine says of it.
const page = (() => {
  const $ = (id) => document.getElementById(id);
  const data = (id) => JSON.parse($(id).textContent);
  const esc = (text) => String(text).replace(/[&<>"']/g, (c) => `&#${c.charCodeAt(0)};`);
  const examples = data("examples-data");
  const { Engine } = served ?? engine, live = new Engine(), tools = new Engine();
  const KEPT = "sensitol-workbench";
  let state = study.empty(), past = [], next = [], selected = 0, tab = "allocate", view = "table", kind = "formula";
  // What the study was read from, as long as nothing has changed; its name and the files that it names.
  let original = null, name = "study.toml", files = {};
  // The text in the other view, where it is edited, and what the engine said last.
  let typed = null, made = null, result = null, faults = [], models = [];

  // ---------- steps
  const now = () => JSON.stringify({ state, original, name, files });
  const back = (text) => { ({ state, original, name, files } = JSON.parse(text)); typed = null; all(); };
  let before = null;
  const keep = (step) => { if (past.at(-1) !== step) past.push(step); if (past.length > 200) past.shift(); next = []; original = null; };
  const edit = (change) => { const step = now(); change(); keep(step); all(); };
  // Typing in one cell is one step.
  document.addEventListener("focusin", (event) => { if (event.target.matches(".edit input, .edit textarea, #title")) before = now(); });
  const touched = () => { if (before !== null) keep(before); before = null; original = null; };
  const step = (from, to) => { if (from.length > 0) { to.push(now()); back(from.pop()); } };
  $("undo").onclick = () => step(past, next);
  $("redo").onclick = () => step(next, past);
  document.addEventListener("keydown", (event) => {
    if (!(event.ctrlKey || event.metaKey) || !["z", "y"].includes(event.key.toLowerCase())) return;
    event.preventDefault();
    const forth = event.shiftKey || event.key.toLowerCase() === "y";
    if (forth) step(next, past); else step(past, next);
    before = now();
  });

  let toasting;
  const toast = (text) => {
    $("toast").textContent = text;
    $("toast").classList.add("on");
    clearTimeout(toasting);
    toasting = setTimeout(() => $("toast").classList.remove("on"), 2500);
  };

  // ---------- the table
  const DELETE = "<button type=\"button\" data-delete aria-label=\"Delete\">×</button>";
  const cell = (column, value, about, list = "") =>
    `<input data-column="${column}" value="${esc(value)}" aria-label="${esc(about)}" autocomplete="off" spellcheck="false"${list && ` list="${list}"`}${column === "nominal" ? " inputmode=\"text\"" : ""}>`;
  const grid = () => {
    $("rows").innerHTML = state.dims.map((dim, i) => {
      const about = (column) => `${column} of ${dim.name || `row ${i + 1}`}`;
      const more = Object.keys(dim.more).length > 0 ? ` title="${esc(`Also: ${Object.keys(dim.more).join(", ")}. Edit them as TOML.`)}"` : "";
      return `<tr data-i="${i}"${more}><td class="nm">${cell("name", dim.name, about("name"))}</td><td class="n">${cell("nominal", dim.nominal, about("nominal"))}</td>`
        + `<td class="n">${cell("tolerance", dim.tolerance, about("tolerance"))}</td><td>${cell("unit", dim.unit, about("unit"), "units")}</td>`
        + `<td class="ds">${cell("distribution", dim.distribution || "normal", about("distribution"), "kinds")}</td><td class="sh" data-share></td><td class="x">${DELETE.replace("Delete", `Delete ${esc(dim.name)}`)}</td></tr><tr class="er" data-e="${i}" hidden><td colspan="7" class="err" id="err-${i}"></td></tr>`;
    }).join("");
  };
  const field = (column, title, value) => `<label>${title}<input data-column="${column}" value="${esc(value)}" spellcheck="false" autocomplete="off"></label>`;
  const cards = () => {
    const formulas = state.formulas.map((one, i) => `<div class="kc f" data-of="formulas" data-i="${i}"><div class="hd">${field("name", "intermediate value", one.name)}${DELETE.replace("Delete", `Delete ${esc(one.name)}`)}</div>`
      + `<textarea class="fx" rows="1" data-column="formula" spellcheck="false" aria-label="Formula of ${esc(one.name)}" aria-describedby="ferr-f${i}">${esc(one.formula)}</textarea><p class="ferr" id="ferr-f${i}"></p></div>`);
    const asked = state.kcs.map((one, i) => `<div class="kc" data-of="kcs" data-i="${i}"><div class="hd">${field("name", "characteristic", one.name)}${field("unit", "unit", one.unit)}${field("lower", "lower limit", one.lower)}${field("upper", "upper limit", one.upper)}${field("target", "target yield, %", one.target)}${DELETE.replace("Delete", `Delete ${esc(one.name)}`)}</div>`
      + `<textarea class="fx" rows="1" data-column="formula" spellcheck="false" aria-label="Formula of ${esc(one.name)}" aria-describedby="ferr-k${i}" placeholder="${state.rest.model || state.rest.loops ? "the output or the unknown of this name" : "a formula of dimensions"}">${esc(one.formula)}</textarea><p class="ferr" id="ferr-k${i}"></p></div>`);
    $("kcs").innerHTML = formulas.join("") + asked.join("");
  };

  $("rows").addEventListener("input", (event) => {
    const { column } = event.target.dataset;
    if (column === undefined) return;
    touched();
    const value = event.target.value;
    state.dims[+event.target.closest("tr").dataset.i][column] = column === "distribution" && value === "normal" ? "" : value;
    soon();
  });
  $("rows").addEventListener("click", (event) => {
    if (event.target.closest("[data-delete]")) edit(() => state.dims.splice(+event.target.closest("tr").dataset.i, 1));
  });
  const go = (i, column) => document.querySelector(`#rows tr[data-i="${i}"] [data-column="${column}"]`)?.focus();
  $("rows").addEventListener("keydown", (event) => {
    const { column } = event.target.dataset;
    if (column === undefined) return;
    const i = +event.target.closest("tr").dataset.i, listed = column === "unit" || column === "distribution";
    if (event.key === "Enter" || (event.key === "ArrowDown" && !listed)) {
      event.preventDefault();
      if (event.key === "Enter" && i === state.dims.length - 1) edit(() => state.dims.push(study.blank(state.dims.at(-1).unit)));
      go(i + 1, column);
    } else if (event.key === "ArrowUp" && !listed) {
      event.preventDefault();
      go(i - 1, column);
    }
  });
  $("rows").addEventListener("paste", (event) => {
    const { column } = event.target.dataset;
    const found = column && study.pasted(state, event.clipboardData.getData("text/plain"), +event.target.closest("tr").dataset.i, column);
    if (!found) return;
    event.preventDefault();
    edit(() => { state = found.state; });
    toast(`${found.rows} ${found.rows === 1 ? "row" : "rows"} pasted`);
  });
  $("copy-rows").onclick = async () => {
    try { await navigator.clipboard.writeText(study.copied(state)); toast("Table copied"); } catch { toast("This browser does not let a page copy: use the view as TOML"); }
  };
  $("kcs").addEventListener("input", (event) => {
    const { column } = event.target.dataset;
    if (column === undefined) return;
    touched();
    const box = event.target.closest(".kc");
    state[box.dataset.of][+box.dataset.i][column] = event.target.value;
    if (box.dataset.of === "kcs") selected = +box.dataset.i;
    soon();
  });
  $("kcs").addEventListener("click", (event) => {
    const box = event.target.closest(".kc");
    if (box === null) return;
    if (event.target.closest("[data-delete]")) edit(() => state[box.dataset.of].splice(+box.dataset.i, 1));
    else if (box.dataset.of === "kcs" && selected !== +box.dataset.i) choose(+box.dataset.i);
  });
  $("title").addEventListener("input", () => { touched(); state.title = $("title").value; soon(); });
  const free = (stem, all) => { let i = all.length + 1; while (all.some((one) => one.name === `${stem}${i}`)) i += 1; return `${stem}${i}`; };
  $("add-dimension").onclick = () => { edit(() => state.dims.push(study.blank(state.dims.at(-1)?.unit))); go(state.dims.length - 1, "name"); };
  $("add-characteristic").onclick = () => edit(() => {
    const formula = state.rest.model || state.rest.loops ? "" : state.dims.slice(0, 2).map((dim) => dim.name).join(" - ");
    state.kcs.push(study.asked(free("kc", state.kcs), formula));
  });
  $("add-formula").onclick = () => edit(() => state.formulas.push({ name: free("v", state.formulas), formula: state.dims[0]?.name ?? "0" }));

  // ---------- built-in models and loops
  const model = () => models.find((one) => one.name === $("model").value);
  const aboutModel = () => { const one = model(); if (one) $("model-about").textContent = `${one.title}. Inputs: ${one.inputs.map((input) => `${input.name} [${input.unit}]`).join(", ")}. Outputs: ${one.outputs.map((output) => output.name).join(", ")}.`; };
  $("model").onchange = aboutModel;
  $("take-model").onclick = () => {
    const one = model();
    if (!one) return;
    edit(() => {
      state = study.empty();
      [name, files] = ["study.toml", {}];
      state.title = one.title;
      state.dims = one.inputs.map((input) => ({ ...study.blank(input.unit), name: input.name, nominal: String(input.nominal) }));
      state.kcs = one.outputs.map((output) => ({ ...study.asked(output.name), unit: output.unit, target: "" }));
      state.rest.model = { builtin: one.name };
      selected = 0;
    });
  };
  const loopName = () => Object.keys(state.rest.loops ?? {})[0] ?? "loop";
  const links = () => state.rest.loops?.[loopName()] ?? [];
  const known = () => new Set([...state.dims, ...state.formulas].map((one) => one.name).concat(Object.keys(state.rest.constants ?? {}), ["pi", "deg"]));
  const FUNCTIONS = new Set("if abs sign floor ceil sqrt exp ln log10 sin cos tan asin acos atan atan2 sinh cosh tanh hypot min max".split(" "));
  const missing = () => [...new Set(links().flatMap((link) => [...study.uses(String(link.length)), ...study.uses(String(link.angle))]))].filter((one) => !known().has(one) && !FUNCTIONS.has(one));
  const loop = () => {
    $("loop-name").value = loopName();
    $("links").tBodies[0].innerHTML = links().map((link, i) => `<tr data-i="${i}"><td><input data-part="length" value="${esc(link.length)}" aria-label="Length of link ${i + 1}" spellcheck="false"></td><td><input data-part="angle" value="${esc(link.angle)}" aria-label="Angle of link ${i + 1}" spellcheck="false"></td><td class="x">${DELETE.replace("Delete", `Delete link ${i + 1}`)}</td></tr>`).join("");
    unknowns();
  };
  const unknowns = () => {
    const start = (one) => { const found = state.rest.unknowns?.[one]; return typeof found === "object" ? found.start : found ?? ""; };
    $("unknowns").innerHTML = missing().map((one) => `<label>${esc(one)} starts at<input data-unknown="${esc(one)}" value="${esc(start(one))}"></label>`).join("");
  };
  const withLinks = (all, named = loopName()) => {
    const { [loopName()]: _, ...others } = state.rest.loops ?? {};
    state.rest.loops = { [named]: all, ...others };
    const wanted = missing(), found = state.rest.unknowns ?? {};
    const entry = (one) => [one, found[one] ?? 1];
    state.rest.unknowns = Object.fromEntries(wanted.map(entry));
    if (all.length === 0) { delete state.rest.loops; delete state.rest.unknowns; }
  };
  const term = (text) => (study.isNumber(text) ? Number(study.number(text)) : text);
  $("add-link").onclick = () => edit(() => withLinks([...links(), { length: "1", angle: "0" }]));
  $("loop-name").onchange = () => edit(() => withLinks(links(), $("loop-name").value || "loop"));
  $("links").addEventListener("input", (event) => {
    touched();
    const i = +event.target.closest("tr").dataset.i;
    withLinks(links().map((link, k) => (k === i ? { ...link, [event.target.dataset.part]: term(event.target.value) } : link)));
    unknowns();
    soon();
  });
  $("links").addEventListener("click", (event) => {
    if (event.target.closest("[data-delete]")) edit(() => withLinks(links().filter((_, k) => k !== +event.target.closest("tr").dataset.i)));
  });
  $("unknowns").addEventListener("input", (event) => {
    touched();
    const one = event.target.dataset.unknown, found = state.rest.unknowns?.[one];
    const start = term(event.target.value);
    state.rest.unknowns = { ...state.rest.unknowns, [one]: typeof found === "object" ? { ...found, start } : start };
    soon();
  });
  const command = () => state.rest.model?.command;
  const kindOf = () => (command() ? "program" : state.rest.model ? "model" : state.rest.loops ? "loop" : "formula");
  const kinds = () => {
    if (kind === "program" && !command()) kind = kindOf();
    document.querySelector("[data-kind=program]").hidden = !command();
    $("program-box").hidden = kind !== "program";
    $("program-command").textContent = command()?.join(" ") ?? "";
    [...$("kind").children].forEach((button) => button.setAttribute("aria-pressed", button.dataset.kind === kind));
    $("model-box").hidden = kind !== "model";
    $("loop-box").hidden = kind !== "loop";
  };
  $("kind").onclick = (event) => { const chosen = event.target.closest("button"); if (chosen) { kind = chosen.dataset.kind; kinds(); } };

  // ---------- the study as text
  const source = () => {
    if (original !== null) return { text: original, cells: null };
    return study.toml(state);
  };
  const task = (text, more) => ({ text, format: "toml", name, files, ...more });
  const views = () => {
    [...$("view").children].forEach((button) => button.setAttribute("aria-pressed", button.dataset.view === view));
    $("table").hidden = view !== "table";
    $("toml-box").hidden = view !== "toml";
  };
  $("view").onclick = async (event) => {
    const chosen = event.target.closest("button")?.dataset.view;
    if (chosen === undefined || chosen === view) return;
    if (chosen === "toml") {
      $("toml").value = source().text;
    } else if (typed !== null) {
      const found = await live.ask("study", task(typed));
      if (found.faults) return toast("The table can show the study when its text is right");
      [state, original, typed] = [study.of(found.study), typed, null];
      if (state.rest.model || state.rest.loops) kind = kindOf();
      all();
    }
    view = chosen;
    views();
  };
  $("toml").addEventListener("input", () => { if (typed === null) keep(now()); before = null; typed = $("toml").value; soon(); });

  // ---------- live
  let running = false, again = false, timer;
  const soon = () => { document.documentElement.dataset.ready = "0"; clearTimeout(timer); timer = setTimeout(run, 0); };
  // A program is not run at every key: who edits says when. The engine says whether the study has one.
  let program = null, wanted = false, starts = false;
  const progress = (answered, expected) => `${program.join(" ")} runs: ${expected > 0 ? `${answered} of ${expected} points` : `${answered} points`}`;
  const far = (answered, expected) => {
    if (program === null) return;
    $("old").hidden = false;
    $("old").textContent = progress(answered, expected);
  };
  const button = () => {
    $("analyze").hidden = program === null;
    $("analyze").textContent = starts ? "The program runs: stop it" : "Analyze";
  };
  async function run(asks = false) {
    document.documentElement.dataset.ready = "0";
    wanted ||= asks === true;
    if (running) { again = true; return; }
    running = true;
    const late = setTimeout(() => { $("busy").hidden = false; }, 100);
    do {
      [again, starts, wanted] = [false, wanted, false];
      const asked = typed !== null ? { text: typed, cells: null } : source();
      const begun = performance.now();
      let found;
      button();
      if (starts) far(0, 0);
      try { found = await live.ask("run", task(asked.text, { asked: { command: "analyze" }, forms: ["json", "html"] }), far, starts); } catch (error) { found = { error: error.message, advice: [] }; }
      // Of a run that was stopped, or of a study with faults, the engine says nothing of a program.
      if (found.program !== undefined) program = found.program; else if (found.faults) program = null;
      const waits = program !== null && !starts && !found.faults;
      starts = false;
      button();
      // What was typed meanwhile is asked at once; a step of undo may have replaced the study.
      made = asked;
      faults = found.faults ?? (found.error && !waits ? [{ key: "", fault: found.error, help: found.advice.join(" ") || null, start: null, end: null, line: null }] : []);
      if (found.json !== undefined) result = read(found, performance.now() - begun);
      if (found.json !== undefined && typed === null) { first(); remember(); }
      told();
      if (waits) {
        $("old").hidden = false;
        $("old").textContent = `${result === null ? "" : "Last result. "}The model is a program, ${program.join(" ")}: Analyze runs it${result === null ? "" : " again"}`;
      }
    } while (again);
    clearTimeout(late);
    $("busy").hidden = true;
    running = false;
    document.documentElement.dataset.ready = "1";
  }
  // Without its style, which is not this page's.
  const parsed = (html) => new DOMParser().parseFromString(html.replace(/<style>[^]*?<\/style>/, ""), "text/html");
  // The engine's own words for the numbers: cells of the table of verdicts, by their headings.
  const read = (found, took) => {
    const page = parsed(found.html), report = JSON.parse(found.json);
    const table = page.querySelector("section[aria-labelledby=summary] table"), heads = [...table.tHead.rows[0].cells].map((head) => head.textContent);
    const cells = [...table.tBodies[0].rows].map((row) => Object.fromEntries([...row.cells].map((one, i) => [heads[i], one.textContent])));
    const limited = new Map([...page.querySelectorAll(".gauges tbody tr:not(.all)")].map((row) => [row.querySelector("a").textContent, row.cells]));
    const rows = report.characteristics.map((one, i) => {
      const of = limited.get(one.name);
      return {
        mean: cells[i]?.mean,
        sigma: cells[i]?.sigma,
        yield: of?.[3].querySelector("strong").textContent,
        interval: of?.[3].querySelector("small").textContent ? `${of[3].querySelector("small").textContent}, 95 %` : "",
        rejects: of && [...of[5].childNodes].map((node) => node.textContent).filter(Boolean).join(", "),
        Cpk: of?.[6].textContent || undefined,
        worst: of && ([...of[7].childNodes].map((node) => node.textContent).filter(Boolean).join(" ") || undefined),
      };
    });
    const densities = [...page.querySelectorAll("section.kc")].map((section) => section.querySelector("svg.density.narrow")?.outerHTML ?? "");
    return { report, rows, densities, took };
  };
  // The characteristic that misses its target is shown first.
  let fresh = true;
  const first = () => {
    if (!fresh) return;
    fresh = false;
    const missed = result.report.characteristics.findIndex((one) => one.verdict === "missed");
    if (missed > 0) selected = missed;
  };
  const choose = (i) => { selected = i; told(); panel(); };

  // ---------- what the engine says, in place
  const caret = (source, fault, at, length) => {
    const lines = source.slice(0, at).split("\n"), line = source.split("\n")[lines.length - 1] ?? "", column = lines.at(-1).length;
    const from = Math.max(0, column - 40);
    const said = `${esc(fault.fault)}${fault.help ? ` (${esc(fault.help)})` : ""}`;
    return `${esc(line.slice(from, from + 74))}\n${" ".repeat(column - from)}${"^".repeat(Math.max(1, Math.min(length, line.length - column)))}\n<b>${lines.length}:${column + 1}: ${said}</b>`;
  };
  const marks = () => {
    document.querySelectorAll("[aria-invalid]").forEach((one) => one.removeAttribute("aria-invalid"));
    document.querySelectorAll(".ferr").forEach((one) => { one.textContent = ""; one.classList.remove("wait"); });
    document.querySelectorAll(".er").forEach((row) => { row.hidden = true; row.firstElementChild.textContent = ""; });
    const said = (fault) => `${fault.fault}${fault.help ? ` (${fault.help})` : ""}`;
    const elsewhere = [], broken = new Set();
    for (const fault of faults) {
      const place = typed === null && made.cells ? study.placed(state, made, fault) : null;
      const whole = `${fault.line ? `${name}:${fault.line}:${fault.column}: ` : ""}${fault.key && !place ? `${fault.key}: ` : ""}${said(fault)}`;
      if (place === null || !state[place.of][place.i]) { elsewhere.push(whole); continue; }
      if (place.of === "dims") {
        const row = document.querySelector(`tr[data-e="${place.i}"]`), text = row.firstElementChild;
        row.hidden = false;
        text.textContent += `${text.textContent && "\n"}${said(fault)}`;
        const input = document.querySelector(`#rows tr[data-i="${place.i}"] [data-column="${place.column}"]`) ?? document.querySelector(`#rows tr[data-i="${place.i}"] input`);
        input.setAttribute("aria-invalid", "true");
        input.setAttribute("aria-describedby", text.id);
        continue;
      }
      const one = state[place.of][place.i], box = document.querySelector(`.kc[data-of="${place.of}"][data-i="${place.i}"]`);
      broken.add(one.name);
      box.querySelector(`[data-column="${place.column}"]`)?.setAttribute("aria-invalid", "true");
      box.querySelector(".ferr").innerHTML = place.column === "formula" && one.formula ? caret(one.formula, fault, Math.max(0, place.at), place.length) : `<b>${esc(said(fault))}</b>`;
    }
    // Of what follows from a broken formula nothing is said but that.
    for (let more = broken.size > 0; more;) {
      more = false;
      for (const of of ["formulas", "kcs"]) {
        state[of].forEach((one, i) => {
          const cause = broken.has(one.name) ? undefined : [...study.uses(one.formula)].find((used) => broken.has(used));
          if (cause === undefined) return;
          broken.add(one.name);
          more = true;
          const text = document.querySelector(`.kc[data-of="${of}"][data-i="${i}"] .ferr`);
          text.classList.add("wait");
          text.textContent = `waits for ${cause}`;
        });
      }
    }
    $("elsewhere").textContent = typed === null ? elsewhere.join("\n") : "";
    $("toml-error").textContent = typed === null ? "" : elsewhere.join("\n");
    if (typed === null) $("toml").removeAttribute("aria-invalid"); else $("toml").setAttribute("aria-invalid", String(faults.length > 0));
  };

  // ---------- results
  const MARK = {
    met: "<svg viewBox=\"0 0 16 16\" aria-hidden=\"true\"><circle cx=\"8\" cy=\"8\" r=\"6.5\"/><path d=\"M4.8 8.2L7 10.5L11.2 5.8\"/></svg>",
    missed: "<svg viewBox=\"0 0 16 16\" aria-hidden=\"true\"><path d=\"M8 1.8L15 14H1ZM8 6V10M8 11.5V12.6\"/></svg>",
    inconclusive: "<svg viewBox=\"0 0 16 16\" aria-hidden=\"true\"><circle cx=\"8\" cy=\"8\" r=\"6.5\" stroke-dasharray=\"3 2\"/></svg>",
  };
  const WORD = { met: "Met", missed: "Missed", inconclusive: "Inconclusive" };
  const percent = (share) => (share === null || share === undefined ? "?" : `${(100 * share).toFixed(1)} %`);
  const part = (one, dim) => {
    const row = one?.sensitivities.find((row) => row.dimension === dim);
    return row && row.linear_share !== null ? [row.linear_share, row.curvature_share ?? 0] : null;
  };
  const shares = () => {
    const one = result?.report.characteristics.find((one) => one.name === state.kcs[selected]?.name);
    $("share-of").textContent = `share of ${state.kcs[selected]?.name ?? "–"}`;
    document.querySelectorAll("#rows tr[data-i]").forEach((row, i) => {
      const of = part(one, state.dims[i].name), [a, b] = of ?? [0, 0];
      row.querySelector("[data-share]").innerHTML = of === null || a + b === 0 ? "<span class=\"soft\">–</span>"
        : `<svg viewBox="0 0 100 9" preserveAspectRatio="none" aria-hidden="true"><rect class="track" width="100" height="9"/><rect class="b1" width="${100 * Math.max(0, a)}" height="9"/><rect class="b2" x="${100 * Math.max(0, a)}" width="${100 * Math.max(0, b)}" height="9"/></svg>${percent(a + b)}`;
    });
  };
  const drives = (one) => {
    const rows = one.sensitivities.filter((row) => row.linear_share !== null).map((row) => ({ name: row.dimension, parts: [row.linear_share, row.curvature_share ?? 0, 0] }));
    rows.push(...one.interactions.filter((pair) => pair.share !== null).map((pair) => ({ name: pair.dimensions.join(" × "), parts: [0, 0, pair.share] })));
    const total = (row) => row.parts[0] + row.parts[1] + row.parts[2];
    const seen = rows.filter((row) => Math.abs(total(row)) >= 5e-4).sort((a, b) => total(b) - total(a)), shown = seen.slice(0, 12);
    let sum = 0;
    const bar = (row) => {
      const from = sum;
      sum += total(row);
      let x = 0;
      const rects = row.parts.map((part, i) => { const rect = part > 0 ? `<rect class="b${i + 1}" x="${100 * x}" y="8" width="${100 * part}" height="10"/>` : ""; x += Math.max(0, part); return rect; }).join("");
      return `<tr><th scope="row" title="${esc(row.name)}">${esc(row.name)}</th><td><svg viewBox="0 0 100 26" preserveAspectRatio="none" aria-hidden="true">${rects}<path class="cum" d="M${100 * Math.min(1, from)} 0H${100 * Math.min(1, sum)}V26"/></svg></td><td class="r">${percent(total(row))}</td></tr>`;
    };
    const body = shown.map(bar).join("");
    const left = one.left_out_share, others = seen.length - shown.length;
    const rest = (others > 0 ? `<p class="foot">${others} others, together ${percent(seen.slice(12).reduce((sum, row) => sum + total(row), 0))}</p>` : "")
      + (left !== null && left > 5e-4 ? `<p class="foot unknown">not resolved: ${percent(left)}</p>` : "");
    return body ? `<h3 class="soft">What drives it</h3><table class="par"><caption class="sr">Shares of the variance of ${esc(one.name)}</caption><tbody>${body}</tbody></table>${rest}` : "";
  };
  const told = () => {
    $("undo").disabled = past.length === 0;
    $("redo").disabled = next.length === 0;
    selected = Math.max(0, Math.min(selected, state.kcs.length - 1));
    marks();
    shares();
    document.querySelectorAll(".kc[data-of=\"kcs\"]").forEach((box, i) => box.classList.toggle("on", i === selected));
    const all = result?.report.characteristics ?? [];
    const of = (i) => all.find((one) => one.name === state.kcs[i]?.name) ?? (typed === null ? undefined : all[i]);
    $("kc-tabs").innerHTML = (typed === null ? state.kcs : all).map((kc, i) => `<button type="button" role="tab" data-i="${i}" aria-selected="${i === selected}" aria-controls="out">${esc(kc.name)}${of(i)?.verdict ? `<span class="${of(i).verdict}">${MARK[of(i).verdict]}<span class="sr">${WORD[of(i).verdict]}</span></span>` : ""}</button>`).join("");
    $("kc-tabs").hidden = $("kc-tabs").childElementCount === 0;
    const stale = faults.length > 0 && result !== null;
    $("old").hidden = !stale;
    $("old").textContent = "Last complete result";
    $("out").classList.toggle("stale", stale);
    $("out").innerHTML = result === null ? `<p class="soft">${faults.length > 0 ? "Nothing was analysed yet." : ""}</p>` : details(of(selected));
    $("mini").innerHTML = all.map((one, i) => `<a href="#results"><span>${esc(one.name)}</span><b>${esc(result.rows[i]?.yield ?? "")}</b><span>${esc(result.rows[i]?.Cpk ?? "")}</span><span class="${one.verdict ?? ""}">${WORD[one.verdict] ?? ""}</span></a>`).join("");
  };
  const details = (one) => {
    if (!one) return "<p class=\"soft\">This characteristic has no result yet.</p>";
    const i = result.report.characteristics.indexOf(one), row = result.rows[i] ?? {}, value = row.yield ?? "";
    const warnings = result.report.warnings.filter((warning) => warning.characteristic === one.name || warning.characteristic === null);
    const unit = one.unit ? `, ${esc(one.unit)}` : "";
    return `<div class="ver"><span class="soft">yield</span><span></span><span class="huge${value.length > 11 ? " long" : ""}" id="yield">${esc(value || "no limits")}</span>`
      + `<span>${one.verdict ? `<span class="st ${one.verdict}">${MARK[one.verdict]}${WORD[one.verdict]}</span>` : ""}${one.target_yield !== null ? `<br><span class="soft">target ${esc(Number((100 * one.target_yield).toPrecision(12)))} %</span>` : ""}</span>`
      + `<span class="soft">${esc(row.interval ?? "")}</span><span class="soft">${esc(row.rejects ?? "").replaceAll(", ", "<br>")}</span></div>${result.densities[i]}`
      + `<dl class="nums">${[["Cpk", row.Cpk], [`mean${unit}`, row.mean], [`σ${unit}`, row.sigma], ["worst case", row.worst]].map(([title, text]) => `<div><dt>${title}</dt><dd>${esc(text ?? "?")}</dd></div>`).join("")}</dl>`
      + warnings.map((warning) => `<p class="warn">${esc(warning.message)} <code>${esc(warning.code)}</code></p>`).join("")
      + drives(one)
      + `<p class="foot">${result.report.evaluations} evaluation${result.report.evaluations === 1 ? "" : "s"}, ${Math.round(result.took)} ms, ${served === null ? "all in this page. Nothing is sent anywhere" : "by sensitol on this machine"}.</p>`;
  };
  $("kc-tabs").onclick = (event) => { const chosen = event.target.closest("button"); if (chosen) choose(+chosen.dataset.i); };

  // ---------- panels
  document.querySelector(".tabs").onclick = (event) => { const chosen = event.target.closest("button"); if (chosen) { tab = chosen.dataset.tab; panel(); } };
  const PANELS = {
    allocate: () => `<div class="row"><label>Costs<select id="cost"><option value="">those of the study, or relative ones</option><option value="tolerance-unit">tolerance unit by tolerance</option><option value="constant-precision">one grade everywhere</option><option value="equal-shares">equal shares</option></select></label><button type="button" class="b p" id="go">Allocate</button><button type="button" class="b" id="stop" hidden>Stop</button><span class="soft">The cheapest tolerances that keep every target yield</span></div><div id="answer" role="status"></div>`,
    simulate: () => `<div class="row"><label>Points<select id="points"><option value="100000">100 000</option><option value="1000000" selected>1 000 000</option><option value="4000000">4 000 000</option></select></label><button type="button" class="b p" id="go">Simulate</button><button type="button" class="b" id="stop" hidden>Stop</button><span class="soft">The formula itself at random points</span></div><div id="answer" role="status"></div>`,
    sweep: () => `<div class="row"><label>Over<select id="over">${state.dims.filter((dim) => dim.name).map((dim) => `<option>${esc(dim.name)}</option>`).join("")}</select></label><label>From<input id="from"></label><label>To<input id="to"></label><button type="button" class="b p" id="go">Sweep</button><button type="button" class="b" id="stop" hidden>Stop</button></div><div id="answer" role="status"></div>`,
  };
  const panel = () => {
    document.querySelectorAll(".tabs button").forEach((button) => button.setAttribute("aria-selected", button.dataset.tab === tab));
    $("panel").setAttribute("aria-labelledby", `tab-${tab}`);
    $("panel").innerHTML = PANELS[tab]();
    $("go").onclick = { allocate, simulate, sweep }[tab];
    if (tab === "sweep") {
      const range = () => {
        const dim = result?.report.dimensions.find((one) => one.name === $("over").value);
        if (!dim) return;
        const [low, high] = dim.tolerance ?? [dim.mean - 3 * dim.sigma - dim.nominal, dim.mean + 3 * dim.sigma - dim.nominal];
        $("from").value = Number((dim.nominal + low).toPrecision(6));
        $("to").value = Number((dim.nominal + high).toPrecision(6));
      };
      $("over").onchange = range;
      range();
    }
  };
  const failed = (found) => `<p class="missed"><b>${esc(found.faults ? found.faults.map((fault) => `${fault.key}: ${fault.fault}${fault.help ? ` (${fault.help})` : ""}`).join("; ") : found.error)}</b> ${esc((found.advice ?? []).join(" "))}</p>`;
  // Asks the second worker, and shows what comes of it; `counted` shows how far it is.
  const answered = async (asked, forms, show, counted) => {
    const answer = $("answer"), go = $("go"), stop = $("stop");
    go.disabled = true;
    answer.innerHTML = "<p class=\"soft\">Computing …</p>";
    // What takes long can be stopped.
    stop.hidden = program === null && asked.command !== "simulate";
    stop.onclick = () => tools.stop();
    const shown = (...counts) => { const text = answer.querySelector("p"); if (text && program !== null) text.textContent = progress(...counts); else counted?.(...counts); };
    try {
      const found = await tools.ask("run", task(source().text, { asked, forms }), shown, true);
      if (answer.isConnected) answer.innerHTML = found.json === undefined ? failed(found) : show(found, JSON.parse(found.json));
      return found;
    } catch (error) {
      if (answer.isConnected) answer.innerHTML = error.message === "stopped" ? "<p class=\"soft\">Stopped. Nothing is kept of it.</p>" : `<p class="missed">${esc(error.message)}</p>`;
      return undefined;
    } finally {
      go.disabled = false;
      stop.hidden = true;
    }
  };
  const two = (value) => Number(value.toPrecision(3));
  const allocate = async () => {
    const cost = $("cost").value || undefined;
    const found = await answered({ command: "allocate", cost }, ["json"], (found, report) => {
      const rows = report.tolerances.map((one) => `<tr><th scope="row">${esc(one.dimension)}</th><td class="r">${two(one.before)}</td><td class="r">${two(one.after)}</td><td class="r">${((100 * one.after) / one.before - 100).toFixed(0).replace("-", "−")} %</td></tr>`).join("");
      const kept = report.requirements.map((one) => `${one.characteristic}: ${one.requirement} ${one.requirement === "yield" ? `${(100 * one.required).toPrecision(5)} %` : one.required}, ${one.verdict ?? "unknown"}`).join("; ");
      const better = report.cost_before !== null && report.cost_after !== null ? (report.cost_after <= report.cost_before ? `${(100 * (1 - report.cost_after / report.cost_before)).toFixed(1)} % cheaper` : `${(100 * (report.cost_after / report.cost_before - 1)).toFixed(1)} % dearer`) : report.status;
      const because = report.attainable ? `<p class="missed"><b>Not attainable:</b> ${esc(report.attainable.characteristic)} reaches ${report.attainable.best === null ? "an unknown value" : esc(report.attainable.best)} at best${report.attainable.because.length > 0 ? `; in the way: ${esc(report.attainable.because.join(", "))}` : ""}.</p>` : "";
      if (rows === "") return `${because || `<p class="missed"><b>${esc(report.status)}</b></p>`}`;
      return `<p><b>${better}</b> (${esc(report.status)}). ${esc(kept)}</p>${because}<table class="t"><caption class="sr">Half tolerances before and after</caption><thead><tr><th scope="col">dimension</th><th scope="col" class="r">half tolerance</th><th scope="col" class="r">proposed</th><th scope="col" class="r">change</th></tr></thead><tbody>${rows}</tbody></table>`
        + (found.study ? "<div class=\"under\"><button type=\"button\" class=\"b\" id=\"take\">Take over</button><span class=\"soft\">One step of undo</span></div>" : `<p class="soft">${esc(found.not_written ?? "")}</p>`);
    });
    if (found?.study && $("take")) {
      $("take").onclick = async () => {
        const read = await live.ask("study", task(found.study));
        if (!read.faults) { const step = now(); [state, original] = [study.of(read.study), null]; keep(step); original = found.study; all(); toast("Tolerances taken over"); }
      };
    }
  };
  const simulate = async () => {
    const total = +$("points").value;
    await answered({ command: "simulate", samples: total }, ["json", "html"], (found, report) => {
      const table = parsed(found.html).querySelector("section table");
      table.className = "t";
      return `<p class="soft">${report.samples.toLocaleString("en").replaceAll(",", "\u202f")} points in ${report.wall_s.toFixed(1)} s</p>${table.outerHTML}`;
    }, (answered) => { const text = $("answer")?.querySelector("p"); if (text) text.textContent = `${answered.toLocaleString("en").replaceAll(",", "\u202f")} points …`; });
  };
  const sweep = async () => {
    const [from, to] = ["from", "to"].map((id) => Number(study.number($(id).value) ?? NaN));
    if (!(Number.isFinite(from) && Number.isFinite(to) && from < to)) { $("answer").innerHTML = "<p class=\"missed\">From and to must be numbers, the first below the second.</p>"; return; }
    const values = Array.from({ length: 25 }, (_, i) => from + ((to - from) * i) / 24);
    await answered({ command: "sweep", over: $("over").value, values }, ["json"], (_, report) => drawn(report, values));
  };
  const ticks = (low, high, most) => {
    const rough = (high - low) / most, power = 10 ** Math.floor(Math.log10(rough)), unit = [1, 2, 5, 10].find((by) => by * power >= rough) * power;
    const found = [];
    for (let i = Math.ceil(low / unit - 1e-9); i * unit <= high + 1e-9 * unit; i += 1) found.push(Number((i * unit).toPrecision(10)));
    return found;
  };
  const drawn = (report, values) => {
    const one = report.characteristics[Math.min(selected, report.characteristics.length - 1)];
    const points = one.points.map((point, i) => ({ x: values[i], mean: point.mean, low: point.q_0_00135 ?? point.quantiles?.["0.00135"] ?? null, high: point.q_0_99865 ?? point.quantiles?.["0.99865"] ?? null })).filter((point) => point.mean !== null);
    if (points.length < 2) return "<p class=\"missed\">The model has no value along this range.</p>";
    const width = Math.max(340, Math.min(720, $("answer").clientWidth)), height = 240, left = 56, right = width < 500 ? 64 : 110;
    const banded = points.every((point) => point.low !== null && point.high !== null), ends = [one.lower, one.upper].filter((end) => end !== null && end !== undefined);
    const ys = points.flatMap((point) => (banded ? [point.low, point.high] : [point.mean])).concat(ends), [low, high] = [Math.min(...ys), Math.max(...ys)], pad = 0.06 * (high - low || 1);
    const X = (x) => left + ((x - values[0]) / (values.at(-1) - values[0])) * (width - left - right), Y = (y) => height - 28 - ((y - low + pad) / (high - low + 2 * pad)) * (height - 40);
    const path = (key) => points.map((point, i) => `${i ? "L" : "M"}${X(point.x).toFixed(1)} ${Y(point[key]).toFixed(1)}`).join("");
    let svg = banded ? `<path class="band" d="${path("low")}${points.toReversed().map((point) => `L${X(point.x).toFixed(1)} ${Y(point.high).toFixed(1)}`).join("")}Z"/>` : "";
    svg += `<path class="law" d="${path("mean")}"/><path class="axis" d="M${left} ${height - 28}H${width - right}"/>`;
    ticks(values[0], values.at(-1), width < 500 ? 3 : 6).forEach((x) => { svg += `<path class="axis" d="M${X(x)} ${height - 28}v4"/><text x="${X(x)}" y="${height - 10}" text-anchor="middle">${x}</text>`; });
    ticks(low, high, 5).forEach((y) => { svg += `<text x="${left - 8}" y="${Y(y) + 4}" text-anchor="end">${y}</text>`; });
    for (const [end, word] of [[one.lower, "lower"], [one.upper, "upper"]]) if (end !== null && end !== undefined) svg += `<path class="limit" d="M${left} ${Y(end)}H${width - right}"/><text class="k" x="${left + 6}" y="${Y(end) - 6}">${word} ${end}</text>`;
    const last = points.at(-1), labels = [["mean", last.mean, "k"], ...(banded ? [["0.135 %", last.low, ""], ["99.865 %", last.high, ""]] : [])].sort((a, b) => b[1] - a[1]);
    let above = -Infinity;
    for (const [word, y, cls] of labels) { above = Math.max(Y(y) + 4, above + 13); svg += `<text${cls && ` class="${cls}"`} x="${width - right + 6}" y="${above}">${word}</text>`; }
    return `<svg class="ch" viewBox="0 0 ${width} ${height}" role="img" aria-label="${esc(`${one.name} over ${report.parameter.name} from ${values[0]} to ${values.at(-1)}: mean from ${two(points[0].mean)} to ${two(last.mean)}`)}">${svg}</svg>`;
  };

  // ---------- files, sharing, examples
  const save = (file, text, type) => {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([text], { type }));
    link.download = file;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  };
  const stem = () => name.replace(/\.(toml|json)$/, "").replace(/^.*\//, "") || "study";
  $("download").onclick = async (event) => {
    const asked = event.target.closest("[data-download]")?.dataset.download;
    if (asked === undefined) return;
    const text = typed ?? source().text;
    if (asked === "study") save(`${stem()}.toml`, text, "application/toml");
    else {
      const found = await live.ask("run", task(text, { asked: { command: "analyze" }, forms: [asked === "report" ? "html" : "tables"] }), undefined, true);
      if (found.html) save(`${stem()}.html`, found.html, "text/html");
      else if (found.tables) Object.entries(found.tables).forEach(([file, csv]) => save(file, csv, "text/csv"));
      else toast("The study has faults: mend them first");
    }
    $("download").open = false;
  };
  const packed = (bytes) => btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join("")).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
  const piped = async (bytes, through) => new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(through)).arrayBuffer());
  $("share").onclick = async () => {
    const text = JSON.stringify({ text: typed ?? source().text, name, files });
    history.replaceState(null, "", `#s=${packed(await piped(new TextEncoder().encode(text), new CompressionStream("deflate-raw")))}`);
    try { await navigator.clipboard.writeText(location.href); toast("Link copied: the study is in the link itself"); } catch { toast("The study is in the address of this page"); }
  };
  const shared = async () => {
    const bytes = Uint8Array.from(atob(location.hash.slice(3).replaceAll("-", "+").replaceAll("_", "/")), (digit) => digit.charCodeAt(0));
    return JSON.parse(new TextDecoder("utf-8", { fatal: true }).decode(await piped(bytes, new DecompressionStream("deflate-raw"))));
  };
  // What a browser may refuse to keep is not kept.
  const stored = (change) => { try { return change(localStorage); } catch { return null; } };
  const remember = () => stored((storage) => { if (storage.getItem(`${KEPT}-off`) === null) storage.setItem(KEPT, JSON.stringify({ text: source().text, name, files })); });
  $("keep").checked = stored((storage) => storage.getItem(`${KEPT}-off`) === null) ?? false;
  $("keep").onchange = () => stored((storage) => { if ($("keep").checked) { storage.removeItem(`${KEPT}-off`); remember(); } else { storage.removeItem(KEPT); storage.setItem(`${KEPT}-off`, "1"); } });
  $("examples-list").innerHTML = examples.map((one, i) => `<button type="button" data-i="${i}">${esc(one.title)}<small>${esc(one.teaches)}</small></button>`).join("");
  $("examples-menu").hidden = examples.length === 0;
  $("examples-list").onclick = async (event) => {
    const chosen = event.target.closest("button");
    if (chosen === null) return;
    const step = now();
    await open({ ...examples[+chosen.dataset.i], files: {} });
    past.push(step);
    told();
    chosen.closest("details").open = false;
  };
  document.addEventListener("click", (event) => document.querySelectorAll("details.menu[open]").forEach((menu) => { if (!menu.contains(event.target)) menu.open = false; }));
  document.addEventListener("keydown", (event) => { if (event.key === "Escape") document.querySelectorAll("details.menu[open]").forEach((menu) => { menu.open = false; menu.querySelector("summary").focus(); }); });

  // Shows a study from its text; what is wrong with it is shown as text.
  const open = async (one) => {
    [name, files] = [one.name ?? "study.toml", one.files ?? {}];
    const found = await live.ask("study", task(one.text));
    [fresh, selected, typed, result] = [true, 0, null, null];
    if (found.faults) {
      [state, typed, view] = [study.empty(), one.text, "toml"];
      $("toml").value = one.text;
    } else {
      [state, original, view] = [study.of(found.study), one.text, "table"];
      [kind, program] = [kindOf(), found.program ?? null];
    }
    all();
  };
  const all = () => {
    $("title").value = state.title;
    if (typed === null && view === "toml") $("toml").value = source().text;
    grid();
    cards();
    loop();
    kinds();
    views();
    panel();
    told();
    run();
  };

  const begin = async () => {
    $("kinds").innerHTML = study.KINDS.map((one) => `<option value="${one}">`).join("");
    $("units").innerHTML = study.UNITS.map((one) => `<option value="${one}">`).join("");
    if (served === null) await engine.load();
    models = await live.ask("models");
    $("model").innerHTML = models.map((one) => `<option value="${esc(one.name)}">${esc(one.name)}</option>`).join("");
    aboutModel();
    if (served !== null) return folder.begin();
    const given = data("study-data"), kept = stored((storage) => storage.getItem(KEPT));
    if (location.hash.startsWith("#s=")) {
      try { return await open(await shared()); } catch { toast("The link is damaged; an example is shown instead"); return open(examples[0]); }
    }
    if (given) return open(given);
    return open(kept ? JSON.parse(kept) : examples[0]);
  };
  $("analyze").onclick = () => { if (starts) live.stop(); else run(true); };
  // What is beside the page is read before it begins.
  setTimeout(() => begin().catch((error) => { $("out").innerHTML = `<p class="missed"><b>The engine did not start.</b> ${esc(error.message)}. The page needs a browser of 2023 or later.</p>`; }));
  return { open, toast, esc, name: () => name, rename: (to) => { name = to; }, text: () => typed ?? source().text };
})();
