// The engine of the workbench in Node, as web/build leaves it.
import { readFileSync } from "node:fs";
import { join } from "node:path";

export const load = (folder) => {
  const glue = new Function(`${readFileSync(join(folder, "engine.js"), "utf8")}; return wasm_bindgen;`)();
  glue.initSync({ module: readFileSync(join(folder, "small.wasm")) });
  return glue;
};
