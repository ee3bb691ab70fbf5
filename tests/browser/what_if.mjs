// What the script of a page makes of settings, without a browser: `node what_if.mjs PAGE.html SETTINGS.json` prints JSON.
import { readFileSync } from "node:fs";
import { runInNewContext } from "node:vm";

const [page, file] = process.argv.slice(2);
const scripts = [...readFileSync(page, "utf8").matchAll(/<script(?: [^>]*)?>([^]*?)<\/script>/g)].map((match) => match[1]);
const data = JSON.parse(scripts[0]);
// All but what needs a document.
const mathematics = scripts[1].slice(0, scripts[1].indexOf("// The what-if of the page"));
const live = runInNewContext(`${mathematics}; live`);
// Shares by the page's own source, rejects as shown, and the variance by part.
const beyond = (sides, side) => sides[side]?.value ?? null;
const figures = ({ mean, sigma, skewness, excess, cpk, linear, curvature, interactions, by, shares, rejects, interval }) => ({
  mean, sigma, skewness, excess, cpk, linear, curvature, interactions, by, interval,
  below: beyond(shares, 0), above: beyond(shares, 1), errors: shares.map((side) => side?.error ?? null),
  rejects: [beyond(rejects, 0), beyond(rejects, 1)],
});
const found = JSON.parse(readFileSync(file, "utf8")).map((settings) => ({
  toml: live.toml(data, settings),
  cost: live.cost(data, settings),
  characteristics: data.characteristics.map((one) => one.why === null ? figures(live.evaluate(data, one, settings)) : null),
}));
console.log(JSON.stringify({ names: data.dimensions.map((one) => one.name), fixed: data.dimensions.map((one) => one.fixed), found }));
