"use strict";
// The studies of the folder that is served: opened, saved, shown again when they change.
const folder = (() => {
  const $ = (id) => document.getElementById(id);
  // The file that is open, what it is known by, and its text as it was opened or saved. An example has no file yet.
  let mine = null, known = null, saved = "";
  const dirty = () => page.text() !== saved;
  const mark = () => { document.title = `${dirty() ? "* " : ""}${page.name()} - sensitol`; };
  const list = async () => {
    const all = await served.list();
    const buttons = all.map((path) => `<button type="button" data-path="${page.esc(path)}">${page.esc(path)}</button>`);
    $("folder-list").innerHTML = buttons.join("") || "<p class=\"soft\">There is no study in this folder yet: Save makes one.</p>";
    return all;
  };
  const open = async (path) => {
    let found;
    try { found = await served.read(path); } catch (error) { return page.toast(`${path}: ${error.message}`); }
    [mine, known, saved] = [found.name, found.hash, found.text];
    await page.open({ name: found.name, text: found.text, files: {} });
    history.replaceState(null, "", `#f=${encodeURIComponent(path)}`);
    mark();
    return known === null ? undefined : served.watch(found.name, known, changed);
  };
  // A change on the disk is shown at once, unless that would lose what was typed.
  const changed = async (hash) => {
    if (hash === null) return page.toast(`${page.name()} is gone from the disk. Save writes it again.`);
    if (dirty()) return page.toast(`${page.name()} has changed on the disk. Save asks before it overwrites; Studies opens it again.`);
    await open(page.name());
    return page.toast(`${page.name()} has changed on the disk and is shown again`);
  };
  const write = async (overwrite) => {
    const text = page.text();
    ({ hash: known } = await served.save(page.name(), text, known, overwrite));
    [mine, saved] = [page.name(), text];
    mark();
    page.toast(`${page.name()} is saved`);
    served.watch(page.name(), known, changed);
    await list();
  };
  const save = async () => {
    if (known === null || page.name() !== mine) {
      known = null;
      const path = prompt("Save as, within the folder", page.name());
      if (path === null) return;
      page.rename(path.endsWith(".toml") ? path : `${path}.toml`);
    }
    try { await write(false); } catch (error) {
      if (error.status !== 409) return page.toast(`Not saved: ${error.message}`);
      if (confirm(`${page.name()} is on the disk with another content. Overwrite it?`)) await write(true).catch((again) => page.toast(`Not saved: ${again.message}`));
    }
  };
  const begin = async () => {
    $("folder-menu").hidden = $("save").hidden = false;
    $("folder-menu").querySelector("summary").textContent = served.folder || "Studies";
    const all = await list(), named = location.hash.startsWith("#f=") ? decodeURIComponent(location.hash.slice(3)) : null;
    if (named !== null || all.length > 0) return open(named ?? all[0]);
    return page.open({ name: "study.toml", text: "", files: {} });
  };
  if (served !== null) {
    $("folder-list").onclick = (event) => {
      const path = event.target.closest("button")?.dataset.path;
      if (path === undefined) return;
      $("folder-menu").open = false;
      if (!dirty() || confirm(`${page.name()} has changes that are not saved. Open the other study?`)) open(path);
    };
    $("folder-menu").addEventListener("toggle", () => { if ($("folder-menu").open) list(); });
    $("save").onclick = save;
    document.addEventListener("keydown", (event) => { if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === "s") { event.preventDefault(); save(); } });
    document.addEventListener("input", () => setTimeout(mark, 0));
    document.addEventListener("click", () => setTimeout(mark, 300));
    addEventListener("beforeunload", (event) => { if (dirty()) event.preventDefault(); });
  }
  return { begin };
})();
