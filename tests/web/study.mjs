// Studies as a table: what is pasted, what a tolerance means, and that the text of a study means the same after the table.
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { dirname, join } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { load } from "./engine.mjs";

const root = join(dirname(fileURLToPath(import.meta.url)), "..", "..");
const study = new Function(`${readFileSync(join(root, "crates/cli/page/study.js"), "utf8")}; return study;`)();
const engine = load(process.env.WEB_ENGINE);
const keys = (text, files = {}) => JSON.parse(engine.study(JSON.stringify({ text, format: "toml", name: "study.toml", files })));

test("tolerances as engineers write them", () => {
  const n = (number) => ({ number });
  const cases = {
    "0.05": { tolerance: n("0.05") }, "± 0,05": { tolerance: n("0.05") }, "+-0.05": { tolerance: n("0.05") }, "-0.12 / 0": { tolerance: [n("-0.12"), n("0")] },
    "+0.08 -0.05": { tolerance: [n("-0.05"), n("+0.08")] }, "0 / −0,12": { tolerance: [n("-0.12"), n("0")] }, H7: { fit: "H7" }, js6: { fit: "js6" }, s6: { fit: "s6" }, "s 0.02": { sigma: n("0.02") }, "2 %": { tolerance: "2 %" },
    "9.9 .. 10.1": { limits: [n("9.9"), n("10.1")] }, "sigma 0.02": { sigma: n("0.02") }, "": {}, "much": { tolerance: "much" },
  };
  for (const [text, expected] of Object.entries(cases)) assert.deepEqual(study.tolerance(text), expected, text);
});

test("numbers of spreadsheets", () => {
  const cases = { "62,40": "62.40", "1.234,5": "1234.5", "1,234.5": "1234.5", "−0,5": "-0.5", ".5": "0.5", "05": "5", "1e-3": "1e-3", "1 234,5": "1234.5" };
  for (const [text, expected] of Object.entries(cases)) assert.equal(study.number(text), expected, text);
  for (const text of ["", "ten", "1,2,3", "--1", "0x"]) assert.equal(study.number(text), null, text);
});

test("pasted rows", () => {
  const paste = (text, column = "name", row = 0) => study.pasted(study.empty(), text, row, column).state.dims;
  const [a, b] = paste("Maß\tNenn\t+\t-\tEinheit\na\t62,40\t0,06\t0,06\tmm\nb\t14,00\t0\t-0,12\tmm\tUniform\n");
  assert.deepEqual([a.name, a.nominal, a.tolerance, a.unit], ["a", "62.40", "0.06", "mm"]);
  assert.deepEqual([b.tolerance, b.distribution], ["-0.12 / 0", "uniform"]);
  const [c] = paste("c\t10\t± 0.3\tmm\r\n");
  assert.deepEqual([c.nominal, c.tolerance], ["10", "± 0.3"]);
  assert.equal(study.pasted(study.empty(), "one cell", 0, "name"), null);
  assert.equal(paste("1\t2\n3\t4", "nominal", 1).length, 3);
});

test("every example means the same after the table", () => {
  const skip = /^(document|servers) =|^command = /m;
  let compared = 0;
  for (const path of readdirSync(join(root, "examples"), { recursive: true }).map(String).filter((path) => path.endsWith(".toml"))) {
    const text = readFileSync(join(root, "examples", path), "utf8");
    if (skip.test(text)) continue;
    const files = Object.fromEntries([...text.matchAll(/"([^"]+\.csv)"/g)].map(([, name]) => [name, readFileSync(join(root, "examples", dirname(path), name), "utf8")]));
    const before = keys(text, files);
    assert.ok(before.study, `${path}: ${JSON.stringify(before)}`);
    const state = study.of(before.study), written = study.toml(state).text, after = keys(written, files);
    assert.ok(after.study, `${path}: ${JSON.stringify(after)}\n${written}`);
    // Once more the same text: nothing drifts.
    assert.equal(study.toml(study.of(after.study)).text, written, path);
    const task = (text) => JSON.stringify({ text, format: "toml", name: "study.toml", files, asked: { command: "analyze" }, forms: ["json"] });
    const figures = (text) => JSON.parse(JSON.parse(engine.run(task(text), () => {})).json).characteristics.map((one) => [one.name, one.mean, one.sigma, one.yield]);
    assert.deepEqual(figures(written), figures(text), path);
    compared += 1;
  }
  assert.ok(compared >= 20, `${compared} studies were compared`);
});

test("faults are placed at their cells", () => {
  const state = study.empty();
  state.dims = [{ ...study.blank(), name: "ä", nominal: "10", tolerance: "0.1" }, { ...study.blank(), name: "b", nominal: "ten", tolerance: "0.1" }];
  state.kcs = [{ ...study.asked("y", "ä - bb"), lower: "-9", upper: "9" }];
  const place = (state) => { const made = study.toml(state); return keys(made.text).faults.map((fault) => study.placed(state, made, fault)); };
  const [first] = place(state);
  assert.deepEqual([first.of, first.i, first.column], ["dims", 1, "nominal"]);
  state.dims[1].nominal = "10";
  const [second] = place(state);
  assert.deepEqual([second.of, second.i, second.column, second.at, second.length], ["kcs", 0, "formula", "ä - ".length, 2]);
  state.kcs[0].formula = "ä - b";
  state.kcs[0].lower = "2";
  state.kcs[0].upper = "1";
  assert.equal(place(state)[0].of, "kcs");
  state.kcs[0].lower = "-9";
  state.kcs[0].upper = "9";
  state.dims[1].tolerance = "much";
  const [third] = place(state);
  assert.deepEqual([third.of, third.i, third.column], ["dims", 1, "tolerance"]);
});
