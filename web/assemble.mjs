// The page from its parts: `node assemble.mjs FOLDER PAGE`, where FOLDER has the engine and what unpacks it as web/build left them.
import { createHash } from "node:crypto";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

const [folder, page] = process.argv.slice(2);
const here = dirname(fileURLToPath(import.meta.url)), root = join(here, "..");
const part = (name) => readFileSync(join(here, "page", name), "utf8");
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

const style = part("page.css"), script = scripted(["study.js", "engine.js", "serve.js", "page.js", "folder.js"].map(part).join(""));
const policy = `default-src 'none'; style-src ${hash(style)}; script-src ${hash(script)} 'wasm-unsafe-eval'; worker-src blob:; base-uri 'none'; form-action 'none'`;
const made = (name) => readFileSync(join(folder, name)), glue = (name) => scripted(made(name).toString("utf8"));
const packed = made("engine.packed"), unpack = made("unpack.wasm");
const parts = {
  POLICY: policy, VERSION: version, STYLE: style, SCRIPT: script, EXAMPLES: data(examples),
  GLUE: glue("engine.js"), WORKER: scripted(part("worker.js")), ENGINE: packed.toString("base64"),
  UNPACKGLUE: glue("unpack.js"), UNPACKWORKER: scripted(part("unpack.js")), UNPACK: unpack.toString("base64"),
};
const text = part("page.html").replace(/@([A-Z]+)@/g, (whole, name) => parts[name] ?? whole);
mkdirSync(dirname(page), { recursive: true });
writeFileSync(page, text);
console.log(`${page}: ${Math.round(text.length / 1000)} kB, ${Math.round(gzipSync(text).length / 1000)} kB gzipped; the engine ${Math.round(packed.length / 1000)} kB packed`);
