// How pages look: light, dark, on a phone of 360 pixels, and printed. `node screenshots.mjs FOLDER PAGE.html..`
import { mkdirSync, writeFileSync } from "node:fs";
import { basename, join } from "node:path";
import { Browser } from "./chromium.mjs";

const [folder, ...pages] = process.argv.slice(2);
mkdirSync(folder, { recursive: true });
const browser = await Browser.start();
for (const file of pages) {
  const name = join(folder, basename(file, ".html"));
  for (const [look, options] of [["light", {}], ["dark", { dark: true }], ["phone", { width: 360, height: 740 }]]) {
    const page = await browser.open(file, options);
    writeFileSync(`${name}-${look}.png`, await page.screenshot());
    if (look === "light") writeFileSync(`${name}.pdf`, await page.pdf());
    const beyond = await page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth");
    if (beyond > 0) console.log(`${name}-${look}: ${beyond} pixels wider than the window`);
    page.complaints.forEach((complaint) => console.log(`${name}-${look}: ${complaint}`));
    await page.close();
  }
}
await browser.stop();
