// Debian's Chromium, driven without a screen and without the net.
import { mkdtempSync, rmSync } from "node:fs";
import { after, test as unlimited, type TestContext } from "node:test";
import { tmpdir } from "node:os";
import { join } from "node:path";
import puppeteer, { type Browser, type Page } from "puppeteer-core";

/** The longest that a test waits for anything, ms: so long that no busy machine reaches it, and less than CTest waits. */
const patience = 200_000;

/** The longest that a test takes, ms: one that hangs does not keep those behind it, for all of which CTest waits 1800 s. */
const limit = 600_000;

export const test = (name: string, body: (context: TestContext) => Promise<void>) => unlimited(name, { timeout: limit }, body);

export interface Visit {
  browser: Browser;
  page: Page;
  /** What the console said in anger, and requests that left the machine. */
  faults: string[];
  close(): Promise<void>;
}

const folder = mkdtempSync(join(tmpdir(), "tailwater-browser-"));
let started: Promise<Browser> | undefined;
after(async () => {
  await (await started)?.close();
  rmSync(folder, { recursive: true, force: true, maxRetries: 3 });
});

/** The one browser of all tests of a process, which takes longer to start than many a test. */
function theBrowser(): Promise<Browser> {
  return (started ??= puppeteer.launch({
    executablePath: process.env["CHROMIUM"]!, headless: true, userDataDir: folder, defaultViewport: { width: 1280, height: 720 }, timeout: patience, protocolTimeout: patience,
    args: [
      "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
      "--disable-extensions", "--enable-unsafe-swiftshader", "--use-angle=swiftshader", "--host-resolver-rules=MAP * ~NOTFOUND , EXCLUDE 127.0.0.1",
    ],
  }));
}

/** Opens `address` in a window of 1280 x 720 with a store of its own. `dark`: as a reader whose system is dark. */
export async function visit(address: string, dark = false): Promise<Visit> {
  const browser = await theBrowser();
  const context = await browser.createBrowserContext();
  const page = await context.newPage();
  page.setDefaultTimeout(patience);
  const faults: string[] = [];
  page.on("console", (message) => {
    if ((message.type() === "error" || message.type() === "warn") && !message.text().includes("GL Driver Message")) faults.push(`console: ${message.text()}`);
  });
  page.on("pageerror", (error) => faults.push(`error: ${error instanceof Error ? error.message : String(error)}`));
  page.on("request", (request) => {
    if (!/^(http:\/\/127\.0\.0\.1[:/]|file:|data:|blob:|about:)/.test(request.url())) faults.push(`request: ${request.url()}`);
  });
  await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: dark ? "dark" : "light" }]);
  await page.goto(address);
  return {
    browser, page, faults,
    close: () => context.close(),
  };
}

/** Waits until the page says yes to `condition`, a JavaScript expression in which `app` is the page's App. */
export async function until(page: Page, condition: string): Promise<void> {
  await page.waitForFunction(`(() => { const app = globalThis.tailwater; return app && (${condition}); })()`, { polling: 50 });
}

/** Where the eye of the picture is. */
export const camera = (page: Page) => page.evaluate("JSON.stringify([tailwater.view.eye.target, tailwater.view.eye.span])");

/** What a bar of `milliseconds` on a quiet machine is on this one now: as much more as a request and a picture take here,
 * the longest of five. */
export async function allowed(page: Page, milliseconds: number): Promise<number> {
  const taken = (await page.evaluate(`(async () => {
    let longest = 0;
    for (let i = 0; i < 5; ++i) {
      const began = performance.now();
      await (await fetch("api/state")).json();
      await new Promise(requestAnimationFrame);
      longest = Math.max(longest, performance.now() - began);
    }
    return longest;
  })()`)) as number;
  return milliseconds * Math.max(1, taken / 25);
}
