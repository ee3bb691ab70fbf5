// The engine of the workbench in Node, as web/build leaves it, and the library that unpacks it in a page.
import { readFileSync } from "node:fs";
import { join } from "node:path";

export const load = (folder, name = "engine") => {
  const glue = new Function(`${readFileSync(join(folder, `${name}.js`), "utf8")}; return wasm_bindgen;`)();
  glue.initSync({ module: readFileSync(join(folder, `${name}.wasm`)) });
  return glue;
};
