// The page with the program itself behind it.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test, until } from "../support/browser.ts";
import { measured, press, withProgram } from "../support/program.ts";

test("a case: what was measured, an error at its place, the time it takes, and run on two ranks", async (context) => {
  await withProgram(context, async (place, open) => {
    const page = await open(await place.view("dam.toml"));
    await until(page, "app.shown()[0]?.scene.probes[0].name === 'gauge'");
    await page.waitForFunction("/About \\d+ steps/.test(document.querySelector('.found').textContent)");
    await press(page, "Gauges");
    await page.waitForSelector(".gauge .plot canvas");
    assert.deepEqual(await measured(page), [[[0, 0.4], [0.1, 0.395], [0.2, 0.38]], "lab.csv"]);
    await press(page, "Case");
    await page.waitForSelector(".cm-content");
    const put = (from: string, to: string) =>
      page.evaluate(`(() => {
        const text = document.querySelector(".cm-content").cmTile?.root?.view ?? document.querySelector(".cm-content").cmView.view;
        const at = text.state.doc.toString().indexOf(${JSON.stringify(from)});
        text.dispatch({ changes: { from: at, to: at + ${from.length}, insert: ${JSON.stringify(to)} } });
      })()`);
    await put("spacing = 0.04", "spacing = -0.04");
    await page.waitForSelector(".cm-lintRange-error");
    assert.equal(await page.$eval(".cm-lintRange-error", (e) => e.textContent), "-0.04");
    assert.match((await page.$eval(".found .error", (e) => e.textContent)) ?? "", /line 4: particles.spacing = -0.04/);
    await put("spacing = -0.04", "spacing = 0.05");
    await put("end = 1.0", "end = 0.6");
    await page.waitForFunction("!document.querySelector('.found .error') && !document.querySelector('button.primary').disabled");
    await page.focus("[aria-label=Ranks]");
    await page.keyboard.press("ArrowUp");
    await page.click("button.primary");
    await until(page, "app.look.now.tab === 'run' && app.shownRuns()[0]?.frames.list.length > 5");
    await until(page, "app.shownRuns()[0].info.state === 'done'");
    assert.match(readFileSync(place.path("dam.toml"), "utf8"), /spacing = 0.05/);
    assert.equal((JSON.parse(readFileSync(place.path("dam_run/summary.json"), "utf8")) as { ranks: { count: number } }).ranks.count, 2);
  });
});
