// The engine in a page says what the command line says: the JSON of every example study without an external model.
// `SENSITOL=program WEB_ENGINE=folder node --test equality.mjs`
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, readdirSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { after, test } from "node:test";
import { fileURLToPath } from "node:url";
import { load } from "./engine.mjs";

const root = join(dirname(fileURLToPath(import.meta.url)), "..", ".."), examples = join(root, "examples");
const engine = load(process.env.WEB_ENGINE);
const folder = mkdtempSync(join(tmpdir(), "sensitol-equality-"));
after(() => rmSync(folder, { recursive: true, force: true }));

const studies = readdirSync(examples, { recursive: true }).map(String).filter((path) => path.endsWith(".toml")).sort()
  .map((path) => join("examples", path))
  // An adapter's own file is not a study, and a page runs no program.
  .filter((path) => { const text = readFileSync(join(root, path), "utf8"); return !/^(document|servers) =/m.test(text) && !/^command = /m.test(text); });

// What takes as long as the machine takes.
const TIMES = /_s$/;
// Sums and libraries of mathematics differ in the last bits between processors; figures are printed with far fewer digits.
const ROUNDING = 1e-9;
// An end of a support that lies hundreds of sigmas away multiplies the rounding of skewness and kurtosis by as much.
const SUPPORT = 1e-6;
// A quotient of rounding errors has no digits: errors of derivatives, what is left out of a sum of shares, residuals of an optimum.
const NOISE = new Set(["rounding", "rounding_first", "rounding_second"]);
const differences = (page, line, path, scale, found) => {
  const key = path.split(".").at(-1);
  if (TIMES.test(key) || NOISE.has(key)) return found;
  const rounding = path.includes(".support.") ? SUPPORT : ROUNDING;
  if (typeof page === "number" && typeof line === "number") {
    if (!(Math.abs(page - line) <= rounding * Math.max(Math.abs(page), Math.abs(line), scale))) found.push(`${path}: ${page} in the page, ${line} on the command line`);
  } else if (page !== null && line !== null && typeof page === "object" && typeof line === "object") {
    // Interactions of one share but for rounding stand in either order.
    if (key === "interactions" && Array.isArray(page)) {
      const sorted = (all) => [...all].sort((a, b) => (a.dimensions.join() < b.dimensions.join() ? -1 : 1));
      [page, line] = [sorted(page), sorted(line)];
    }
    const keys = new Set([...Object.keys(page), ...Object.keys(line)]);
    // Beside sigma and 1, a figure that is 0 but for rounding is 0.
    const of = typeof line.sigma === "number" ? Math.max(line.sigma, 1e-6) : scale;
    for (const one of keys) differences(page[one], line[one], `${path}.${one}`, of, found);
  } else if (page !== line) found.push(`${path}: ${JSON.stringify(page)} in the page, ${JSON.stringify(line)} on the command line`);
  return found;
};

// A quantile of a sampled law is sought to a fiftieth of its error, so that the two searches may end apart by as much.
const SOUGHT = 0.02;
const sampledQuantiles = (page, line) => {
  for (const [index, one] of (line.characteristics ?? []).entries()) {
    const other = page.characteristics[index];
    for (const [share, quantile] of Object.entries(one.quantiles?.values ?? {})) {
      const found = other.quantiles?.values?.[share];
      if (!found || !quantile || !(Math.abs(found.value - quantile.value) <= SOUGHT * quantile.error)) continue;
      other.quantiles.values[share] = quantile;
      if (other.surface_law?.quantiles && one.surface_law?.quantiles) other.surface_law.quantiles[share] = one.surface_law.quantiles[share];
    }
  }
};

const files = (path, text) => Object.fromEntries([...text.matchAll(/(?:measured|file) = "([^"]+\.csv)"/g)].map(([, name]) => [name, readFileSync(join(root, dirname(path), name), "utf8")]));
const both = (path, asked, options) => {
  const text = readFileSync(join(root, path), "utf8");
  const task = { text, format: "toml", name: path, files: files(path, text), asked, forms: ["json", "text"] };
  const page = JSON.parse(engine.run(JSON.stringify(task), () => {}));
  assert.ok(page.json, `${path}: ${JSON.stringify(page).slice(0, 500)}`);
  const line = (...more) => spawnSync(process.env.SENSITOL, [asked.command, path, "-q", "-v", ...options, ...more], { cwd: root, encoding: "utf8", env: { ...process.env, LC_ALL: "C.UTF-8" }, maxBuffer: 1 << 28 });
  const json = line("--json");
  assert.notEqual(json.stdout, "", `${path}: ${json.stderr}`);
  const written = join(folder, "report.txt");
  line("-o", written);
  const timeless = (report) => report.replaceAll(/\d[\d.]* (s|ms|µs)\b/g, "TIME");
  // Lines of equal interactions stand in either order too: they are compared sorted.
  return { page: JSON.parse(page.json), line: JSON.parse(json.stdout), texts: [page.text, readFileSync(written, "utf8")].map(timeless) };
};

let compared = 0;
for (const path of studies) {
  test(`analyze ${path}`, () => {
    const { page, line, texts } = both(path, { command: "analyze" }, []);
    sampledQuantiles(page, line);
    assert.deepEqual(differences(page, line, "report", 1, []), []);
    // Digit for digit, as people read it.
    assert.deepEqual(...texts.map((one) => one.split("\n").sort()));
    compared += 1;
  });
}
test("simulate, rare, sweep, allocate and compare", () => {
  const first = "examples/first-study/study.toml", blocks = "examples/stacked-blocks/study.toml";
  const cases = [
    [first, { command: "simulate", samples: 20000 }, ["--samples", "20000"]],
    [blocks, { command: "simulate", samples: 8192, sampler: "sobol" }, ["--samples", "8192", "--sampler", "sobol"]],
    [first, { command: "allocate" }, []],
    [blocks, { command: "sweep", over: "th", values: [15, 16, 17, 18, 19] }, ["--over", "th=15:19:5"]],
    [blocks, { command: "compare", samples: 4096 }, ["--samples", "4096"]],
  ];
  for (const [path, asked, options] of cases) {
    const { page, line } = both(path, asked, options);
    assert.deepEqual(differences(page, line, asked.command, 1, []), []);
  }
});
test("every example was compared", () => assert.ok(compared >= 20, `${compared} studies were compared`));
