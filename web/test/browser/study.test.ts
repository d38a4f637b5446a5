// A study: its table, values over the spacings, and the water of its runs, with the program behind it.
import assert from "node:assert/strict";
import { mkdirSync, writeFileSync } from "node:fs";
import type { SpacingStudy } from "../../src/contract.ts";
import { test, until } from "../support/browser.ts";
import { withProgram } from "../support/program.ts";

const row = { unit: "m", uncertainty: 0.02, discretisation: 0.01512, chance: null, averaging: 0.0123, step: 0.001, notes: "" };
const study: SpacingStudy & { runs: string[] } = {
  spacings_m: [0.04, 0.05, 0.08], runs: ["spacings/fine"],
  results: [
    { ...row, probe: "gauge", quantity: "depth", value: 0.5, low: 0.48, high: 0.52, limit: 0.512, order: 1.25, notes: "three spacings give an order that nothing confirms", values: [0.5, 0.497, 0.488] },
    { ...row, probe: "front", quantity: "largest <front>", value: 1.2, low: 1.18, high: 1.22, limit: null, order: null, values: [1.2, 1.21, 1.3] },
  ],
};

test("a study: numbers with intervals, and the water of its runs", async (context) => {
  await withProgram(context, async (place, open) => {
    mkdirSync(place.path("study/spacings"), { recursive: true });
    writeFileSync(place.path("study/study.json"), JSON.stringify(study));
    place.call("run", "dam.toml", "--out", "study/spacings/fine", "--quiet");
    const page = await open(await place.view("study"));
    await until(page, "document.querySelectorAll('.one-panel canvas').length === 2");
    assert.equal(await page.title(), "How well the numbers are known · Tailwater");
    const cells = await page.$$eval(".report tbody tr", (rows) => rows.map((r) => [...r.children].map((cell) => cell.textContent)));
    assert.deepEqual(cells[0], ["gauge", "depth", "m", "0.5", "0.02", "0.48", "0.52", "0.512", "1.3", "0.015", "–", "0.012", "0.001"]);
    assert.deepEqual(cells[1], [study.results[0]!.notes]);
    assert.deepEqual(cells[2]!.slice(1, 9), ["largest <front>", "m", "1.2", "0.02", "1.18", "1.22", "–", "–"]);
    assert.deepEqual(await page.$$eval(".one-panel:first-child .run-key li", (all) => all.map((e) => e.textContent!.trim())), ["computed", "limit", "interval"]);
    await page.evaluate("document.querySelector('.report nav button').click()");
    await until(page, "!app.look.now.reading && app.shown()[0]?.name === 'spacings/fine' && app.view.eye");
    await page.evaluate("[...document.querySelectorAll('.top button')].find((b) => b.textContent === 'Study').click()");
    await until(page, "app.look.now.reading && !document.querySelector('.report').inert");
  });
});
