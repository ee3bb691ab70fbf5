// The picture of README.md and those of docs/gallery.md, cut out of the examples' own pages: `node tests/browser/gallery.mjs SENSITOL [NAME..]`.
import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { Browser } from "./chromium.mjs";

const root = join(dirname(fileURLToPath(import.meta.url)), "..", "..");
/// Largest picture, and all together, in bytes.
const LARGEST = 40_000, ALL = 600_000;
/// Name of the picture, the command, the element of the page, and the scale where it is another one.
const PICTURES = [
  ["yield", ["analyze", "examples/shaft-and-bore/study.toml"], ".kc figure"],
  ["verdict", ["analyze", "examples/first-study/study.toml"], "section.verdict"],
  ["contributions", ["analyze", "examples/stacked-blocks/study.toml"], "table.drivers"],
  ["position", ["analyze", "examples/bolt-pattern/study.toml"], ".kc figure"],
  ["play", ["analyze", "examples/pin-and-slot/study.toml"], ".kc figure"],
  ["chain", ["analyze", "examples/spacer-stack/study.toml"], "svg.chain.wide"],
  ["tails", ["analyze", "examples/two-suppliers/study.toml"], ".tails"],
  ["shift", ["analyze", "examples/first-study/study.toml"], "table.spans ~ table.spans"],
  ["interactions", ["analyze", "examples/connecting-rod/study.toml"], "table.map", 0.75],
  ["assembly", ["analyze", "examples/shaft-two-bores/study.toml"], "#picture svg", 0.75],
  ["sweep", ["sweep", "examples/stacked-blocks/study.toml", "--over", "th=15:19:9"], "figure svg.wide"],
  ["tolerances", ["allocate", "examples/shaft-and-housing/study.toml"], "table.pareto"],
  ["front", ["allocate", "examples/shaft-and-housing/study.toml", "--pareto", "6"], "figure svg.wide"],
  ["sample", ["simulate", "examples/door-hinge/study.toml", "--samples", "20000"], ".kc figure"],
  ["lot", ["compare-lot", "examples/housing-lot/study.toml", "examples/housing-lot/parts.csv", "examples/housing-lot/assemblies.csv"], "figure svg.wide"],
  ["methods", ["compare", "examples/stacked-blocks/study.toml", "--samples", "20000", "--budget", "300"], "figure svg.wide"],
];
/// First screen of a page, for README.md: its file, the study, and the largest size in bytes.
const FIRST = ["report", "examples/first-study/study.toml", 150_000];
/// Margin around the element, in pixels of the page, and the scale of a picture.
const MARGIN = 8, SCALE = 0.8;

const [sensitol, ...names] = process.argv.slice(2);
const images = join(root, "docs", "images"), target = join(images, "gallery");
mkdirSync(target, { recursive: true });
const folder = mkdtempSync(join(tmpdir(), "sensitol-gallery-"));
const browser = await Browser.start();
let total = 0;
for (const [name, command, element, scale = SCALE] of PICTURES.filter(([name]) => names.length === 0 || names.includes(name))) {
  const file = join(folder, `${name}.html`);
  execFileSync(sensitol, [...command, "--html", file, "-q"], { cwd: root, stdio: ["ignore", "ignore", "inherit"] });
  const page = await browser.open(file);
  await page.evaluate("document.querySelectorAll('details').forEach((one) => { one.open = true; })");
  const box = await page.evaluate(`(() => {
    const { left, top, width, height } = document.querySelector(${JSON.stringify(element)}).getBoundingClientRect();
    return { left, top: top + scrollY, width, height };
  })()`);
  const clip = { x: box.left - MARGIN, y: box.top - MARGIN, width: box.width + 2 * MARGIN, height: box.height + 2 * MARGIN, scale };
  const { data } = await page.send("Page.captureScreenshot", { format: "png", captureBeyondViewport: true, clip });
  const picture = Buffer.from(data, "base64");
  if (picture.length > LARGEST) throw new Error(`${name}: ${picture.length} bytes, at most ${LARGEST}`);
  writeFileSync(join(target, `${name}.png`), picture);
  total += picture.length;
  console.log(`${name}: ${picture.length} bytes`);
  await page.close();
}
if (names.length === 0 || names.includes(FIRST[0])) {
  const [name, study, largest] = FIRST, file = join(folder, "first.html");
  execFileSync(sensitol, ["analyze", study, "--html", file, "-q"], { cwd: root, stdio: ["ignore", "ignore", "inherit"] });
  const page = await browser.open(file, { width: 1130 });
  const height = await page.evaluate("Math.ceil(document.querySelector('.drivers').getBoundingClientRect().bottom)");
  const picture = await page.screenshot(height + MARGIN);
  if (picture.length > largest) throw new Error(`${name}: ${picture.length} bytes, at most ${largest}`);
  writeFileSync(join(images, `${name}.png`), picture);
  console.log(`${name}: ${picture.length} bytes`);
  await page.close();
}
await browser.stop();
rmSync(folder, { recursive: true, force: true });
if (total > ALL) throw new Error(`${total} bytes together, at most ${ALL}`);
