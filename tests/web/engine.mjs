// The engine of the workbench in Node, as web/build leaves it.
import { readFileSync } from "node:fs";
import { join } from "node:path";

export const load = (folder) => {
  const engine = new Function(`${readFileSync(join(folder, "engine.js"), "utf8")}; return wasm_bindgen;`)();
  engine.initSync({ module: readFileSync(join(folder, "engine.wasm")) });
  return engine;
};
