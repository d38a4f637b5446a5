// The report of `tailwater validate`, with the program itself behind it, and as the file that it makes.
import assert from "node:assert/strict";
import { mkdirSync, writeFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
import type { Page } from "puppeteer-core";
import type { Metric, Report } from "../../src/contract.ts";
import { test, until } from "../support/browser.ts";
import { withProgram } from "../support/program.ts";

const metric = (name: string, more: Partial<Metric>): Metric => ({
  name, what: name, value: 0.5, unit: "H", low: null, high: null, paper: null, peers: [], verdict: "shown", reference: "the laboratory", shifted_value: null,
  shift: null, shift_unit: "T", order: null, note: "", variant: "", ...more,
});
const points = (kind: "run" | "exact" | "measured" | "aside" | "spacings", label: string = kind) => ({ label, kind, x: [0.1, 0.2, 0.4], y: [1, null, 3] });

const report: Report = {
  version: "1.0.0", commit: "abc", level: "quick", scheme: "", ranks: 1, date: "2026-11-25T21:00:00+00:00", machine: { processor: "a processor", cores: 2 }, cpu_s: 75,
  studies: [
    {
      name: "dam", title: "A dam breaks <b>", kind: "Laboratory", about: "About it.", uncertainty: "By a twentieth.", shown: "dam", moments: [{ time: 0.5, label: "t = 0.5 s, T = 2" }],
      metrics: [
        metric("depth", { high: 0.6, verdict: "met", paper: 0.7, peers: [{ name: "another code", range: [0.9, 2] }], shifted_value: 0.4, shift: -0.1 }),
        metric("arrival", { value: 0.7, uncertainty: 0.034, low: 0.5, high: 0.6, verdict: "missed", result: "missed" }),
        metric("level", { value: 0.59, uncertainty: 0.02, high: 0.6, verdict: "met", result: "not resolved" }), metric("failed", { value: null, note: "it broke" }),
      ],
      runs: [{ name: "dam", message: "", particles: 200, steps: 100, spacing_m: 0.04 }, { name: "other", message: "made to fail" }],
      figures: [
        {
          caption: "Depths.",
          panels: [
            { title: "H1", x: "T", y: "h/H", logarithmic: false, limits: [0, 2], curves: [points("measured"), points("run", "fine"), points("run", "coarse"), points("exact"), points("aside")] },
            { title: "", x: "dx", y: "error", logarithmic: true, limits: null, curves: [points("spacings")] },
          ],
        },
        { caption: "Nothing.", missing: "no run reached its end" },
      ],
    },
    {
      name: "variants", title: "One thing changed", kind: "Comparisons", about: "", uncertainty: "", shown: null, moments: [], runs: [], figures: [],
      metrics: [metric("noise", { what: "noise", value: 2, variant: "free" }), metric("noise2", { what: "noise", value: 1, variant: "no slip" })],
    },
  ],
};

const text = (page: Page, selector: string) => page.$$eval(selector, (all) => all.map((e) => e.textContent!.trim().replace(/\s+/g, " ")));

/** From the report to the water of its run at a moment, and back. */
async function read(page: Page): Promise<void> {
  await until(page, "document.querySelectorAll('.one-panel canvas').length === 2");
  assert.equal(await page.title(), "Validation, level quick · Tailwater");
  assert.deepEqual(await text(page, ".report nav a"), ["A dam breaks <b>111", "One thing changed"]);
  assert.deepEqual(await text(page, "#dam tr.met td"), ["depth", "0.5", "H", "≤ 0.6", "0.7", "0.9 … 2", "✓ met", "the laboratory; 0.4 with the data 0.1 earlier"]);
  assert.deepEqual((await text(page, "#dam tr.missed td")).slice(0, 7), ["arrival", "0.7 ± 0.034", "H", "0.5 … 0.6", "", "", "✗ missed"]);
  assert.deepEqual((await text(page, "#dam tr.not-resolved td")).slice(0, 7), ["level", "0.59 ± 0.02", "H", "≤ 0.6", "", "", "? not resolved"]);
  assert.deepEqual((await text(page, ".tile")).slice(0, 4), ["1targets met", "1targets missed", "1targets not resolved", "3numbers without a target"]);
  assert.equal((await text(page, "#dam tr.shown td")).at(-1), "it broke");
  assert.deepEqual(await text(page, "#variants td"), ["noise", "H", "2", "1"]);
  assert.deepEqual(await page.$$eval("#variants .bar i", (bars) => bars.map((bar) => (bar as HTMLElement).style.width)), ["90%", "45%"]);
  assert.deepEqual(await text(page, ".peers .ours"), ["Tailwater0.5"]);
  assert.deepEqual(await text(page, ".one-panel:first-child .run-key li"), ["measured", "fine", "coarse", "exact", "aside"]);
  assert.deepEqual(await text(page, "figcaption"), ["Depths.", "Not drawn (no run reached its end): Nothing."]);
  assert.match((await text(page, "#dam details tr.missed"))[0]!, /other.*made to fail/);
  const colours = () => page.evaluate("tailwater.look.now.map");
  const before = await colours();
  await page.keyboard.press("c"); // a key of the picture, which is not seen
  assert.equal(await colours(), before);
  await page.evaluate("document.querySelector('.see button:nth-child(2)').click()");
  await until(page, "!app.look.now.reading && app.shown()[0]?.name === 'dam' && app.player.time === 0.5 && document.querySelector('.track input').value === '0.5' && app.shown()[0].frames.at(0.5)?.exact && app.view.eye");
  await page.waitForSelector(".gauge[data-probe=gauge] canvas");
  await page.evaluate("[...document.querySelectorAll('.top button')].find((b) => b.textContent === 'Report').click()");
  await until(page, "app.look.now.reading && !document.querySelector('.report').inert && !document.querySelector('.time')");
}

test("a report: numbers, plots, and the water of its runs; as a file", async (context) => {
  await withProgram(context, async (place, open) => {
    mkdirSync(place.path("validation/runs"), { recursive: true });
    writeFileSync(place.path("validation/report.json"), JSON.stringify(report));
    place.call("run", "dam.toml", "--out", "validation/runs/dam", "--quiet");
    await read(await open(await place.view("validation")));
    place.call("view", "validation", "--export", "report.html");
    await read(await open(pathToFileURL(place.path("report.html")).href));
  });
});
