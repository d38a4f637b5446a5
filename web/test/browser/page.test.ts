import assert from "node:assert/strict";
import { Mock, page, run } from "../support/mock.ts";
import { standingWave } from "../support/flows.ts";
import { allowed, camera, test, until, visit } from "../support/browser.ts";

test("a live run: frames come in, the page follows, the camera stays; scrubbing, picking and stopping", async () => {
  const mock = new Mock({ page, runs: [run("a", "wave", standingWave(10), 41, 20)] });
  const visitor = await visit(await mock.listen());
  try {
    const view = visitor.page;
    await until(view, "app.shownRuns()[0]?.frames.isDecoded(19) && app.player.following");
    await until(view, "app.view.eye");
    const before = await camera(view);
    let took = Infinity; // the quickest of a few: other programs may have the processor for a second
    for (let index = 20; index < 26 && took >= 1000; ++index) {
      const asked = Date.now();
      mock.grow("a");
      await until(view, `app.player.time === app.shownRuns()[0].frames.list[${index}]?.time && app.shownRuns()[0].frames.at(app.player.time)?.exact`);
      took = Math.min(took, Date.now() - asked);
    }
    assert.ok(took < (await allowed(view, 1000)), `a frame is on the screen within 1 s; here ${took} ms`);
    assert.equal(await camera(view), before);

    // Scrubbing: there is a picture at every moment, and the right one soon.
    await view.evaluate(`(async () => {
      globalThis.blanks = globalThis.sharp = 0;
      let before = 0, last = 0; // when the clock was set
      for (let i = 0; i <= 100; ++i) {
        [before, last] = [last, performance.now()];
        tailwater.player.seek(tailwater.player.range[1] * ((i * 37) % 101) / 100);
        if (!tailwater.shownRuns()[0].frames.at(tailwater.player.time)) ++globalThis.blanks;
        await new Promise(requestAnimationFrame);
        // Where the machine is so busy that the clock stood for a while, it may be.
        if (performance.now() - before < 300 && tailwater.view.effort.sharpness > 1) ++globalThis.sharp;
      }
    })()`);
    assert.deepEqual(await view.evaluate("[blanks, sharp]"), [0, 0], "a picture at once, with more pixels than the screen only where it stands");
    await until(view, "app.view.effort.sharpness === 2");
    // A page that stands asks for no picture of the screen.
    assert.equal(await view.evaluate(`new Promise((found) => {
      const ask = globalThis.requestAnimationFrame;
      let asked = 0;
      globalThis.requestAnimationFrame = (then) => (++asked, ask(then));
      setTimeout(() => ((globalThis.requestAnimationFrame = ask), found(asked)), 1000);
    })`), 0);
    assert.equal(await camera(view), before);

    await view.click(".label.probe");
    await until(view, "document.querySelector('.gauge.lit')?.dataset.probe === app.look.now.probe && app.look.now.probe");
    await view.keyboard.press("r");
    await view.waitForSelector(".controls button");
    await view.click(".controls button");
    await view.waitForFunction("document.querySelector('.one-run [role=status]')?.textContent.includes('stops')");
    assert.deepEqual(mock.posts, ["run/a/stop"]);
    assert.deepEqual(visitor.faults, []);
  } finally {
    await visitor.close();
    mock.close();
  }
});
