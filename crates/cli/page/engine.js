"use strict";
// Workers that hold the engine. A run is ended by ending its worker.
const engine = (() => {
  let compiled, source;
  const load = async () => {
    const text = (id) => document.getElementById(id).textContent.trim();
    const script = (...ids) => URL.createObjectURL(new Blob(ids.map((id) => `${text(id)}\n`), { type: "text/javascript" }));
    const packed = Uint8Array.from(atob(text("engine-gzip")), (character) => character.charCodeAt(0));
    const unpacked = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
    try {
      compiled = await WebAssembly.compile(await new Response(unpacked).arrayBuffer());
    } catch (error) {
      throw new Error(`the engine in this page is damaged: ${error.message ?? error}`);
    }
    source = script("engine-glue", "engine-worker");
  };
  class Engine {
    #worker; #waiting = new Map(); #last = 0; #ready;
    start() {
      this.#worker = new Worker(source);
      this.#ready = new Promise((resolve) => {
        this.#worker.onmessage = ({ data }) => {
          if (data.ready) return resolve(data.ready);
          const waiting = this.#waiting.get(data.id);
          if (waiting === undefined) return undefined;
          if (data.answered !== undefined) return waiting.counted?.(data.answered, data.expected);
          this.#waiting.delete(data.id);
          // What has trapped does not work on.
          if (data.failed !== undefined) this.stop();
          return data.failed === undefined ? waiting.resolve(data.found) : waiting.reject(new Error(data.failed));
        };
      });
      this.#worker.postMessage({ start: compiled });
      return this.#ready;
    }
    ask(call, task, counted) {
      if (this.#worker === undefined) this.start();
      const id = ++this.#last, worker = this.#worker;
      return new Promise((resolve, reject) => {
        this.#waiting.set(id, { resolve, reject, counted });
        // A worker that was ended before it was ready is never asked.
        this.#ready.then(() => worker.postMessage({ id, call, task }));
      });
    }
    stop() {
      this.#worker?.terminate();
      this.#worker = undefined;
      const waiting = [...this.#waiting.values()];
      this.#waiting.clear();
      waiting.forEach((one) => one.reject(new Error("stopped")));
    }
  }
  return { load, Engine };
})();
