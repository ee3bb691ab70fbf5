// Chromium by its own debugging protocol over a pipe: no package is needed beside Node and the browser.
import { spawn } from "node:child_process";
import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const PLACES = [process.env.CHROMIUM, "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];

/// Where the browser is; undefined where there is none.
export const installed = () => PLACES.find((path) => path && existsSync(path));

export class Browser {
  static async start() {
    const folder = mkdtempSync(join(tmpdir(), "sensitol-browser-"));
    const flags = [
      "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
      "--disable-component-update", "--disable-sync", "--remote-debugging-pipe", `--user-data-dir=${folder}`, "about:blank",
    ];
    const child = spawn(installed(), flags, { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
    return new Browser(child, folder);
  }

  constructor(child, folder) {
    Object.assign(this, { child, folder, waiting: new Map(), listeners: new Set(), last: 0 });
    let text = "";
    child.stdio[4].setEncoding("utf8");
    child.stdio[4].on("data", (chunk) => {
      const messages = (text + chunk).split("\0");
      text = messages.pop();
      messages.forEach((message) => this.heard(JSON.parse(message)));
    });
  }

  heard(message) {
    const waiting = this.waiting.get(message.id);
    if (waiting === undefined) {
      this.listeners.forEach((listener) => listener(message));
      return;
    }
    this.waiting.delete(message.id);
    if (message.error) waiting.reject(new Error(JSON.stringify(message.error)));
    else waiting.resolve(message.result);
  }

  send(method, params = {}, sessionId = undefined) {
    const id = ++this.last;
    this.child.stdio[3].write(`${JSON.stringify({ id, method, params, sessionId })}\0`);
    return new Promise((resolve, reject) => this.waiting.set(id, { resolve, reject }));
  }

  /// A page of this file or address, loaded; `complaints` collects what the console says, every exception, every breach of the
  /// policy, and every request beyond the page's own file.
  async open(file, { width = 1280, height = 900, dark = false } = {}) {
    const { targetId } = await this.send("Target.createTarget", { url: "about:blank" });
    const { sessionId } = await this.send("Target.attachToTarget", { targetId, flatten: true });
    const page = new Page(this, targetId, sessionId, /^https?:/.test(file) ? file : pathToFileURL(file).href);
    await page.prepare({ width, height, dark });
    return page;
  }

  async stop() {
    const ended = new Promise((resolve) => this.child.on("exit", resolve));
    await this.send("Browser.close").catch(() => {});
    await ended;
    rmSync(this.folder, { recursive: true, force: true, maxRetries: 5 });
  }
}

class Page {
  constructor(browser, targetId, sessionId, url) {
    Object.assign(this, { browser, targetId, sessionId, url, complaints: [] });
  }

  send(method, params) {
    return this.browser.send(method, params, this.sessionId);
  }

  async prepare({ width, height, dark }) {
    let loaded;
    const load = new Promise((resolve) => { loaded = resolve; });
    this.listener = ({ method, params, sessionId }) => {
      if (sessionId !== this.sessionId) return;
      if (method === "Page.loadEventFired") loaded();
      if (method === "Runtime.consoleAPICalled") this.complaints.push(`console: ${JSON.stringify(params.args)}`);
      if (method === "Runtime.exceptionThrown") {
        const { text, exception } = params.exceptionDetails;
        this.complaints.push(`exception: ${exception?.description ?? text}`);
      }
      if (method === "Log.entryAdded") this.complaints.push(`log: ${params.entry.text}`);
      if (method === "Network.requestWillBeSent" && params.request.url !== this.url) {
        this.complaints.push(`request: ${params.request.url}`);
      }
      if (method === "Page.javascriptDialogOpening") {
        this.complaints.push(`dialog: ${params.message}`);
        this.send("Page.handleJavaScriptDialog", { accept: true });
      }
    };
    this.browser.listeners.add(this.listener);
    for (const domain of ["Page", "Runtime", "Log", "Network"]) await this.send(`${domain}.enable`);
    await this.send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: width < 500 });
    const features = [{ name: "prefers-color-scheme", value: dark ? "dark" : "light" }];
    await this.send("Emulation.setEmulatedMedia", { features });
    await this.send("Page.navigate", { url: this.url });
    await load;
  }

  /// The value of an expression in the page, as data.
  async evaluate(expression) {
    const found = await this.send("Runtime.evaluate", { expression, returnByValue: true, awaitPromise: true });
    if (found.exceptionDetails) {
      throw new Error(found.exceptionDetails.exception?.description ?? found.exceptionDetails.text);
    }
    return found.result.value;
  }

  /// The whole page as PNG, down to a height.
  async screenshot(most = 6000) {
    const { cssContentSize } = await this.send("Page.getLayoutMetrics");
    const clip = { x: 0, y: 0, width: cssContentSize.width, height: Math.min(most, cssContentSize.height), scale: 1 };
    const { data } = await this.send("Page.captureScreenshot", { format: "png", captureBeyondViewport: true, clip });
    return Buffer.from(data, "base64");
  }

  /// As it prints, on a sheet of this width and height in inches.
  async pdf([paperWidth, paperHeight] = [8.5, 11]) {
    const { data } = await this.send("Page.printToPDF", { printBackground: false, paperWidth, paperHeight });
    return Buffer.from(data, "base64");
  }

  /// Laid out as on paper of this width in pixels.
  async asPaper(width) {
    await this.send("Emulation.setDeviceMetricsOverride", { width: Math.floor(width), height: 1000, deviceScaleFactor: 1, mobile: false });
    await this.send("Emulation.setEmulatedMedia", { media: "print" });
  }

  async close() {
    this.browser.listeners.delete(this.listener);
    await this.browser.send("Target.closeTarget", { targetId: this.targetId });
  }
}
