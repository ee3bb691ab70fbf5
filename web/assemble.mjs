// The page from its parts: `node assemble.mjs FOLDER PAGE [small]`, where FOLDER has the engine as web/build left it. `small` takes what
// only people read out of scripts and style, by esbuild where it is there.
import { spawnSync } from "node:child_process";
import { createHash } from "node:crypto";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

const [folder, page, small] = process.argv.slice(2);
const here = dirname(fileURLToPath(import.meta.url)), root = join(here, "..");
const minified = (text, loader) => {
  if (small !== "small") return text;
  const { status, stdout } = spawnSync("esbuild", ["--minify", `--loader=${loader}`, "--log-level=error"], { input: text, encoding: "utf8" });
  return status === 0 ? stdout.trimEnd() : text;
};
const part = (name) => readFileSync(join(root, "crates/cli/page", name), "utf8");
// Bytes of a small page: what people wait for over a slow network, and mail servers take.
const MOST = 2_500_000;
const version = /^version = "(.*)"$/m.exec(readFileSync(join(root, "Cargo.toml"), "utf8"))[1];

// Examples by what they teach.
const EXAMPLES = [
  ["first-study", "First study", "a stack of three parts; one-sided and uniform tolerances, costs"],
  ["shaft-and-bore", "Shaft and bore", "a clearance with a tilt; a one-sided tolerance"],
  ["thermal-clearance", "Thermal clearance", "temperatures, interactions"],
  ["stacked-blocks", "Stacked blocks", "a published case with angles"],
  ["four-bar", "Four-bar linkage", "a vector loop with two unknowns"],
];
const examples = EXAMPLES.map(([name, title, teaches]) => (
  { name: `${name}.toml`, title, teaches, text: readFileSync(join(root, "examples", name, "study.toml"), "utf8") }));

// JSON and scripts that stand in a page: nothing in them ends an element or begins a comment.
const data = (value) => JSON.stringify(value).replace(/[<>&]/g, (c) => `\\u00${c.charCodeAt(0).toString(16)}`);
const scripted = (text) => {
  if (/<\/script|<!--/i.test(text)) throw new Error("a script would end its element");
  return text;
};
const hash = (text) => `'sha256-${createHash("sha256").update(text).digest("base64")}'`;

const style = minified(part("page.css"), "css");
const script = scripted(minified(["study.js", "engine.js", "serve.js", "page.js", "folder.js"].map(part).join(""), "js"));
const policy = `default-src 'none'; style-src ${hash(style)}; script-src ${hash(script)} 'wasm-unsafe-eval'; worker-src blob:; base-uri 'none'; form-action 'none'`;
// The engine by gzip, in base64: every browser unpacks it by DecompressionStream.
const packed = gzipSync(readFileSync(join(folder, "engine.wasm")), { level: 9 }), glue = readFileSync(join(folder, "engine.js"), "utf8");
const parts = {
  POLICY: policy, VERSION: version, STYLE: style, SCRIPT: script, EXAMPLES: data(examples),
  GLUE: scripted(minified(glue, "js")), WORKER: scripted(minified(part("worker.js"), "js")),
  ENGINE: packed.toString("base64"),
};
const text = part("page.html").replace(/@([A-Z]+)@/g, (whole, name) => parts[name] ?? whole);
mkdirSync(dirname(page), { recursive: true });
writeFileSync(page, text);
const size = gzipSync(text, { level: 9 }).length, kilobytes = (bytes) => `${Math.round(bytes / 1000)} kB`;
console.log(`${page}: ${kilobytes(text.length)}, ${kilobytes(size)} gzipped; the engine ${kilobytes(packed.length)} gzipped`);
if (small === "small" && text.length > MOST) {
  console.error(`${page}: more than ${kilobytes(MOST)}`);
  process.exitCode = 1;
}
