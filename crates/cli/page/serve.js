"use strict";
// A page that `sensitol serve` serves: the studies of a folder, and the engine of the program. Null in a page that stands alone.
const served = (() => {
  const given = JSON.parse(document.getElementById("server-data").textContent);
  if (given === null) return null;
  const at = (what, about) => `${what}?${new URLSearchParams(about).toString().replaceAll("+", "%20")}`;
  const heard = async (answer) => {
    if (answer.ok) return answer.status === 204 ? null : answer.json();
    const told = await answer.json().catch(() => ({ refused: answer.statusText }));
    throw Object.assign(new Error(told.refused), { status: answer.status });
  };
  const get = async (what, about = {}, signal = undefined) => heard(await fetch(at(what, about), { signal }));
  // The engine as the page knows it, where the program runs: ask and stop.
  class Engine {
    #running = new Set();
    // A program starts only where the user asked for it.
    async ask(call, task, counted, programs = false) {
      if (task === undefined) return get("models");
      const abort = new AbortController();
      this.#running.add(abort);
      try {
        const options = { method: "POST", body: JSON.stringify({ ...task, files: {} }), signal: abort.signal };
        const answer = await fetch(at(call === "study" ? "keys" : "run", { path: task.name, ...(programs && { programs: "yes" }) }), options);
        if (call === "study" || !answer.ok) return await heard(answer);
        return await this.#found(answer.body, counted);
      } catch (error) {
        throw error.name === "AbortError" ? new Error("stopped") : error;
      } finally {
        this.#running.delete(abort);
      }
    }
    // Lines of JSON: how far it is, and at last what was found.
    async #found(body, counted) {
      const reader = body.pipeThrough(new TextDecoderStream()).getReader();
      let rest = "";
      for (;;) {
        const { done, value } = await reader.read();
        if (done) throw new Error("the server has ended the run");
        const lines = (rest + value).split("\n");
        rest = lines.pop();
        for (const line of lines.filter(Boolean)) {
          const told = JSON.parse(line);
          if (told.found !== undefined) return told.found;
          counted?.(told.answered, told.expected);
        }
      }
    }
    stop() { this.#running.forEach((abort) => abort.abort()); }
  }
  const save = async (path, text, hash, overwrite = false) => {
    const about = { path, hash: hash ?? "", ...(overwrite && { overwrite: "yes" }) };
    return heard(await fetch(at("study", about), { method: "PUT", body: text }));
  };
  // Tells of every change of a file until another one is watched.
  let watching = null;
  const watch = async (path, hash, told) => {
    watching?.abort();
    const mine = new AbortController();
    watching = mine;
    for (let known = hash; !mine.signal.aborted;) {
      try {
        const found = await get("changed", { path, hash: known ?? "" }, mine.signal);
        if (found === null || mine.signal.aborted) continue;
        known = found.hash;
        told(known);
      } catch {
        // The server has gone, or will be back.
        if (!mine.signal.aborted) await new Promise((resolve) => { setTimeout(resolve, 3000); });
      }
    }
  };
  return { folder: given.folder, Engine, save, watch, list: async () => (await get("studies")).studies, read: (path) => get("study", { path }) };
})();
