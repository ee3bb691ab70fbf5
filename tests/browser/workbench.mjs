// The workbench in a real browser: what an engineer does in it, from a spreadsheet to a study that the command line runs.
// `SENSITOL=program WORKBENCH=page AXE=axe.min.js node --test workbench.mjs`; without AXE nothing is said of accessibility.
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { Browser } from "./chromium.mjs";

const { SENSITOL: sensitol, WORKBENCH: workbench, AXE: axe } = process.env;
const root = join(dirname(fileURLToPath(import.meta.url)), "..", "..");
const folder = mkdtempSync(join(tmpdir(), "sensitol-workbench-"));
let browser;
before(async () => { browser = await Browser.start(); });
after(async () => { await browser.stop(); rmSync(folder, { recursive: true, force: true }); });

// A rod over a whole cycle takes seconds where two cores are free, and a minute where they are not.
const settled = async (page) => {
  for (let i = 0; i < 2400; i += 1) {
    if (await page.evaluate("document.documentElement.dataset.ready === '1'")) return;
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
  throw new Error(`the page does not settle: ${await page.evaluate("document.getElementById('out').textContent")}`);
};
// Its workers are the page's own: a request for anything else is a complaint.
const quiet = (page) => assert.deepEqual(page.complaints.filter((one) => !one.startsWith("request: blob:")), []);
const open = async (study, options = {}) => {
  const file = join(folder, `page-${Math.floor(1e9 * Math.random())}.html`);
  execFileSync(sensitol, ["workbench", ...(study ? [study] : []), "-o", file, "--page", workbench, "-q"], { cwd: root });
  const page = await browser.open(file, options);
  await page.evaluate(`window.saved = []; URL.createObjectURL = ((made) => (blob) => { if (blob.type !== "text/javascript") window.saved.push(blob.text()); return made.call(URL, blob); })(URL.createObjectURL)`);
  await settled(page);
  return page;
};
const text = (page, selector) => page.evaluate(`document.querySelector(${JSON.stringify(selector)})?.textContent ?? null`);
const click = (page, selector) => page.evaluate(`document.querySelector(${JSON.stringify(selector)}).click()`);
const type = async (page, selector, value) => {
  await page.evaluate(`(() => { const input = document.querySelector(${JSON.stringify(selector)}); input.focus(); input.value = ${JSON.stringify(value)}; input.dispatchEvent(new Event("input", { bubbles: true })); })()`);
  await settled(page);
};
const paste = async (page, selector, value) => {
  await page.evaluate(`(() => { const input = document.querySelector(${JSON.stringify(selector)}), data = new DataTransfer(); data.setData("text/plain", ${JSON.stringify(value)}); input.focus(); input.dispatchEvent(new ClipboardEvent("paste", { clipboardData: data, bubbles: true, cancelable: true })); })()`);
  await settled(page);
};
const until = async (page, expression) => {
  for (let i = 0; i < 1200; i += 1) {
    const found = await page.evaluate(expression);
    if (found) return found;
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
  throw new Error(`never: ${expression}; ${await page.evaluate("document.getElementById('answer')?.textContent")}`);
};
const cell = (row, column) => `#rows tr[data-i="${row}"] [data-column="${column}"]`;
const value = (page, selector) => page.evaluate(`document.querySelector(${JSON.stringify(selector)}).value`);
const downloaded = async (page, what) => {
  await page.evaluate("window.saved.length = 0");
  await click(page, `[data-download="${what}"]`);
  await until(page, "window.saved.length > 0");
  return page.evaluate("Promise.all(window.saved).then((all) => all.join('\\n'))");
};
const yields = (study) => {
  const run = spawnSync(sensitol, ["analyze", study, "--json", "-q"], { encoding: "utf8", cwd: root });
  return JSON.parse(run.stdout).characteristics.map((one) => one.yield);
};

test("1 and 10: a German spreadsheet is pasted, undone, done again, shared and downloaded, and the command line agrees", async () => {
  const page = await open("examples/shaft-and-bore/study.toml");
  const before = await downloaded(page, "study");
  // As the file has it, comments and all.
  assert.equal(before, readFileSync(join(root, "examples/shaft-and-bore/study.toml"), "utf8"));
  const sheet = "Name\tNennmaß\t+\t-\tEinheit\tVerteilung\nbore\t25,020\t0,022\t0,022\tmm\tuniform\nshaft\t24,980\t0\t0,013\tmm\t\n";
  const shown = await text(page, "#yield");
  await paste(page, cell(0, "name"), sheet);
  assert.equal(await value(page, cell(0, "nominal")), "25.020");
  assert.equal(await value(page, cell(0, "tolerance")), "0.022");
  assert.equal(await value(page, cell(1, "tolerance")), "-0.013 / 0");
  assert.equal(await value(page, cell(0, "distribution")), "uniform");
  const pasted = await text(page, "#yield");
  assert.notEqual(pasted, shown);
  await click(page, "#undo");
  await settled(page);
  assert.equal(await text(page, "#yield"), shown);
  await click(page, "#redo");
  await settled(page);
  assert.equal(await text(page, "#yield"), pasted);
  const study = join(folder, "downloaded.toml");
  writeFileSync(study, await downloaded(page, "study"));
  // The digits that the page shows are those of the program's yield.
  const printed = /^(> )?(\d+\.?(\d*)) %$/.exec(pasted), [exact] = yields(study);
  if (printed[1]) assert.ok(100 * exact > Number(printed[2]), `${pasted}, ${exact}`);
  else assert.equal((100 * exact).toFixed(printed[3].length), printed[2]);
  // The link has the study in it, and opens to the same figures.
  await click(page, "#share");
  const address = await until(page, "location.hash.startsWith('#s=') && location.href");
  assert.ok(address.length < 2000, `${address.length} characters`);
  const report = await downloaded(page, "report");
  assert.match(report, /^<!DOCTYPE html>/);
  assert.ok(report.includes(pasted.replace("> ", "&gt; ")));
  assert.match(await downloaded(page, "csv"), /dimension/);
  quiet(page);
  await page.close();
  const again = await open(null);
  await again.evaluate(`location.hash = ${JSON.stringify(new URL(address).hash)}`);
  await again.send("Page.reload");
  await new Promise((resolve) => setTimeout(resolve, 500));
  await settled(again);
  assert.equal(await text(again, "#yield"), pasted);
  await again.close();
});

test("2: an English spreadsheet, cell by cell", async () => {
  const page = await open("examples/first-study/study.toml");
  await paste(page, cell(0, "nominal"), "50.30\t0.08\n10.05\t-0.05 / 0");
  assert.equal(await value(page, cell(0, "nominal")), "50.30");
  assert.equal(await value(page, cell(1, "nominal")), "10.05");
  assert.equal(await value(page, cell(1, "name")), "spacer");
  quiet(page);
  await page.close();
});

test("3: errors stand at their cell and formula, what follows waits, and the last result stays", async () => {
  const page = await open("examples/stacked-blocks/study.toml");
  const shown = await text(page, "#yield");
  await type(page, cell(0, "nominal"), "ten");
  assert.equal(await page.evaluate(`document.querySelector('${cell(0, "nominal")}').getAttribute("aria-invalid")`), "true");
  assert.match(await text(page, "#err-0"), /ten|number/);
  assert.equal(await text(page, "#yield"), shown);
  assert.equal(await text(page, "#old"), "Last complete result");
  await type(page, cell(0, "nominal"), "10");
  assert.equal(await page.evaluate("document.querySelectorAll('[aria-invalid]').length"), 0);
  const formula = ".kc[data-of=\"formulas\"] [data-column=\"formula\"]", written = await value(page, formula);
  await type(page, formula, written.replace("tan(", "tann("));
  const fault = await text(page, ".kc[data-of=\"formulas\"] .ferr");
  assert.match(fault, /tann/);
  assert.match(fault, /\^{4}/);
  assert.match(fault, /tan\b/);
  assert.match(await page.evaluate("[...document.querySelectorAll('.ferr.wait')].map((one) => one.textContent).join(';')"), /waits for/);
  await type(page, formula, written);
  assert.equal(await text(page, "#yield"), shown);
  quiet(page);
  await page.close();
});

test("4: a built-in model fills the table", async () => {
  const page = await open(null);
  await click(page, "[data-kind=\"model\"]");
  await page.evaluate("(() => { const box = document.getElementById('model'); box.value = 'connecting-rod'; box.dispatchEvent(new Event('change')); })()");
  await click(page, "#take-model");
  await settled(page);
  assert.ok(await page.evaluate("document.querySelectorAll('#rows tr[data-i]').length") > 5);
  const first = await value(page, cell(0, "nominal"));
  await type(page, cell(0, "tolerance"), String(Math.abs(Number(first)) / 100 || 0.1));
  const study = join(folder, "model.toml");
  writeFileSync(study, await downloaded(page, "study"));
  execFileSync(sensitol, ["check", study, "-q"]);
  quiet(page);
  await page.close();
});

test("5: a vector loop is edited and solved", async () => {
  const page = await open("examples/four-bar/study.toml");
  await click(page, "[data-kind=\"loop\"]");
  assert.equal(await page.evaluate("document.querySelectorAll('#links tbody tr').length"), 4);
  assert.equal(await page.evaluate("document.querySelectorAll('[data-unknown]').length"), 2);
  const shown = await text(page, "#yield");
  await type(page, "#links tbody tr:nth-child(3) [data-part=\"length\"]", "follower + 0.05");
  assert.notEqual(await text(page, "#yield"), shown);
  await click(page, "#undo");
  await settled(page);
  assert.equal(await text(page, "#yield"), shown);
  quiet(page);
  await page.close();
});

test("6: tolerances are allocated, taken over, and undone in one step", async () => {
  const page = await open("examples/first-study/study.toml");
  const before = await value(page, cell(0, "tolerance"));
  await click(page, "#tab-allocate");
  await click(page, "#go");
  await until(page, "document.getElementById('take') !== null");
  await click(page, "#take");
  await until(page, `document.querySelector('${cell(0, "tolerance")}').value !== ${JSON.stringify(before)}`);
  await settled(page);
  const study = join(folder, "allocated.toml");
  writeFileSync(study, await downloaded(page, "study"));
  // The command line finds its target kept, or known no better than to an interval around it.
  assert.ok(yields(study)[0] > 0.997);
  await click(page, "#undo");
  await settled(page);
  assert.equal(await value(page, cell(0, "tolerance")), before);
  quiet(page);
  await page.close();
});

test("7: a simulation counts, stops, and ends", async () => {
  const page = await open("examples/first-study/study.toml");
  await click(page, "#tab-simulate");
  await page.evaluate("document.getElementById('points').value = '4000000'");
  await click(page, "#go");
  await until(page, "!document.getElementById('stop').hidden");
  await click(page, "#stop");
  await until(page, "document.getElementById('answer').textContent.includes('Stopped')");
  await page.evaluate("document.getElementById('points').value = '100000'");
  await click(page, "#go");
  await until(page, "document.querySelector('#answer table') !== null");
  assert.match(await text(page, "#answer"), /100\u202f000 points/);
  quiet(page);
  await page.close();
});

test("8: a sweep is drawn between its limits", async () => {
  const page = await open("examples/stacked-blocks/study.toml");
  await click(page, "#tab-sweep");
  await page.evaluate("(() => { const over = document.getElementById('over'); over.value = 'th'; over.dispatchEvent(new Event('change')); })()");
  await click(page, "#go");
  const label = await until(page, "document.querySelector('#answer svg')?.getAttribute('aria-label')");
  assert.match(label, /over th from 16 to 18/);
  assert.ok(await page.evaluate("document.querySelectorAll('#answer svg .band').length") === 1);
  await page.evaluate("document.getElementById('from').value = 'x'");
  await click(page, "#go");
  await until(page, "document.getElementById('answer').textContent.includes('must be numbers')");
  quiet(page);
  await page.close();
});

test("9: a study is edited as text, and the table follows", async () => {
  const page = await open("examples/first-study/study.toml");
  await click(page, "[data-view=\"toml\"]");
  const toml = await value(page, "#toml");
  assert.match(toml, /^# A stack of three parts/);
  await type(page, "#toml", toml.replace("housing = { nominal = 50.20", "housing = { nominal = 50.30"));
  const changed = await text(page, "#yield");
  await click(page, "[data-view=\"table\"]");
  await until(page, "!document.getElementById('table').hidden");
  await settled(page);
  assert.equal(await value(page, cell(0, "nominal")), "50.3");
  assert.equal(await text(page, "#yield"), changed);
  quiet(page);
  await page.close();
});

test("a damaged link opens an example, and hostile names are text", async () => {
  const page = await open(null);
  await page.evaluate("location.hash = '#s=AAAA'");
  await page.send("Page.reload");
  await new Promise((resolve) => setTimeout(resolve, 500));
  await settled(page);
  assert.match(await text(page, "#toast"), /damaged/);
  await page.close();
  const study = join(folder, "hostile.json"), name = "<img src=x onerror=alert(1)>";
  writeFileSync(study, JSON.stringify({ title: "</script><script>alert(2)</script>", dimensions: { [name]: { nominal: 1, tolerance: 0.1, unit: "mm" } }, characteristics: { "\"><u>y": { formula: `2*\`${name}\``, lower: 1.7, upper: 2.3, target_yield: 0.9 } } }));
  const hostile = await open(study);
  assert.equal(await hostile.evaluate("document.querySelectorAll('img, u').length"), 0);
  assert.equal(await value(hostile, cell(0, "name")), name);
  quiet(hostile);
  await hostile.close();
});

test("nothing is wider than a phone, and axe finds nothing", async () => {
  for (const options of [{}, { dark: true }, { width: 390, height: 844 }]) {
    const page = await open("examples/stacked-blocks/study.toml", options);
    const wider = await page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth");
    assert.ok(wider <= 0, `${wider} pixels wider than a window of ${options.width ?? 1280}`);
    if (axe) {
      await page.evaluate(readFileSync(axe, "utf8"));
      const states = [["as opened", "0"], ["a panel", "document.getElementById('tab-sweep').click()"], ["simulate", "document.getElementById('tab-simulate').click()"], ["a loop", "document.querySelector('[data-kind=loop]').click()"], ["a model", "document.querySelector('[data-kind=model]').click()"], ["menus", "document.getElementById('download').open = true"]];
      for (const [state, expression] of states) {
        await page.evaluate(expression);
        const found = await page.evaluate("axe.run(document, { resultTypes: ['violations'] }).then((all) => all.violations.map((one) => `${one.id}: ${one.nodes.map((node) => node.html.slice(0, 160) + ' ' + node.failureSummary.slice(0, 200)).join(' | ')}`))");
        assert.deepEqual(found, [], `${state}, ${JSON.stringify(options)}`);
      }
      await type(page, cell(0, "nominal"), "ten");
      const found = await page.evaluate("axe.run(document, { resultTypes: ['violations'] }).then((all) => all.violations.map((one) => `${one.id}: ${one.nodes[0].html.slice(0, 200)}`))");
      assert.deepEqual(found, [], `an error, ${JSON.stringify(options)}`);
    }
    await page.close();
  }
});
