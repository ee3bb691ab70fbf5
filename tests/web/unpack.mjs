// The page unpacks the engine that was built. `WEB_ENGINE=folder node --test unpack.mjs`
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { load } from "./engine.mjs";

const folder = process.env.WEB_ENGINE, packed = readFileSync(join(folder, "engine.packed"));
const unpack = load(folder, "unpack");

test("the engine is unpacked byte for byte", () => {
  assert.ok(readFileSync(join(folder, "engine.wasm")).equals(unpack.unpacked(packed)));
});
test("of a part there is no engine", () => {
  assert.equal(unpack.unpacked(packed.subarray(0, packed.length / 2)), undefined);
});
