// The page unpacks the engine that was built, and any module. `PACK=program WEB_ENGINE=folder WORKBENCH=page node --test unpack.mjs`
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { after, test } from "node:test";
import { fileURLToPath } from "node:url";

const root = join(dirname(fileURLToPath(import.meta.url)), "..", ".."), folder = process.env.WEB_ENGINE;
const script = readFileSync(join(root, "web", "page", "unpack.js"), "utf8");
const { unpacked, bytes } = new Function("onmessage", `${script}; return { unpacked, bytes };`)();
const scratch = mkdtempSync(join(tmpdir(), "sensitol-unpack-"));
after(() => rmSync(scratch, { recursive: true, force: true }));

// The packed module, and the module that is unpacked; null where it is refused.
const pack = (module) => {
  const [from, ordered, to] = ["module.wasm", "ordered.wasm", "module.packed"].map((name) => join(scratch, name));
  writeFileSync(from, module);
  return spawnSync(process.env.PACK, [from, ordered, to]).status === 0 ? { packed: readFileSync(to), ordered: readFileSync(ordered) } : null;
};

// A module of one function of type `[] -> []`, by the binary format of the specification, with these variables and operators.
const number = (value) => (value < 128 ? [value] : [value & 127 | 128, ...number(value >> 7)]);
const section = (id, content) => [id, ...number(content.length), ...content];
const module = (code) => Uint8Array.from([
  0, ...Buffer.from("asm"), 1, 0, 0, 0, ...section(1, [1, 0x60, 0, 0]), ...section(3, [1, 0]),
  ...section(10, [1, ...number(code.length), ...code]), ...section(11, [1, 0, 0x41, 16, 0x0b, 3, 1, 2, 3]), ...section(0, [1, 97, 7]),
]);
const CODE = [
  [2, 5, 0x7f, 1, 0x7c], // locals: 5 i32, 1 f64
  [0x41, 0x80, 0x08, 0x22, 1, 0x41, 4, 0x6a, 0x21, 0], // i32.const 1024, local.tee 1, i32.const 4, i32.add, local.set 0
  [0x20, 4, 0x22, 3, 0x21, 2, 0x20, 0, 0x20, 4, 0x6a, 0x22, 1, 0x21, 3], // places beyond those in an operator's byte
  [0x02, 0x40, 0x20, 1, 0x0d, 0, 0x03, 0x40, 0x20, 0, 0x0e, 1, 0, 1, 0x0b, 0x0b], // block, br_if, loop, br_table
  [0x20, 1, 0x28, 2, 0x90, 1, 0x10, 0, 0x11, 0, 0], // i32.load offset=144, call 0, call_indirect
  [0x20, 1, 0x20, 1, 0x28, 2, 0, 0x36, 0, 0, 0x20, 1, 0x29, 0, 0x81, 0x82, 3, 0x1a], // without an offset; alignments of 1
  [0x44, 0, 0, 0, 0, 0, 0, 0xf0, 0x3f, 0x21, 5, 0x43, 0, 0, 0x80, 0x3f, 0x1a], // f64.const 1, f32.const 1
  [0xfd, 12, ...Array(16).fill(7), 0xfd, 21, 1, 0x1a, 0x20, 1, 0xfd, 84, 0, 5, 2, 0x1a], // v128.const, lanes, v128.load8_lane
  [0x41, 0x41, 0x45, 0xfc, 11, 0, 0xfc, 10, 0, 0, 0x42, 0x80, 0x81, 0x82, 0x7f], // i32.const, memory.fill, memory.copy, i64.const
  [0x1a, 0x0b],
].flat();

test("the engine is unpacked byte for byte", () => {
  const packed = readFileSync(join(folder, "engine.packed"));
  assert.ok(readFileSync(join(folder, "engine.wasm")).equals(unpacked(packed)));
  assert.equal(unpacked(packed.subarray(0, packed.length / 2)), undefined);
});
test("the page holds the packed engine", () => {
  const [, text] = /id="engine-packed">([^<]*)</.exec(readFileSync(process.env.WORKBENCH, "utf8"));
  assert.ok(readFileSync(join(folder, "engine.packed")).equals(bytes(text)));
});
test("operands of every kind come back", () => {
  const whole = module(CODE);
  assert.deepEqual(unpacked(pack(whole).packed), whole);
});
test("functions in another order do the same", () => {
  // An imported function, 0, gives 7; 1 calls 4 and 0, 2 calls 1 and 3 (by the table), 3 is a constant, and 4 calls 3 twice.
  const bodies = [[0, 0x10, 4, 0x10, 0, 0x6a, 0x0b], [0, 0x10, 1, 0x41, 1, 0x11, 0, 0, 0x6c, 0x0b], [0, 0x41, 5, 0x0b], [0, 0x10, 3, 0x10, 3, 0x6a, 0x0b]];
  const named = (names) => [names.length, ...names.flatMap(([name, index]) => [1, name.charCodeAt(0), 0, index])];
  const whole = (...more) => Uint8Array.from([
    0, ...Buffer.from("asm"), 1, 0, 0, 0, ...section(1, [1, 0x60, 0, 1, 0x7f]), ...section(2, [1, 1, 109, 1, 102, 0, 0]),
    ...section(3, [4, 0, 0, 0, 0]), ...section(4, [1, 0x70, 0, 2]), ...section(7, named([["a", 1], ["b", 2], ["c", 3], ["d", 4]])),
    ...section(9, [1, 0, 0x41, 0, 0x0b, 2, 2, 3]), ...section(10, [4, ...bodies.flatMap((body) => [body.length, ...body])]), ...more,
  ]);
  const results = (module) => {
    const { exports } = new WebAssembly.Instance(new WebAssembly.Module(module), { m: { f: () => 7 } });
    return ["a", "b", "c", "d"].map((name) => exports[name]());
  };
  const before = whole(), { packed, ordered } = pack(before);
  assert.ok(!ordered.equals(before) && ordered.equals(unpacked(packed)));
  assert.deepEqual(results(ordered), [17, 85, 5, 10]);
  assert.deepEqual(results(before), [17, 85, 5, 10]);
  // Names for people go by the places of functions.
  const withNames = whole(...section(0, [4, ...Buffer.from("name"), 1, 4, 1, 3, 1, 99]));
  assert.ok(pack(withNames).ordered.equals(withNames));
});
test("no module of WebAssembly 2.0 is not packed", () => {
  const unknown = module([0, 0xfe, 0, 0, 0x0b]), long = module([0, 0x20, 0x80, 0, 0x1a, 0x0b]);
  for (const wrong of [Buffer.from("\0asm"), unknown, long, module(CODE).subarray(0, 40)]) assert.equal(pack(wrong), null);
});
test("a damaged engine is none, or another; of a part there is none", () => {
  const { packed } = pack(module(CODE));
  for (let place = 0; place < packed.length; place++) {
    assert.equal(unpacked(packed.subarray(0, place)), undefined, `the first ${place} bytes`);
    // From the bytes of the first stream on: sizes before it ask for memory.
    for (const byte of place < 8 ? [] : [0, 1, 0x7f, packed[place] ^ 0x10]) {
      const damaged = Uint8Array.from(packed);
      damaged[place] = byte;
      unpacked(damaged);
    }
  }
});
