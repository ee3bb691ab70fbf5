// The picture of an assembly in a real browser: the script redraws what Rust has drawn, keys turn it, and a slider moves it.
import assert from "node:assert/strict";

const FRAME = "new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)))";
const DRAWN = "JSON.stringify([...document.querySelectorAll('.assembly .marks path')].map((path) => path.getAttribute('d')))";
const press = (key) => `document.querySelector('.stage').dispatchEvent(new KeyboardEvent('keydown', { key: ${JSON.stringify(key)}, bubbles: true }))`;
const numbers = (text) => text.match(/-?[\d.]+/g).map(Number);

/// Paths of a page that was written without its scripts, as Rust has drawn them.
const written = (text) => [...text.matchAll(/<g class="marks">(.*?)<\/g>/gs)].flatMap(([, marks]) => [...marks.matchAll(/ d="([^"]*)"/g)].map(([, d]) => d));

export const pictures = async (browser, file, text) => {
  const page = await browser.open(file);
  const drawn = async () => JSON.parse(await page.evaluate(DRAWN));
  const first = await drawn(), still = written(text);
  assert.equal(first.length, still.length);
  // Both have one decimal, and half of it may fall either way.
  first.forEach((d, i) => numbers(d).forEach((x, k) => assert.ok(Math.abs(x - numbers(still[i])[k]) < 0.11, `${d} was ${still[i]}`)));
  const changed = async (what) => {
    await page.evaluate(FRAME);
    const now = await drawn();
    assert.notDeepEqual(now, first, what);
    return now;
  };
  for (const key of ["ArrowLeft", "ArrowUp", "+", "-"]) {
    await page.evaluate(press(key));
    await changed(key);
    await page.evaluate(press("0"));
    await page.evaluate("new Promise((resolve) => setTimeout(resolve, 400))");
    assert.deepEqual(await drawn(), first, `0 after ${key}`);
  }
  assert.equal(await page.evaluate("document.querySelector('.ghost').getAttribute('d')"), "");
  await page.evaluate("(() => { const slider = document.querySelector('[data-sigma]'); slider.value = 2; slider.dispatchEvent(new Event('input', { bubbles: true })); })()");
  await changed("the slider");
  assert.match(await page.evaluate("document.querySelector('#picture output').textContent"), /^\+2\.0 sigma: .* enlarged \d+ times$/);
  assert.ok((await page.evaluate("document.querySelector('.ghost').getAttribute('d')")).length > 0, "a shadow of the nominal state stays");
  // Another characteristic has other colours.
  const colours = () => page.evaluate("JSON.stringify([...document.querySelectorAll('.assembly .marks path')].map((path) => path.getAttribute('class')))");
  const before = await colours();
  await page.evaluate("(() => { const select = document.querySelector('#picture select'); select.value = String(1 - select.value); select.dispatchEvent(new Event('change')); })()");
  assert.notEqual(await colours(), before);
  assert.deepEqual(page.complaints, []);
  await page.close();
};
