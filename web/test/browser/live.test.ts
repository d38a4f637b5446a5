// The page with the program itself behind it.
import assert from "node:assert/strict";
import { renameSync, statSync } from "node:fs";
import { allowed, camera, test, until } from "../support/browser.ts";
import { measured, press, withProgram } from "../support/program.ts";

test("a live run on two ranks: its frames are on the screen within a second; stopped, gone on with, gone", async (context) => {
  await withProgram(context, async (place, open) => {
    const run = place.start("run", "dam.toml", "--out", "run", "-n", "2", "--quiet", "--set", "time.end=1000", "--set", "particles.spacing=0.02", "--set", "output.view_interval=0.1");
    await place.written(run, "run/view/00001.frame");
    const page = await open(await place.view("run"));
    await until(page, "app.player.following && app.view?.eye && app.shownRuns()[0].frames.list.length > 2");
    const before = await camera(page);
    // When a frame was written, and when it was drawn: both by the clock of this machine.
    const shown = (await page.evaluate(`new Promise((found) => {
      const from = tailwater.shownRuns()[0].frames.list.length;
      tailwater.drawn = (exact) => {
        const run = tailwater.shownRuns()[0];
        const last = run.frames.list.at(-1);
        if (exact && run.frames.list.length > from && tailwater.player.time === last.time) {
          tailwater.drawn = null;
          found({ index: last.index, at: Date.now() });
        }
      };
    })`)) as { index: number; at: number };
    const took = shown.at - statSync(place.path("run/view", `${String(shown.index).padStart(5, "0")}.frame`)).mtimeMs;
    assert.ok(took < (await allowed(page, 1000)), `a frame is on the screen within 1 s; here ${took} ms`);
    assert.equal(await camera(page), before);
    // How far it is from what was measured is told while it goes on; a fast machine may be past the last point, at 100 s.
    await page.waitForFunction("/against lab.csv, [34] samples of 0 to (0.2|100) s: rms [\\d.e-]+ m, bias/.test(document.querySelector('.gauge .score')?.textContent)");
    assert.deepEqual(((await measured(page)) as [number[][]])[0], [[0, 0.4], [0.1, 0.395], [0.2, 0.38], [100, 0.133]]);
    await until(page, "app.shownRuns()[0].table('gauge')?.rows > 3");

    await page.keyboard.press("r");
    await press(page, "Stop");
    await until(page, "app.shownRuns()[0].info.state === 'stopped'");
    const reached = (await page.evaluate("tailwater.shownRuns()[0].end")) as number;
    await press(page, "Go on");
    await until(page, `app.shownRuns()[0].info.state === 'running' && app.shownRuns()[0].end > ${reached}`);
    await press(page, "Stop");
    await until(page, "app.shownRuns()[0].info.state === 'stopped'");
    renameSync(place.path("run"), place.path("elsewhere"));
    // All frames are asked for again: there are none, which is no error.
    await page.evaluate("(({ frames }) => { const list = [...frames.list]; frames.cut(-1); frames.add(list); })(tailwater.shownRuns()[0])");
    await until(page, "app.shownRuns()[0].frames.halted || app.shownRuns()[0].frames.error");
    assert.deepEqual(await page.evaluate("(({ frames }) => [frames.at(0), frames.error])(tailwater.shownRuns()[0])"), [null, ""]);
  });
});
