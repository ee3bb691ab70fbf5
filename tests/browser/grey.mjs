// A part of a printed page in greyscale, as numbers: what an office printer makes of it.
import { inflateSync } from "node:zlib";

/// Lets the page look as it prints, without colour.
export const asGrey = async (page, width) => {
  await page.asPaper(width);
  await page.evaluate("document.documentElement.style.filter = 'grayscale(1)'");
};

/// The luminance from 0 to 1 of every pixel of an element, by rows; the element is the `index`th of its selector that has an area.
export const luminances = async (page, selector, index = 0) => {
  const box = await page.evaluate(`(() => {
    const one = [...document.querySelectorAll(${JSON.stringify(selector)})].filter((one) => one.getBoundingClientRect().height > 0)[${index}];
    const { left, top, width, height } = one.getBoundingClientRect();
    return { x: left + scrollX, y: top + scrollY, width, height };
  })()`);
  const { data } = await page.send("Page.captureScreenshot", { format: "png", captureBeyondViewport: true, clip: { ...box, scale: 2 } });
  return pixels(Buffer.from(data, "base64"));
};

/// The luminances of a PNG of 8 bits a channel that is not interlaced, as Chromium writes it.
export function pixels(png) {
  const width = png.readUInt32BE(16), height = png.readUInt32BE(20), channels = { 2: 3, 6: 4 }[png[25]];
  if (png[24] !== 8 || channels === undefined || png[28] !== 0) throw new Error("a PNG of another kind");
  const parts = [];
  for (let at = 8; at < png.length; at += 12 + png.readUInt32BE(at)) {
    if (png.toString("latin1", at + 4, at + 8) === "IDAT") parts.push(png.subarray(at + 8, at + 8 + png.readUInt32BE(at)));
  }
  const raw = inflateSync(Buffer.concat(parts)), stride = width * channels, rows = [];
  let above = new Uint8Array(stride);
  for (let y = 0; y < height; y++) {
    const kind = raw[y * (stride + 1)], row = Uint8Array.from(raw.subarray(y * (stride + 1) + 1, (y + 1) * (stride + 1)));
    for (let i = 0; i < stride; i++) {
      const left = i < channels ? 0 : row[i - channels], up = above[i], corner = i < channels ? 0 : above[i - channels];
      row[i] += [0, left, up, (left + up) >> 1, paeth(left, up, corner)][kind];
    }
    rows.push(Array.from({ length: width }, (_, x) => luminance(row[x * channels])));
    above = row;
  }
  return rows;
}

const paeth = (a, b, c) => {
  const p = a + b - c, [pa, pb, pc] = [a, b, c].map((value) => Math.abs(p - value));
  return pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
};

/// Relative luminance of a grey (WCAG 2.2).
const luminance = (grey) => (grey <= 10 ? grey / 255 / 12.92 : ((grey / 255 + 0.055) / 1.055) ** 2.4);

/// Contrast of two luminances (WCAG 2.2): 1 for the same, 21 for black and white.
export const contrast = (a, b) => (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);

/// How often a row of pixels changes between dark and light.
export const changes = (row) => row.slice(1).filter((value, i) => (value < 0.4) !== (row[i] < 0.4)).length;
