"use strict";
// Unpacks the engine, beside the page: a module of WebAssembly from its streams, each compressed by LZMA. web/pack packs, and says how.
// Message: the packed engine as text; the answer is the module, or nothing where it is damaged.

// The bytes of a text of 93 characters, "!" to "~" without "<". The first 35 stand for the 6 bits of their place, the other 58 for 7 bits:
// a compressor that counts characters, as gzip, then takes as many bits for them.
const bytes = (text) => {
  const all = new Uint8Array(text.length), SHORT = 35;
  let at = 0, bits = 0, waiting = 0;
  for (let i = 0; i < text.length; i++) {
    const code = text.charCodeAt(i), place = code - (code > 0x3c ? 0x22 : 0x21), short = place < SHORT;
    bits += short ? 6 : 7;
    waiting = (waiting << (short ? 6 : 7) | (short ? place : place + SHORT)) & 0x3fff;
    if (bits >= 8) {
      bits -= 8;
      all[at++] = waiting >> bits;
    }
  }
  return all.subarray(0, at);
};

// LZMA by the specification of I. Pavlov, 2015, in the public domain: `size` bytes without a header and an end marker.
const decompress = (packed, size, properties) => {
  const lc = properties % 9, lp = Math.floor(properties / 9) % 5, pb = Math.floor(properties / 45), out = new Uint8Array(size);
  // Probabilities of a bit to be 0 are parts of 2048.
  const even = (count) => new Uint16Array(count).fill(1024);
  // Range and code, as words without a sign.
  const words = new Uint32Array([-1, 0]);
  let place = 1, state = 0, at = 0;
  for (let i = 0; i < 4; i++) words[1] = words[1] << 8 | packed[place++];
  // Numbers of so many bits, the highest first; a bit; bits of even probability; and numbers with the lowest bit first.
  const tree = (probabilities, first, bits) => {
    let range = words[0], code = words[1], node = 1;
    for (let i = 0; i < bits; i++) {
      const index = first + node, probability = probabilities[index], bound = Math.imul(range >>> 11, probability) >>> 0;
      if (code < bound) {
        probabilities[index] = probability + (2048 - probability >> 5);
        range = bound;
        node <<= 1;
      } else {
        probabilities[index] = probability - (probability >> 5);
        range = range - bound >>> 0;
        code = code - bound >>> 0;
        node = node << 1 | 1;
      }
      if (range < 1 << 24) {
        range = range << 8 >>> 0;
        code = (code << 8 | packed[place++]) >>> 0;
      }
    }
    words[0] = range;
    words[1] = code;
    return node - (1 << bits);
  };
  const bit = (probabilities, index) => tree(probabilities, index - 1, 1);
  const direct = (bits) => {
    let value = 0;
    for (let i = 0; i < bits; i++) {
      words[0] >>>= 1;
      const one = words[1] >= words[0];
      if (one) words[1] -= words[0];
      if (words[0] < 1 << 24) {
        words[0] <<= 8;
        words[1] = words[1] << 8 | packed[place++];
      }
      value = value << 1 | one;
    }
    return value;
  };
  const reverse = (probabilities, first, bits) => {
    let node = 1, value = 0;
    for (let i = 0; i < bits; i++) {
      const one = bit(probabilities, first + node);
      node = node << 1 | one;
      value |= one << i;
    }
    return value;
  };
  const lengths = () => {
    const choices = even(2), low = even(128), middle = even(128), high = even(256);
    return (position) => {
      if (!bit(choices, 0)) return 2 + tree(low, position << 3, 3);
      if (!bit(choices, 1)) return 10 + tree(middle, position << 3, 3);
      return 18 + tree(high, 0, 8);
    };
  };
  const literals = even(0x300 << lc + lp), matches = even(192), repeated = even(12), longs = even(192);
  const older = [even(12), even(12), even(12)], slots = even(256), special = even(128), align = even(16);
  const length = lengths(), repeatedLength = lengths();
  const distance = (slot) => {
    if (slot < 4) return slot;
    const bits = (slot >> 1) - 1, base = (2 | slot & 1) << bits;
    return slot < 14 ? base + reverse(special, base - slot, bits) : base + (direct(bits - 4) << 4) + reverse(align, 0, 4);
  };
  // Distances of the last four matches, less 1.
  const last = [0, 0, 0, 0];
  const recent = (place, distance) => {
    for (let i = place; i > 0; i--) last[i] = last[i - 1];
    last[0] = distance;
  };
  while (at < size) {
    const position = at & (1 << pb) - 1;
    if (!bit(matches, state << 4 | position)) {
      const first = 0x300 * (((at & (1 << lp) - 1) << lc) + ((at ? out[at - 1] : 0) >> 8 - lc));
      let symbol = 1;
      // After a match the byte is probably not that which followed it before.
      for (let matched = state < 7 ? -1 : out[at - last[0] - 1]; matched >= 0 && symbol < 0x100;) {
        const expected = (matched <<= 1) >> 8 & 1, one = bit(literals, first + (1 + expected << 8) + symbol);
        symbol = symbol << 1 | one;
        if (one !== expected) break;
      }
      if (state < 7) symbol = tree(literals, first, 8); else while (symbol < 0x100) symbol = symbol << 1 | bit(literals, first + symbol);
      out[at++] = symbol;
      state = state < 4 ? 0 : state < 10 ? state - 3 : state - 6;
      continue;
    }
    let count;
    if (!bit(repeated, state)) {
      count = length(position);
      recent(3, distance(tree(slots, Math.min(count - 2, 3) << 6, 6)));
      state = state < 7 ? 7 : 10;
    } else {
      const newest = !bit(older[0], state), short = newest && !bit(longs, state << 4 | position);
      if (!newest) {
        const which = bit(older[1], state) ? 2 + bit(older[2], state) : 1;
        recent(which, last[which]);
      }
      count = short ? 1 : repeatedLength(position);
      state = state >= 7 ? 11 : short ? 9 : 8;
    }
    // A match may reach into what it writes.
    const from = at - last[0] - 1;
    count = Math.min(count, size - at);
    for (let i = 0; i < count; i++) out[at + i] = out[from + i];
    at += count;
  }
  return out;
};

