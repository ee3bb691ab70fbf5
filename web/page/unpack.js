"use strict";
// Unpacks the engine, beside the page. Message: { unpacker, packed } in base64; the answer is the module, or nothing where it is damaged.
onmessage = ({ data }) => {
  const bytes = (base64) => {
    const text = atob(base64), bytes = new Uint8Array(text.length);
    for (let i = 0; i < bytes.length; i++) bytes[i] = text.charCodeAt(i);
    return bytes;
  };
  wasm_bindgen.initSync({ module: bytes(data.unpacker) });
  const module = wasm_bindgen.unpacked(bytes(data.packed));
  postMessage(module, module ? [module.buffer] : []);
};
