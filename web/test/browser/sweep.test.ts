// The page with the program itself behind it.
import { writeFileSync } from "node:fs";
import { test, until } from "../support/browser.ts";
import { press, withProgram } from "../support/program.ts";

test("a sweep: members beside each other, one stopped, gone on with", async (context) => {
  await withProgram(context, async (place, open) => {
    const sweep = place.start("run", "dam.toml", "--out", "sweep", "--quiet", "--sweep", "particles.spacing=0.06,0.05,0.04", "--set", "time.end=2");
    const ended = new Promise((resolve) => sweep.once("exit", resolve));
    await place.written(sweep, "sweep/particles.spacing=0.06/view/00001.frame");
    writeFileSync(place.path("sweep/STOP"), "");
    await ended;
    const page = await open(await place.view("sweep"));
    await until(page, "app.shownRuns().length === 3 && app.view.cells.length === 3");
    await page.keyboard.press("r");
    await page.waitForFunction("/^[0-2] of 3/.test(document.querySelector('.sweep p')?.textContent)");
    await press(page, "Go on with the sweep");
    await page.waitForFunction("document.querySelector('.sweep p')?.textContent.startsWith('3 of 3')");
    await until(page, "app.shownRuns().every((run) => run.info.state === 'done' && run.end >= 2 && run.frames.list.length > 20)");
    await page.keyboard.press("g");
    await page.waitForFunction("document.querySelector('.score')?.textContent.includes('at dx = 0')");
    await page.keyboard.press("r");
    await press(page, "One over the other");
    await until(page, "app.view.cells.length === 1 && app.view.cells[0].stages.length === 3");
  });
});
