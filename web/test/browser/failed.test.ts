// The page with the program itself behind it.
import assert from "node:assert/strict";
import { test } from "../support/browser.ts";
import { withProgram } from "../support/program.ts";

test("a failed run: the page opens with the reason, once", async (context) => {
  await withProgram(context, async (place, open) => {
    assert.throws(() => place.call("run", "dam.toml", "--out", "run", "--quiet", "--set", "limits.volume_stop=1e-6"), /ends with 3/);
    const page = await open(await place.view("run"));
    await page.waitForSelector(".one-run .reason");
    const words = await page.$eval(".one-run", (e) => e.textContent ?? "");
    assert.equal(words.split("limits.volume_stop").length, 2);
  });
});
