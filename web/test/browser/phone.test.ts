import assert from "node:assert/strict";
import { standingWave } from "../support/flows.ts";
import { Mock, page, run } from "../support/mock.ts";
import { test, until, visit } from "../support/browser.ts";

test("as wide as a phone: the title is whole, buttons are as large as a finger wants them, and the time has a row", async () => {
  const mock = new Mock({ page, runs: [run("a", "a run", standingWave(8), 21)] });
  const visitor = await visit(await mock.listen());
  try {
    const view = visitor.page;
    await view.setViewport({ width: 360, height: 780, hasTouch: true, isMobile: true });
    await until(view, "app.shown()[0]?.frames.at(0)?.exact");
    const [cut, least, track, wide] = (await view.evaluate(`(() => {
      const title = document.querySelector("h1");
      const width = (e) => e.getBoundingClientRect().width;
      return [title.scrollWidth - title.clientWidth, Math.min(...[...document.querySelectorAll("button.icon")].map(width)), width(document.querySelector(".track")), document.documentElement.scrollWidth];
    })()`)) as number[];
    assert.equal(cut, 0);
    assert.ok(least! >= 34, `${least} pixels`);
    assert.ok(track! > 220, `${track} of 360 pixels`);
    assert.equal(wide, 360);
    assert.deepEqual(visitor.faults, []);
  } finally {
    await visitor.close();
    mock.close();
  }
});
