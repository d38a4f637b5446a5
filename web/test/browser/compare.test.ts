import assert from "node:assert/strict";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { deflateSync } from "node:zlib";
import { basin, standingWave } from "../support/flows.ts";
import { Mock, page, run, type MockRun } from "../support/mock.ts";
import { test, until, visit } from "../support/browser.ts";

/** The page as `view --export` makes it. */
function exported(runs: MockRun[]): string {
  const data = {
    state: { mode: "run", runs: runs.map(({ id, name }) => ({ id, name, path: name })), case: null, version: "mock" },
    runs: Object.fromEntries(runs.map((r) => [r.id, { ...r, files: Object.fromEntries(Object.entries(r.files).map(([path, text]) => [path, deflateSync(text).toString("base64")])), frames: r.frames.map(({ bytes, ...f }) => ({ ...f, data: Buffer.from(bytes).toString("base64") })) }])),
  };
  const text = JSON.stringify(data).replaceAll("<", "\\u003c");
  return page.replace("<!-- tailwater-data -->", () => `<script type="application/json" id="tailwater-data">${text}</script>`);
}

test("two runs side by side and one over the other: same time, same camera, their gauges in one plot", async () => {
  const mock = new Mock({ page, runs: [run("a", "coarse", standingWave(8), 21), run("b", "fine", standingWave(16), 31)] });
  const visitor = await visit(await mock.listen(), true);
  try {
    const view = visitor.page;
    await until(view, "app.shown().length === 2 && app.view.cells.length === 2 && app.shown().every((s) => s.frames.at(1)?.exact)");
    // At the start the water is at rest: the colours are those of the run all the same.
    await until(view, "app.player.time === 0 && app.limits?.[1] > 0.1");
    await view.evaluate("tailwater.player.seek(1)");
    assert.deepEqual(await view.$$eval(".run-name", (all) => all.map((e) => e.textContent)), ["coarse", "fine"]);
    assert.ok(await view.evaluate("tailwater.view.cells.every((cell) => cell.y + cell.height <= document.querySelector('.legend').offsetTop)"), "the legend covers no picture");
    await view.keyboard.press("r");
    await view.waitForSelector(".segmented button");
    await (await view.$$(".segmented button"))[1]!.click();
    await until(view, "app.view.cells.length === 1 && app.view.cells[0].stages.length === 2");
    await view.keyboard.press("g");
    await view.waitForSelector(".gauge .plot canvas");
    assert.equal(await view.$$eval(".run-key li", (all) => all.length), 2);
    assert.deepEqual(visitor.faults, []);
  } finally {
    await visitor.close();
    mock.close();
  }
});

test("an exported page works from disk, in 3D, by the keyboard alone", async () => {
  const folder = mkdtempSync(join(tmpdir(), "tailwater-export-"));
  const file = join(folder, "my_run.html");
  writeFileSync(file, exported([run("a", "basin", basin(3000), 11)]));
  const visitor = await visit(pathToFileURL(file).href);
  try {
    const view = visitor.page;
    await until(view, "app.shown()[0]?.frames.isDecoded(10) && app.view.eye");
    const azimuth = await view.evaluate("tailwater.view.eye.azimuth");
    await view.keyboard.press("d");
    assert.notEqual(await view.evaluate("tailwater.view.eye.azimuth"), azimuth);
    await view.keyboard.press(".");
    await until(view, "Math.abs(app.player.time - app.shown()[0].frames.list[1].time) < 1e-9");
    await view.keyboard.press("y");
    await until(view, "app.look.now.section?.axis === 1");
    await view.keyboard.press("3");
    await until(view, "app.look.now.colouring === 'depth' && app.limits?.[1] > 0.3");
    await view.keyboard.press("t");
    await until(view, "document.documentElement.dataset.theme === 'dark'");
    await view.focus("[aria-label=Keys]");
    await view.keyboard.press("Enter");
    await view.waitForSelector(".dialog[open]");
    for (let i = 0; i < 3; ++i) await view.keyboard.press("Tab");
    assert.ok(await view.evaluate("!document.querySelector('.page > header').contains(document.activeElement)"), "the focus stays in the dialog");
    await view.keyboard.press("Escape");
    await until(view, "!document.querySelector('.dialog') && document.activeElement.ariaLabel === 'Keys'");
    await view.evaluate("document.activeElement.blur()");
    await view.keyboard.press("Space");
    await until(view, "app.player.playing");
    assert.deepEqual(visitor.faults, []);
  } finally {
    await visitor.close();
    rmSync(folder, { recursive: true, force: true });
  }
});
