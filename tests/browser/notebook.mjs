// The page of a result in a notebook, as tests/python/run leaves it: its frame shows the report, and a slider moves a yield.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Browser } from "./chromium.mjs";

const FRAME = "document.querySelector('iframe').contentDocument";

test("a slider in a notebook changes the yield", async () => {
  const browser = await Browser.start();
  // The notebook's own page cannot reach into the frame: the test lets it, and nothing else changes.
  const page = await browser.open(process.env.SENSITOL_NOTEBOOK_PAGE);
  const open = `new Promise((resolve) => {
    const frame = document.querySelector("iframe");
    frame.addEventListener("load", () => resolve(true), { once: true });
    frame.setAttribute("sandbox", frame.getAttribute("sandbox") + " allow-same-origin");
    frame.srcdoc = frame.srcdoc;
  })`;
  assert.equal(await page.evaluate("document.querySelector('iframe').getAttribute('sandbox')"), "allow-scripts allow-downloads");
  await page.evaluate(open);
  const yields = () => page.evaluate(`${FRAME}.querySelector('[data-kc] [data-figure="yield"]').textContent`);
  const before = await yields();
  assert.match(before, /%/);
  await page.evaluate(`(() => {
    const input = ${FRAME}.querySelector('[data-dimension="0"] [data-set="factor"]');
    input.value = 250;
    input.dispatchEvent(new Event("input", { bubbles: true }));
  })()`);
  await page.evaluate("new Promise((resolve) => setTimeout(resolve, 500))");
  assert.notEqual(await yields(), before);
  assert.deepEqual(page.complaints.filter((one) => !one.startsWith("request: about:srcdoc") && !one.includes("allow-same-origin")), []);
  await page.close();
  await browser.stop();
});
