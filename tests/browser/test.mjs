// Pages in a real browser: nothing complains, nothing is requested, sliders move numbers, and the numbers are the engine's.
// `node test.mjs SENSITOL CASES`, where CASES is what the suite left of pages, settings and the engine's answers.
import assert from "node:assert/strict";
import { execFile, execFileSync, spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { promisify } from "node:util";
import { pictures } from "./assembly.mjs";
import { Browser, installed } from "./chromium.mjs";
import { asGrey, changes, contrast, luminances } from "./grey.mjs";
import { FAULTS, MARGINS, SHEETS, filled } from "./paper.mjs";

const sensitol = process.env.SENSITOL, cases = process.env.SENSITOL_CASES;
const root = join(dirname(fileURLToPath(import.meta.url)), "..", "..");
const folder = mkdtempSync(join(tmpdir(), "sensitol-pages-"));
let browser;

before(async () => { browser = await Browser.start(); });
after(async () => {
  await browser.stop();
  rmSync(folder, { recursive: true, force: true });
});

const report = (command, study, name, more = []) => {
  const page = join(folder, `${name}-${command}.html`);
  // A missed target is no failure of the page.
  execFileSync(sensitol, [command, study, "--html", page, "-q", ...more], { cwd: root, stdio: ["ignore", "ignore", "inherit"] });
  return page;
};
const examples = () => readdirSync(join(root, "examples"), { recursive: true })
  .map(String).filter((path) => path.endsWith(".toml")).map((path) => join("examples", path)).sort();
const quiet = (page) => assert.deepEqual(page.complaints, []);
// Labels of a chart that lie over one another, by as much as a pixel.
const OVERLAPS = `(() => {
  const found = [];
  for (const svg of document.querySelectorAll("svg.density, svg.gauge, svg.tail, svg.assembly")) {
    const boxes = [...svg.querySelectorAll("text")].map((text) => [text.textContent, text.getBoundingClientRect()]).filter(([, box]) => box.width > 0);
    boxes.forEach(([a, p], i) => boxes.slice(i + 1).forEach(([b, q]) => {
      if (p.left < q.right - 1 && q.left < p.right - 1 && p.top < q.bottom - 2 && q.top < p.bottom - 2) found.push(a + " | " + b);
    }));
  }
  return found;
})()`;
const drawn = "[...document.querySelectorAll('svg.density')].filter((svg) => svg.getBoundingClientRect().width > 0).length";

/// Most pages of a print.
const MOST = 5;

/// On this sheet no page but the last is nearly empty, nothing is cut off, and no text of a chart is tiny.
const prints = async (page, sheet, what) => {
  const full = filled(await page.pdf(SHEETS[sheet]));
  assert.ok(full.length > 0 && full.at(-1) > 0, `${what} on ${sheet}`);
  assert.ok(full.length <= MOST, `${what} on ${sheet}: ${full.length} pages, at most ${MOST}`);
  full.slice(0, -1).forEach((part, i) => assert.ok(part > 1 / 3, `${what} on ${sheet}: page ${i + 1} of ${full.length} is ${(100 * part).toFixed(0)} % full`));
  await page.asPaper(96 * SHEETS[sheet][0] - 2 * MARGINS[1] * 96 / 72);
  assert.deepEqual(await page.evaluate(FAULTS), [], `${what} on ${sheet}`);
};

test("every page of every example opens without a complaint or a request, and every analysis prints", async () => {
  // Two at once: one is computed while the browser draws the other.
  const left = examples();
  const next = async () => {
    for (let study = left.shift(); study !== undefined; study = left.shift()) await opens(study);
  };
  await Promise.all([next(), next()]);
});

const WORDS = { met: "Met", missed: "Missed", inconclusive: "Inconclusive" };

/// The page, the report's data and the exit code of `--check` say the same of every characteristic that is judged.
const judges = async (page, found, study) => {
  const WORST = ["missed", "inconclusive", "met"];
  const verdicts = (one) => (one?.requirements?.length > 0 ? one.requirements : [one]).map((judged) => judged?.verdict).filter((verdict) => verdict);
  const worst = (all) => WORST.find((verdict) => all.includes(verdict));
  const shown = found.characteristics.filter((one) => one.lower !== null || one.upper !== null || verdicts(one).length > 0);
  const rows = await page.evaluate("[...document.querySelectorAll('.gauges tbody tr:not(.all)')].map((row) => row.cells[1].textContent)");
  assert.deepEqual(rows, shown.map((one) => verdicts(one).map((verdict) => WORDS[verdict]).join("") || "no target"), study);
  const all = [...found.characteristics, found.joint_requirement].flatMap(verdicts);
  const { status } = spawnSync(sensitol, ["analyze", study, "--check", "-q", "--journal", "none"], { cwd: root });
  assert.equal(status, { missed: 1, inconclusive: 3, met: 0 }[worst(all)] ?? 2, `${study} --check: ${all}`);
};

const opens = async (study) => {
  const name = study.replaceAll(/[/.]/g, "-"), text = readFileSync(join(root, study), "utf8");
  // What an adapter wants to know of its document is no study, and what it evaluates may not be installed.
  if (/^(document|servers) =/m.test(text) || (text.includes("command = ") && !study.includes("external-python"))) return;
  const pages = [["analyze", ["--journal", "none"]], ["simulate", ["--samples", "500", "--journal", "none"]]];
  if (!study.includes("external")) pages.push(["compare", ["--samples", "2048", "--budget", "300"]]);
  if (study.includes("stacked-blocks/")) pages.push(["sweep", ["--over", "th=15:19:5"]]);
  // A front is one of yield or Cpk.
  if (text.includes("[costs")) pages.push(["allocate", text.includes("require = \"") ? [] : ["--pareto", "4"]]);
  for (const [command, more] of pages) {
    const file = join(folder, `${name}-${command}.html`);
    const analysis = command === "analyze";
    const { stdout } = await promisify(execFile)(sensitol, [command, study, "--html", file, "-q", ...(analysis ? ["--json"] : []), ...more], { cwd: root, maxBuffer: 1e8 });
    for (const options of [{}, { dark: true }, { width: 360, height: 740 }]) {
      const page = await browser.open(file, options);
      quiet(page);
      assert.ok(await page.evaluate("document.querySelectorAll('section h2').length") > 1, file);
      const wider = await page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth");
      assert.ok(wider <= 0, `${file} is ${wider} pixels wider than a window of ${options.width ?? 1280}`);
      assert.deepEqual(await page.evaluate(OVERLAPS), [], file);
      // Each chart is there twice, and one of the two is seen.
      assert.equal(2 * await page.evaluate(drawn), await page.evaluate("document.querySelectorAll('svg.density').length"), file);
      if (Object.keys(options).length === 0 && analysis) {
        await judges(page, JSON.parse(stdout), study);
        await prints(page, "A4", file);
      }
      await page.close();
    }
  }
};

const TEXTS = "JSON.stringify([...document.querySelectorAll('[data-kc] [data-figure]')].map((cell) => cell.textContent))";
const SET = `(i, what, value, kind = "number") => {
  const input = document.querySelector(\`[data-dimension="\${i}"] [data-\${kind}="\${what}"]\`);
  input.value = value;
  input.dispatchEvent(new Event("input", { bubbles: true }));
}`;
const FRAME = "new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)))";

test("sliders and boxes change the numbers, and the study comes back", async () => {
  const page = await browser.open(report("analyze", "examples/stacked-blocks/study.toml", "sliders"));
  const texts = async () => JSON.parse(await page.evaluate(TEXTS));
  const analysed = await texts();
  assert.ok(analysed.length >= 8);
  const shown = [analysed];
  for (const [what, value, kind] of [["factor", 50, "set"], ["shift", 40, "set"], ["factor", 0.2, "number"], ["shift", -0.1, "number"]]) {
    await page.evaluate(`(${SET})(4, "${what}", ${value}, "${kind}")`);
    await page.evaluate(FRAME);
    const now = await texts();
    assert.ok(!shown.some((before) => JSON.stringify(before) === JSON.stringify(now)), `${what} ${value} changes something`);
    shown.push(now);
  }
  assert.match(await page.evaluate("document.getElementById('toml').value"), /^f = \{.*shift = -0\.1 \}$/m);
  await page.evaluate("document.getElementById('reset').click()");
  await page.evaluate(FRAME);
  assert.deepEqual(await texts(), analysed);
  await page.evaluate(`(${SET})(0, "factor", -1)`);
  assert.equal(await page.evaluate("document.querySelector('[data-dimension=\"0\"] [data-number=\"factor\"]').validity.valid"), false);
  quiet(page);
  await page.close();
});

test("the verdict says what the report's data say", async () => {
  for (const study of ["examples/first-study/study.toml", "examples/shaft-and-bore/study.toml", "examples/stacked-blocks/study.toml", "examples/two-suppliers/study.toml"]) {
    const page = await browser.open(report("analyze", study, `verdict-${study.replaceAll("/", "-")}`));
    const rows = await page.evaluate("[...document.querySelectorAll('.gauges tbody tr:not(.all)')].map((row) => [...row.cells].map((cell) => cell.textContent))");
    // A worst case that the text calls proven is that of the verdict and of the density.
    const [, ...proven] = spawnSync(sensitol, ["analyze", study, "-q"], { cwd: root, encoding: "utf8" }).stdout.match(/proven worst case +(\S+) \.\. (\S+)/) ?? [];
    if (proven.length > 0) {
      assert.ok(rows.some((row) => row.includes(proven.join(" –"))), `${study}: ${proven}`);
      assert.ok(await page.evaluate("document.querySelector('svg.density').getAttribute('aria-label')").then((label) => label.includes(`worst case, proven ${proven.join(" to ")}`)), study);
    }
    // Every number of a density is in what is read aloud.
    const labels = await page.evaluate("[...document.querySelectorAll('svg.density.wide')].map((svg) => [svg.getAttribute('aria-label'), [...svg.querySelectorAll('text.name, text.rejected')].map((text) => text.textContent.split(' ').at(text.classList.contains('name') ? -1 : 0))])");
    for (const [label, numbers] of labels) numbers.forEach((number) => assert.ok(label.includes(number), `${number} is not in: ${label}`));
    if (process.env.AXE) {
      await page.evaluate(readFileSync(process.env.AXE, "utf8"));
      const found = await page.evaluate("axe.run(document, { resultTypes: ['violations'] }).then((all) => all.violations.map((one) => `${one.id}: ${one.nodes.map((node) => node.html.slice(0, 160)).slice(0, 3).join(' | ')}`))");
      assert.deepEqual(found, [], study);
    }
    quiet(page);
    await page.close();
  }
});

test("costs follow the sliders, and only where there are costs", async () => {
  const page = await browser.open(report("analyze", "examples/first-study/study.toml", "costs"));
  const cost = () => page.evaluate("document.getElementById('cost').textContent");
  // 1 + 0.2/0.1 for the housing and 2 + 0.24/0.06 for the bearing.
  assert.equal(await cost(), "9.00000");
  await page.evaluate(`(${SET})(0, "factor", 0.05)`);
  await page.evaluate(FRAME);
  assert.equal(await cost(), "11.0000 (22.22 % more)");
  quiet(page);
  await page.close();
  const free = await browser.open(report("analyze", "examples/stacked-blocks/study.toml", "no-costs"));
  assert.equal(await free.evaluate("document.getElementById('cost')"), null);
  quiet(free);
  await free.close();
});

test("the browser computes what the engine computes", async () => {
  const files = readdirSync(cases).filter((file) => file.endsWith(".expected.json"));
  assert.ok(files.length >= 5, "the suite left its cases");
  for (const file of files) {
    const name = file.replace(".expected.json", "");
    const expected = JSON.parse(readFileSync(join(cases, file), "utf8"));
    const settings = readFileSync(join(cases, `${name}.settings.json`), "utf8");
    const page = await browser.open(join(cases, `${name}.html`));
    const found = JSON.parse(await page.evaluate(`JSON.stringify((() => {
      const data = JSON.parse(document.getElementById("data").textContent);
      return ${settings}.map((setting) => data.characteristics.map((one) => {
        const { mean, sigma, skewness, excess, shares: [below, above], cpk, by } = live.evaluate(data, one, setting);
        return { mean, sigma, skewness, excess, below: below?.value ?? null, above: above?.value ?? null, cpk, by, errors: { below: below?.error, above: above?.error } };
      }));
    })())`));
    assert.equal(found.length, 200);
    found.forEach((of, i) => of.forEach((one, c) => {
      const wanted = { ...expected[i][c] }, scales = { mean: wanted.sigma, sigma: 0, skewness: 1, excess: 1, below: 1e-6, above: 1e-6, cpk: 1 };
      // Points say what settings change within their own error; the engine has computed the law of some of these settings.
      if (one.by === "points") {
        for (const key of ["below", "above"]) {
          delete scales[key];
          const law = wanted.surface[key];
          if (law !== null && law[0] !== null) assert.ok(Math.abs(one[key] - law[0]) <= one.errors[key] + law[1], `${name} ${i}: ${key} ${one[key]} ${law}`);
        }
      }
      if (one.by === "surface") {
        for (const key of ["below", "above"]) {
          delete scales[key];
          const law = wanted.surface[key];
          if (law === null) assert.equal(one[key], null);
          else assert.ok(Math.abs(one[key] - law[0]) <= one.errors[key] + law[1] + 1e-9 * law[0] + 1e-14, `${name} ${i}: ${key} ${one[key]} ${law}`);
        }
      }
      for (const [key, scale] of Object.entries(scales)) {
        if (wanted[key] === null) assert.equal(one[key], null);
        else assert.ok(Math.abs(one[key] - wanted[key]) <= 1e-9 * Math.max(Math.abs(wanted[key]), scale), `${name} ${i}: ${key} ${one[key]} ${wanted[key]}`);
      }
    }));
    quiet(page);
    await page.close();
  }
});

test("what is copied analyses to what the page shows", async () => {
  // Of second degree, so that the surrogate is the function itself.
  const rest = `[characteristics]
y = { formula = "a*a + c*c - a*c + 4*b", lower = 96, upper = 120 }
[analysis]
method = "full"
`;
  const study = join(folder, "copied.toml");
  writeFileSync(study, `[dimensions]
a = { nominal = 10, tolerance = [-0.1, 0.3], unit = "mm" }
b = { nominal = 4, limits = [3.8, 4.2], distribution = "uniform" }
c = { nominal = 1, sigma = 0.05 }
${rest}`);
  const page = await browser.open(report("analyze", study, "copied"));
  for (const [i, what, value] of [[0, "factor", 0.11], [0, "shift", 0.07], [1, "factor", 0.3], [1, "shift", -0.05], [2, "factor", 0.4], [2, "shift", 0.01]]) {
    await page.evaluate(`(${SET})(${i}, "${what}", ${value})`);
  }
  await page.evaluate(FRAME);
  const shown = JSON.parse(await page.evaluate(TEXTS));
  const pasted = join(folder, "pasted.toml");
  writeFileSync(pasted, await page.evaluate("document.getElementById('toml').value") + rest);
  const again = await browser.open(report("analyze", pasted, "pasted"));
  assert.deepEqual(JSON.parse(await again.evaluate(TEXTS)), shown);
  quiet(page);
  await page.close();
  await again.close();
});

// One of every command, and those with the widest tables, the most dimensions and a map of interactions.
const PRINTED = [
  ["analyze", "first-study"], ["analyze", "stacked-blocks"], ["analyze", "bearing-housing"], ["analyze", "engine-balance"],
  ["simulate", "shaft-and-bore", ["--samples", "2000"]], ["simulate", "stacked-blocks", ["--rare", "--samples", "600"]],
  ["compare", "stacked-blocks", ["--samples", "2048", "--budget", "300"]], ["sweep", "stacked-blocks", ["--over", "th=15:19:9"]],
  ["allocate", "shaft-and-housing", ["--pareto", "4"]],
];

test("pages print on A4 and Letter: no page nearly empty, nothing cut off, no tiny text", async () => {
  for (const [command, name, more = []] of PRINTED) {
    const page = await browser.open(report(command, `examples/${name}/study.toml`, `paper-${name}${more.length}`, more));
    for (const sheet of Object.keys(SHEETS)) await prints(page, sheet, `${command} ${name}`);
    quiet(page);
    await page.close();
  }
});

// Maps are printed for one characteristic alone; here they are for several.
const PRINTS = "document.querySelectorAll('.on-screen').forEach((one) => one.classList.remove('on-screen'))";

test("without colour, on paper, verdicts, limits and what was not evaluated can be told apart", async () => {
  const study = join(folder, "grey.toml");
  // Of a normal law 99 % lie within 2.576 sigmas: 2000 samples do not say whether 99 % do.
  writeFileSync(study, `[dimensions]
a = { nominal = 10, sigma = 1 }
[characteristics]
wide = { formula = "a", lower = 5, upper = 15, target_yield = 0.9 }
narrow = { formula = "a + 0", lower = 9, upper = 11, target_yield = 0.9 }
open = { formula = "2*a", lower = 14.848, upper = 25.152, target_yield = 0.99 }
`);
  const page = await browser.open(report("simulate", study, "grey", ["--samples", "2000"]));
  await asGrey(page, 700);
  const words = await page.evaluate("[...document.querySelectorAll('.gauges tbody .st')].slice(0, 3).map((one) => one.textContent.trim())");
  assert.equal(new Set(words).size, 3, words.join());
  const marks = [];
  for (const index of [0, 1, 2]) marks.push(await luminances(page, ".gauges tbody .st svg", index));
  for (const mark of marks) assert.ok(contrast(Math.min(...mark.flat()), Math.max(...mark.flat())) >= 4.5);
  const apart = (a, b) => {
    const flat = a.flatMap((row, y) => row.map((value, x) => (value < 0.4) !== ((b[y]?.[x] ?? 1) < 0.4)));
    return flat.filter(Boolean).length / flat.length;
  };
  // A tenth of the mark is another shape, whatever its grey.
  for (const [a, b] of [[0, 1], [0, 2], [1, 2]]) assert.ok(apart(marks[a], marks[b]) > 0.1, `${words[a]} and ${words[b]} look alike`);
  quiet(page);
  await page.close();

  const mapped = await browser.open(report("analyze", "examples/bearing-housing/study.toml", "grey-map"));
  await mapped.evaluate(PRINTS);
  await asGrey(mapped, 700);
  // A limit against the density and the part beyond it, three pixels to either side of it, in the middle of the picture.
  const drawing = await luminances(mapped, "svg.density");
  const limits = await mapped.evaluate(`(() => {
    const svg = [...document.querySelectorAll("svg.density")].find((one) => one.getBoundingClientRect().height > 0), { left } = svg.getBoundingClientRect();
    return [...svg.querySelectorAll("path.limit")].map((one) => { const box = one.getBoundingClientRect(); return (box.left + box.right) / 2 - left; });
  })()`);
  assert.ok(limits.length > 0);
  for (const at of limits) {
    const row = drawing[Math.round(drawing.length / 2)], x = Math.round(2 * at);
    const line = Math.min(...row.slice(x - 2, x + 3));
    for (const beside of [row[x - 8], row[x + 8]]) assert.ok(beside === undefined || contrast(line, beside) >= 3, `a limit at ${at} in ${beside}`);
  }
  // A grey has no lines along the upper edge of a cell, above its number.
  let greys = 0;
  for (const level of ["g1", "g2", "g3", "g4"]) {
    if (await mapped.evaluate(`document.querySelectorAll(".map td.${level}:not(.own)").length`) === 0) continue;
    const cell = await luminances(mapped, `.map td.${level}:not(.own)`);
    assert.ok(changes(cell[Math.round(cell.length / 8)].slice(3, -3)) <= 1, level);
    greys += 1;
  }
  assert.ok(greys > 0);
  await mapped.close();

  // Hatching has lines. The map of a connecting rod has pairs that were not examined, in cells without a number.
  const pairs = await browser.open(report("analyze", "examples/connecting-rod/study.toml", "grey-pairs"));
  await pairs.evaluate(PRINTS);
  await asGrey(pairs, 700);
  const hatched = await luminances(pairs, ".map td.hatched"), middle = hatched[Math.round(hatched.length / 2)];
  assert.ok(changes(middle) >= 6, `hatching changes ${changes(middle)} times`);
  await pairs.close();
});

test("pages of all commands have the parts of a review, and pass axe", async () => {
  for (const [command, name, more = []] of PRINTED.slice(4)) {
    const file = report(command, `examples/${name}/study.toml`, `parts-${name}${more.length}`, more);
    for (const options of [{}, { dark: true }, { width: 390, height: 844 }]) {
      const page = await browser.open(file, options);
      for (const part of ["verdict", "summary", "sure", "about", "terms"]) {
        assert.equal(await page.evaluate(`document.querySelectorAll("h2#${part}").length`), 1, `${command} ${name}: ${part}`);
      }
      assert.ok(await page.evaluate("document.querySelectorAll('.gauges .gauge').length") > 0, command);
      // No warning after the figures: the last section has none.
      assert.equal(await page.evaluate("document.getElementById('about').parentElement.querySelector('.warnings')"), null);
      // Every name of a plot is in what is read aloud, and the ends of every band.
      const silent = await page.evaluate("[...document.querySelectorAll('svg.plot')].flatMap((svg) => [...svg.querySelectorAll('.of-mark, .of-best, .of-other')].flatMap((text) => text.textContent.split(', ')).filter((text) => !svg.getAttribute('aria-label').includes(text)))");
      assert.deepEqual(silent, [], command);
      if (process.env.AXE) {
        await page.evaluate(readFileSync(process.env.AXE, "utf8"));
        const found = await page.evaluate("axe.run(document, { resultTypes: ['violations'] }).then((all) => all.violations.map((one) => `${one.id}: ${one.nodes.map((node) => node.html.slice(0, 160)).slice(0, 3).join(' | ')}`))");
        assert.deepEqual(found, [], `${command} ${name} ${JSON.stringify(options)}`);
      }
      quiet(page);
      await page.close();
    }
  }
});

test("the first screen answers: title block, sentence, all verdicts, and the top of the first density", async () => {
  const study = join(folder, "first-screen.toml");
  writeFileSync(study, `title = "Cover"
[about]
part = "Cover"
drawing = "4711-002"
revision = "C"
author = "A. Engineer"
[dimensions]
a = { nominal = 10, tolerance = 0.3 }
b = { nominal = 6, tolerance = 0.1 }
[characteristics]
gap = { formula = "a - b", lower = 3.8, upper = 4.5, target_yield = 0.9973 }
sum = { formula = "a + b", lower = 14, upper = 18, target_yield = 0.99 }
`);
  const page = await browser.open(report("analyze", study, "first-screen"), { width: 1280, height: 900 });
  for (const part of [".block", ".lead", ".gauges"]) {
    assert.ok(await page.evaluate(`document.querySelector("${part}").getBoundingClientRect().bottom`) <= 900, part);
  }
  assert.equal(await page.evaluate("document.querySelectorAll('.gauges tbody tr').length"), 3);
  // A third of its height at least.
  const below = await page.evaluate("(() => { const { top, height } = document.querySelector('svg.density.wide').getBoundingClientRect(); return top + height / 3; })()");
  assert.ok(below <= 900, `the density begins at ${below}`);
  await page.close();
});

test("on a phone the verdict's yield is whole, and one line of the what-if stays on the screen", async () => {
  const page = await browser.open(report("analyze", "examples/stacked-blocks/study.toml", "phone"), { width: 390, height: 844 });
  const within = await page.evaluate("[...document.querySelectorAll('.gauges strong, .gauges .st, .gauges td.n')].every((one) => { const { left, right } = one.getBoundingClientRect(); return left >= 0 && right <= 390; })");
  assert.ok(within, "a figure of the verdict is cut off");
  const strip = () => page.evaluate("document.querySelector('.strip').innerText.trim()");
  assert.match(await strip(), /^gap 99\.\d+ %, Cpk \d\.\d{3}$/);
  await page.evaluate("document.querySelector('.tries').scrollIntoView()");
  await page.evaluate(`(${SET})(4, "factor", 0.9)`);
  await page.evaluate(FRAME);
  assert.match(await strip(), /^gap 99\.\d+ % → \d+\.\d+ %, Cpk \d\.\d{3} → \d\.\d{3}$/);
  const { top, bottom, height } = JSON.parse(await page.evaluate("JSON.stringify(document.querySelector('.strip').getBoundingClientRect())"));
  assert.ok(height <= 844 / 4 && top >= 0 && bottom <= 844.5, `the line lies at ${top} to ${bottom}`);
  quiet(page);
  await page.close();
});

test("everything behind the first screen is folded, and opens", async () => {
  const page = await browser.open(report("analyze", "examples/first-study/study.toml", "folds"));
  const seen = (what) => page.evaluate(`document.querySelector("${what}").getBoundingClientRect().height > 0 && document.querySelector("${what}").checkVisibility({ contentVisibilityAuto: true })`);
  assert.equal(await seen(".tails"), false);
  await page.evaluate("document.querySelectorAll('details').forEach((one) => { one.open = true; })");
  for (const what of [".tails", ".inputs", ".facts", ".terms"]) assert.equal(await seen(what), true, what);
  assert.deepEqual(await page.evaluate(OVERLAPS), []);
  if (process.env.AXE) {
    await page.evaluate(readFileSync(process.env.AXE, "utf8"));
    const found = await page.evaluate("axe.run(document, { resultTypes: ['violations'] }).then((all) => all.violations.map((one) => `${one.id}: ${one.nodes.map((node) => node.html.slice(0, 160)).slice(0, 3).join(' | ')}`))");
    assert.deepEqual(found, []);
  }
  quiet(page);
  await page.close();
});

test("--pdf prints by this browser, on the paper of the locale", () => {
  const file = join(folder, "print.pdf");
  for (const [locale, sheet] of [["de_DE.UTF-8", "A4"], ["en_US.UTF-8", "Letter"]]) {
    const env = { ...process.env, LC_ALL: locale, SENSITOL_CHROMIUM: installed() };
    execFileSync(sensitol, ["analyze", "examples/first-study/study.toml", "--pdf", file, "-q"], { cwd: root, env, stdio: ["ignore", "ignore", "inherit"] });
    const pdf = readFileSync(file), full = filled(pdf);
    assert.ok(full.length > 0 && full.length <= MOST, `${sheet}: ${full.length} pages`);
    const box = pdf.toString("latin1").match(/MediaBox \[0 0 (\S+) (\S+)\]/).slice(1).map(Number);
    // Chromium rounds to pixels.
    SHEETS[sheet].forEach((side, i) => assert.ok(Math.abs(72 * side - box[i]) < 1, `${sheet}: ${box}`));
  }
});

test("a picture of an assembly turns by keys, and a slider moves its parts", async () => {
  const file = report("analyze", "examples/shaft-two-bores/study.toml", "picture");
  await pictures(browser, file, readFileSync(file, "utf8"));
});

test("numbers of a sweep's chart are those of its data", async () => {
  const study = "examples/stacked-blocks/study.toml", over = ["--over", "th=15:19:5"];
  const page = await browser.open(report("sweep", study, "numbers", over));
  const { stdout } = spawnSync(sensitol, ["sweep", study, "--json", "-q", ...over], { cwd: root, encoding: "utf8" });
  const [{ points, lower, upper }] = JSON.parse(stdout).characteristics;
  const label = await page.evaluate("document.querySelector('svg.plot').getAttribute('aria-label')");
  const quantiles = (point) => Object.values(point.quantiles);
  for (const value of [points[0].mean, points.at(-1).mean, quantiles(points[0])[0], quantiles(points.at(-1)).at(-1)]) {
    assert.ok(label.includes(value.toPrecision(4)), `${value} is not in: ${label}`);
  }
  for (const limit of [`lower limit ${lower}`, `upper limit ${upper}`]) assert.ok(label.includes(limit), label);
  await page.close();
});

test("hostile names are shown as text", async () => {
  const name = "<img src=x onerror=alert(1)>", characteristic = "</script><script>alert(2)</script>", title = "<svg onload=alert(3)>";
  const study = join(folder, "hostile.json");
  writeFileSync(study, JSON.stringify({
    title,
    dimensions: { [name]: { nominal: 1, tolerance: 0.1, unit: "</style><b>mm" }, b: { nominal: 2, tolerance: 0.1 } },
    characteristics: { [characteristic]: { formula: `\`${name}\`*b`, lower: 1.8, upper: 2.2, target_yield: 0.9 } },
    costs: { [name]: { model: "reciprocal", a: 1, b: 0.1, min: 0.01, max: 0.2 } },
  }));
  const more = { sweep: ["--over", "b=1.9:2.1:3"] };
  for (const command of ["analyze", "simulate", "compare", "sweep", "allocate"]) {
    const page = await browser.open(report(command, study, "hostile", more[command]));
    quiet(page);
    assert.equal(await page.evaluate("document.querySelectorAll('img, b, iframe, svg[onload]').length"), 0);
    assert.equal(await page.evaluate("document.querySelector('h1').textContent"), title);
    const heading = command === "allocate" ? ".wide tbody th" : ".kc h2";
    const headings = await page.evaluate(`JSON.stringify([...document.querySelectorAll("${heading}")].map((one) => one.textContent))`);
    assert.ok(JSON.parse(headings).includes(characteristic), headings);
    await page.close();
  }
});

test("a page of 200 dimensions follows a slider", async () => {
  const file = join(cases, "two-hundred.html");
  assert.ok(existsSync(file));
  const page = await browser.open(file);
  const took = await page.evaluate(`(async () => {
    const set = ${SET}, times = [];
    for (let i = 0; i < 12; i++) {
      const begun = performance.now();
      set(i, "factor", 60 + i, "set");
      await ${FRAME};
      times.push(performance.now() - begun);
    }
    return times.sort((a, b) => a - b)[6];
  })()`);
  // Said, not asserted: a busy machine is no fault of the page.
  console.log(`200 dimensions, 19900 products: a slider is followed within ${took.toFixed(0)} ms`);
  quiet(page);
  await page.close();
});
