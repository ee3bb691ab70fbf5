// `sensitol serve` in a real browser: a folder of studies, edited, saved, watched, with an external model.
// The page is that of the program, without WebAssembly. `SENSITOL=program node --test serve.mjs`
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { copyFileSync, existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { Browser } from "./chromium.mjs";

const { SENSITOL: sensitol } = process.env;
const folder = mkdtempSync(join(tmpdir(), "sensitol-serve-")), home = mkdtempSync(join(tmpdir(), "sensitol-program-"));
const STUDY = "# The gap.\ntitle = \"Gap\"\n[dimensions]\na = { nominal = 10, tolerance = 0.3 }\nb = { nominal = 4, tolerance = 0.1 }\n[characteristics]\ny = { formula = \"a - b\", lower = 5.5, upper = 6.5, target_yield = 0.9 }\n";
const PROGRAM = `
import json, sys, time
for line in sys.stdin:
    told = json.loads(line)
    if "id" not in told:
        print(json.dumps({"ready": True, "name": "slow"}), flush=True)
        continue
    time.sleep(0.1)
    print(json.dumps({"id": told["id"], "y": [sum(told["x"])]}), flush=True)
`;
const EXTERNAL = "[dimensions]\na = { nominal = 10, tolerance = 0.3 }\nb = { nominal = 4, tolerance = 0.1 }\n[model]\ncommand = [\"python3\", \"slow.py\"]\n[characteristics]\ny = { lower = 13, upper = 15, target_yield = 0.9 }\n";
let browser, server, address;

before(async () => {
  mkdirSync(join(folder, "in"));
  writeFileSync(join(folder, "gap.toml"), STUDY);
  writeFileSync(join(folder, "in", "program.toml"), EXTERNAL);
  writeFileSync(join(folder, "in", "slow.py"), PROGRAM);
  // Elsewhere no built page is found beside the program.
  copyFileSync(sensitol, join(home, "sensitol"));
  server = spawn(join(home, "sensitol"), ["serve", folder], { stdio: ["ignore", "pipe", "inherit"] });
  address = await new Promise((resolve) => server.stdout.on("data", (text) => resolve(/http:\S+/.exec(String(text))[0])));
  browser = await Browser.start();
});
after(async () => {
  server.kill();
  await browser.stop();
  [folder, home].forEach((one) => rmSync(one, { recursive: true, force: true }));
});

const until = async (page, expression) => {
  for (let i = 0; i < 1200; i += 1) {
    const found = await page.evaluate(expression);
    if (found) return found;
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
  throw new Error(`never: ${expression}; ${await page.evaluate("document.body.innerText.slice(0, 2000)")}`);
};
const settled = (page) => until(page, "document.documentElement.dataset.ready === '1'");
const text = (page, selector) => page.evaluate(`document.querySelector(${JSON.stringify(selector)})?.textContent ?? null`);
const click = (page, selector) => page.evaluate(`document.querySelector(${JSON.stringify(selector)}).click()`);
const type = async (page, selector, value) => {
  await page.evaluate(`(() => { const input = document.querySelector(${JSON.stringify(selector)}); input.focus(); input.value = ${JSON.stringify(value)}; input.dispatchEvent(new Event("input", { bubbles: true })); })()`);
  await settled(page);
};
const cell = (row, column) => `#rows tr[data-i="${row}"] [data-column="${column}"]`;
// Requests go to this server and to no other; a refused save is told in the console too.
const quiet = (page, expected = []) => assert.deepEqual(page.complaints.filter((one) => !one.startsWith(`request: ${address}`) && !expected.some((part) => one.includes(part))), []);
const opened = async (hash = "") => {
  const page = await browser.open(address + hash);
  await settled(page);
  await until(page, "document.querySelector('#rows tr') !== null");
  await settled(page);
  return page;
};

test("a study of the folder is edited, saved as it was but for the change, and watched", async () => {
  const page = await opened();
  assert.equal(await page.evaluate("document.getElementById('title').value"), "Gap");
  const shown = await text(page, "#yield");
  assert.match(shown, /%/);
  assert.match(await text(page, "#out"), /by sensitol on this machine/);
  // Nothing is saved that has not changed: comments stay.
  await click(page, "#save");
  await until(page, "document.getElementById('toast').textContent.includes('is saved')");
  assert.equal(readFileSync(join(folder, "gap.toml"), "utf8"), STUDY);
  await type(page, cell(0, "tolerance"), "0.5");
  assert.notEqual(await text(page, "#yield"), shown);
  await until(page, "document.title.startsWith('*')");
  await click(page, "#save");
  await until(page, "!document.title.startsWith('*')");
  assert.match(readFileSync(join(folder, "gap.toml"), "utf8"), /0\.5/);
  // Another program writes the file: it is shown again, and the change is undone no more.
  writeFileSync(join(folder, "gap.toml"), STUDY.replace("Gap", "Other"));
  await until(page, "document.getElementById('title').value === 'Other'");
  await settled(page);
  assert.equal(await text(page, "#yield"), shown);
  quiet(page);
  await page.close();
});

test("what is not saved is not lost when the file changes", async () => {
  writeFileSync(join(folder, "gap.toml"), STUDY);
  const page = await opened("#f=gap.toml");
  await type(page, cell(0, "tolerance"), "0.4");
  writeFileSync(join(folder, "gap.toml"), STUDY.replace("Gap", "Theirs"));
  await until(page, "document.getElementById('toast').textContent.includes('changed on the disk')");
  assert.equal(await page.evaluate(`document.querySelector('${cell(0, "tolerance")}').value`), "0.4");
  await click(page, "#save");
  // The question is answered with yes, and told of.
  await until(page, "document.getElementById('toast').textContent.includes('is saved')");
  assert.ok(page.complaints.some((one) => one.startsWith("dialog:") && one.includes("Overwrite")), page.complaints.join("\n"));
  assert.match(readFileSync(join(folder, "gap.toml"), "utf8"), /0\.4/);
  quiet(page, ["dialog:", "409"]);
  await page.close();
});

test("an external model runs when it is asked for, and can be stopped", async () => {
  const page = await opened("#f=in%2Fprogram.toml");
  assert.match(await text(page, "#old"), /Analyze runs it/);
  assert.equal(existsSync(join(folder, "in", "program.journal.sqlite")), false);
  await click(page, "#analyze");
  await until(page, "/\\d+ of \\d+ points/.test(document.getElementById('old').textContent)");
  assert.match(await text(page, "#old"), /python3 slow\.py runs/);
  assert.match(await text(page, "#analyze"), /The program runs: stop it/);
  await settled(page);
  assert.equal(await text(page, "#analyze"), "Analyze");
  assert.match(await text(page, "#yield"), /%/);
  assert.equal(existsSync(join(folder, "in", "program.journal.sqlite")), true);
  await type(page, cell(0, "tolerance"), "0.35");
  assert.match(await text(page, "#old"), /Last result/);
  await click(page, "#analyze");
  await click(page, "#analyze");
  await settled(page);
  assert.match(await page.evaluate("document.body.innerText"), /stopped/);
  quiet(page);
  await page.close();
});

test("a program that is typed, in whatever form, starts when it is asked for", async () => {
  writeFileSync(join(folder, "in", "typed.toml"), STUDY);
  writeFileSync(join(folder, "in", "started.py"), `open("started", "w").write("x")\n${PROGRAM}`);
  const page = await opened("#f=in%2Ftyped.toml");
  assert.equal(await page.evaluate("document.getElementById('analyze').hidden"), true);
  await click(page, "[data-view=toml]");
  const rest = EXTERNAL.replace(/\[model\]\n.*\n/, "");
  for (const form of ["model.command = [\"python3\", \"started.py\"] # typed\n", "\"model\" = { 'command' = [\"python3\", \"started.py\"] }\n"]) {
    await type(page, "#toml", form + rest);
    assert.match(await text(page, "#old"), /program, python3 started\.py: Analyze runs it/);
    assert.equal(await page.evaluate("document.getElementById('analyze').hidden"), false);
    assert.equal(await text(page, "#toml-error"), "");
    assert.equal(existsSync(join(folder, "in", "started")), false);
  }
  // The table names the program, and no built-in model.
  await click(page, "[data-view=table]");
  await until(page, "document.querySelector('[data-kind][aria-pressed=true]').textContent === 'External program'");
  assert.equal(await text(page, "#program-command"), "python3 started.py");
  await settled(page);
  assert.equal(existsSync(join(folder, "in", "started")), false);
  // A tool of the page that runs it can be stopped too.
  await click(page, "#tab-sweep");
  await page.evaluate("for (const [id, value] of [['from', '9'], ['to', '11']]) document.getElementById(id).value = value");
  await click(page, "#go");
  await until(page, "/runs: .* points/.test(document.getElementById('answer').textContent)");
  assert.equal(await page.evaluate("document.getElementById('stop').hidden"), false);
  await click(page, "#stop");
  await until(page, "document.getElementById('answer').textContent.startsWith('Stopped')");
  assert.equal(await page.evaluate("document.getElementById('stop').hidden"), true);
  // A study without a program runs at once again.
  await click(page, "[data-view=toml]");
  await type(page, "#toml", STUDY);
  assert.equal(await page.evaluate("document.getElementById('analyze').hidden"), true);
  assert.match(await text(page, "#yield"), /%/);
  quiet(page);
  await page.close();
});

test("a new study is saved into the folder", async () => {
  const page = await opened("#f=gap.toml");
  await page.evaluate("document.getElementById('take-model').click()");
  await settled(page);
  await page.evaluate("window.prompt = () => 'made'");
  await click(page, "#save");
  await until(page, "document.getElementById('toast').textContent.includes('is saved')");
  assert.match(readFileSync(join(folder, "made.toml"), "utf8"), /\[dimensions\]/);
  quiet(page);
  await page.close();
});