// The module of its streams, which stand in the order of web/pack.
const join = (streams, size, imports) => {
  const [MODULE, DATA, OPERATOR, LOCALS, GET, , , OFFSET, STEP, ARGUMENT, INTEGER, LONG, FLOAT, CALLEE, BRANCH, BLOCK, OTHER] = streams.keys();
  // Sizes of the last function and of all take five bytes each until they are known.
  const places = new Uint32Array(streams.length), module = new Uint8Array(size + 10);
  let at = 0;
  const next = (stream) => {
    if (places[stream] >= streams[stream].length) throw new RangeError("a stream ends too soon");
    return streams[stream][places[stream]++];
  };
  const put = (byte) => { module[at++] = byte; };
  const copied = (stream) => module[at++] = next(stream);
  const copy = (stream, count) => { for (let i = 0; i < count; i++) copied(stream); };
  // Numbers in groups of 7 bits, the lowest first; those whose value does not matter here stand with the highest first.
  const read = (stream) => {
    for (let value = 0, shift = 0; ; shift += 7) {
      const byte = next(stream);
      value |= (byte & 127) << shift;
      if (byte < 128) return value;
    }
  };
  const write = (value) => {
    for (; value > 127; value >>>= 7) module[at++] = value | 128;
    module[at++] = value;
  };
  const number = (stream) => {
    const value = read(stream);
    write(value);
    return value;
  };
  const digits = (stream) => {
    const start = at;
    while (copied(stream) > 127);
    if (at - start > 1) {
      module.subarray(start, at).reverse();
      module[start] |= 128;
      module[at - 1] &= 127;
    }
  };
  // The bytes that `fill` writes, after their number.
  const sized = (fill) => {
    const start = at, content = at += 5;
    fill();
    const end = at;
    at = start;
    write(end - content);
    module.copyWithin(at, content, end);
    at += end - content;
  };
  // Operators of local variables have the variable's place among those used last; of the first few the operator's byte has it.
  const recent = new Uint16Array(50000);
  let known;
  const local = (which, place) => {
    for (; known <= place; known++) recent[known] = known;
    const variable = recent[place];
    for (let i = place; i > 0; i--) recent[i] = recent[i - 1];
    recent[0] = variable;
    put(0x20 + which);
    write(variable);
  };
  const FIRST = [0xc5, 0xc8, 0xca, 0xcc];
  // Alignments follow from operators for the most part. An offset of 0 stands in the operator's byte too.
  const ALIGNED = [2, 3, 2, 3, 0, 0, 1, 1, 0, 0, 1, 1, 2, 2, 2, 3, 2, 3, 0, 1, 0, 1, 2], UNALIGNED = 0xcc, WITHOUT_OFFSET = 0xd3;
  // The function after this one and all that were called.
  let following = imports;
  const body = (place) => {
    following = Math.max(following, imports + place + 1);
    known = 0;
    for (let groups = number(LOCALS); groups > 0; groups--) {
      number(LOCALS);
      copied(LOCALS);
    }
    for (let depth = 1; depth > 0;) {
      const byte = next(OPERATOR);
      if (byte >= 0x20 && byte <= 0x22) {
        const which = byte - 0x20;
        local(which, read(GET + which) + FIRST[which + 1] - FIRST[which]);
        continue;
      }
      if (byte >= FIRST[0] && byte < FIRST[3]) {
        const which = byte < FIRST[1] ? 0 : byte < FIRST[2] ? 1 : 2;
        local(which, byte - FIRST[which]);
        continue;
      }
      if (byte >= 0x28 && byte <= 0x3e) {
        put(byte);
        put(ALIGNED[byte - 0x28]);
        digits(OFFSET);
        continue;
      }
      if (byte >= WITHOUT_OFFSET && byte < WITHOUT_OFFSET + ALIGNED.length) {
        const which = byte - WITHOUT_OFFSET;
        put(0x28 + which);
        put(ALIGNED[which]);
        put(0);
        continue;
      }
      if (byte === UNALIGNED) {
        copy(OPERATOR, 2);
        digits(OFFSET);
        continue;
      }
      put(byte);
      switch (byte) {
        case 0x02: case 0x03: case 0x04: depth++; digits(BLOCK); break;
        case 0x0b: depth--; break;
        case 0x0c: case 0x0d: digits(BRANCH); break;
        case 0x0e: for (let labels = number(BRANCH); labels >= 0; labels--) digits(BRANCH); break;
        case 0x10: case 0x12: case 0xd2: {
          const callee = read(CALLEE);
          write(callee ? callee - 1 : following++);
          break;
        }
        case 0x11: case 0x13: digits(OTHER); digits(OTHER); break;
        case 0x1c: copy(OTHER, number(OTHER)); break;
        case 0x23: case 0x24: case 0x25: case 0x26: case 0x3f: case 0x40: case 0xd0: digits(OTHER); break;
        case 0x41: {
          const after = streams[OPERATOR][places[OPERATOR]];
          const argument = after === 0x10 || after === 0x20 || after === 0x41 || (after >= FIRST[0] && after < FIRST[1]);
          digits(after === 0x6a || after === 0x6b ? STEP : argument ? ARGUMENT : INTEGER);
          break;
        }
        case 0x42: digits(LONG); break;
        case 0x43: copy(FLOAT, 4); break;
        case 0x44: copy(FLOAT, 8); break;
        case 0xfc: {
          const which = number(OPERATOR);
          if (which >= 8) digits(OTHER);
          if (which === 8 || which === 10 || which === 12 || which === 14) digits(OTHER);
          break;
        }
        case 0xfd: {
          const which = number(OPERATOR), lane = which >= 84 && which < 92;
          if (which < 12 || lane || which === 92 || which === 93) {
            copied(OPERATOR);
            digits(OFFSET);
          } else if (which < 14) copy(FLOAT, 16);
          if (lane || (which >= 21 && which < 35)) copied(OTHER);
        }
      }
    }
  };
  copy(MODULE, 8);
  while (places[MODULE] < streams[MODULE].length) {
    const section = copied(MODULE);
    if (section === 10) sized(() => { for (let i = 0, functions = number(MODULE); i < functions; i++) sized(() => body(i)); });
    else {
      const stream = section === 11 ? DATA : MODULE;
      copy(stream, number(stream));
    }
  }
  return at === size ? module.subarray(0, size) : undefined;
};

// Undefined where `packed` is not what web/pack makes.
const unpacked = (packed) => {
  let place = 0;
  const number = () => {
    for (let value = 0, shift = 0; ; shift += 7) {
      const byte = packed[place++];
      value |= (byte & 127) << shift;
      if (!(byte > 127)) return value;
    }
  };
  try {
    const size = number(), imports = number();
    const streams = Array.from({ length: 17 }, () => {
      const size = number(), length = number(), properties = packed[place++];
      return decompress(packed.subarray(place, place += length), size, properties);
    });
    return place === packed.length ? join(streams, size, imports) : undefined;
  } catch (error) {
    if (error instanceof RangeError) return undefined;
    throw error;
  }
};

onmessage = ({ data }) => {
  const module = unpacked(bytes(data));
  postMessage(module, module ? [module.buffer] : []);
};
