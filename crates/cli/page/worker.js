"use strict";
// The engine, beside the page. Messages: { start: module } once, then { id, call, task }.
let engine;
onmessage = ({ data }) => {
  if (data.start) {
    wasm_bindgen.initSync({ module: data.start });
    engine = wasm_bindgen;
    postMessage({ ready: engine.version() });
    return;
  }
  const { id, call, task } = data;
  try {
    const counted = (answered, expected) => postMessage({ id, answered, expected });
    const told = task === undefined ? engine.models() : call === "study" ? engine.study(JSON.stringify(task)) : engine.run(JSON.stringify(task), counted);
    postMessage({ id, found: JSON.parse(told) });
  } catch (error) {
    postMessage({ id, failed: String(error.message ?? error) });
  }
};
