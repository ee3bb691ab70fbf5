// The page holds the engine that was built. `WEB_ENGINE=folder WORKBENCH=page node --test page.mjs`
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { gunzipSync } from "node:zlib";

test("the page holds the engine by gzip", () => {
  const [, text] = /id="engine-gzip">([^<]*)</.exec(readFileSync(process.env.WORKBENCH, "utf8"));
  assert.ok(readFileSync(join(process.env.WEB_ENGINE, "engine.wasm")).equals(gunzipSync(Buffer.from(text, "base64"))));
});
