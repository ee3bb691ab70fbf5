// What a printed page holds, read from the PDF that Chromium makes: streams of operators, of which only places matter.
import { inflateSync } from "node:zlib";

const MM = 72 / 25.4;
/// The margins of printed pages, as the style sheet has them: above, beside, below.
export const MARGINS = [13 * MM, 12 * MM, 16 * MM];
/// Width and height of the sheets in inches.
export const SHEETS = { A4: [210 / 25.4, 297 / 25.4], Letter: [8.5, 11] };

/// How far down the content of every page reaches, as a part of the room between the margins; footers do not count.
export function filled(pdf) {
  const text = pdf.toString("latin1");
  const objects = new Map();
  for (const match of text.matchAll(/(?:^|\n)(\d+) 0 obj\n/g)) objects.set(match[1], match.index + match[0].length);
  const pages = [];
  for (const from of objects.values()) {
    const end = text.indexOf("endobj", from), head = text.slice(from, Math.min(end, from + 3000));
    if (!/^<<\/Type \/Page\s/.test(head)) continue;
    const height = Number(head.match(/\/MediaBox \[\S+ \S+ \S+ (\S+)\]/)[1]);
    const content = objects.get(head.match(/\/Contents (\d+) 0 R/)[1]);
    const begin = text.indexOf("stream\n", content) + 7;
    const operators = inflateSync(pdf.subarray(begin, text.indexOf("endstream", begin))).toString("latin1");
    pages.push(reach(operators, height));
  }
  return pages;
}

const times = ([a, b, c, d, e, f], [A, B, C, D, E, F]) =>
  [a * A + b * C, a * B + b * D, c * A + d * C, c * B + d * D, e * A + f * C + E, e * B + f * D + F];

/// Of a page of this height in points, as a part of the room.
function reach(operators, height) {
  const [above, , below] = MARGINS, room = height - above - below;
  let state = { at: [1, 0, 0, 1, 0, 0], white: false }, line = [1, 0, 0, 1, 0, 0], path = [], most = 0;
  const saved = [];
  const painted = (x, y, at = state.at) => {
    const down = height - (at[1] * x + at[3] * y + at[5]);
    if (down < height - below) most = Math.max(most, down - above);
  };
  for (const row of operators.split("\n")) {
    const words = row.trim().split(/\s+/), operator = words.at(-1), numbers = words.slice(0, -1).map(Number);
    if (operator === "q") saved.push({ ...state });
    else if (operator === "Q") state = saved.pop();
    else if (operator === "cm") state.at = times(numbers, state.at);
    else if (row.endsWith(" rg")) state.white = /1 1 1 rg$/.test(row);
    else if (operator === "re") path.push([numbers[0], numbers[1]], [numbers[0] + numbers[2], numbers[1] + numbers[3]]);
    else if (["m", "l", "c"].includes(operator)) path.push(numbers.slice(-2));
    else if (operator === "n") path = [];
    else if (["f", "f*", "S", "B"].includes(operator)) {
      // White on white is nothing.
      if (operator === "S" || !state.white) path.forEach(([x, y]) => painted(x, y));
      path = [];
    } else if (operator === "Tm") line = numbers;
    else if (operator === "Tj") painted(0, 0, times(line, state.at));
  }
  return Math.max(0, most) / room;
}

/// What is wrong with a page on a sheet of this width in pixels: boxes beyond the right edge, and text of charts below 7 points.
export const FAULTS = `(() => {
  const found = new Set(), width = document.documentElement.clientWidth;
  for (const one of document.querySelectorAll("body *")) {
    const box = one.getBoundingClientRect();
    if (box.width === 0 || one.closest(".sr") || getComputedStyle(one).visibility === "hidden") continue;
    if (box.right > width + 1 && !one.ownerSVGElement) found.add(one.tagName + "." + (one.getAttribute("class") ?? "") + " ends " + Math.round(box.right - width) + " pixels beyond the edge: " + one.textContent.slice(0, 40));
  }
  for (const text of document.querySelectorAll("svg text")) {
    if (text.getBoundingClientRect().width === 0) continue;
    const points = 0.75 * parseFloat(getComputedStyle(text).fontSize) * text.getScreenCTM().a;
    if (points < 6.99) found.add(text.ownerSVGElement.getAttribute("class") + " has text of " + points.toFixed(1) + " points");
  }
  return [...found].slice(0, 6);
})()`;
