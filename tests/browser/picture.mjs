// The upper part of a page as a picture: `node picture.mjs FILE.png PAGE.html`.
import { writeFileSync } from "node:fs";
import { Browser } from "./chromium.mjs";

const [file, source] = process.argv.slice(2);
const browser = await Browser.start();
const page = await browser.open(source, { width: 1000, height: 900 });
writeFileSync(file, await page.screenshot(1310));
await page.close();
await browser.stop();
