import assert from "node:assert/strict";
import { standingWave } from "../support/flows.ts";
import { Mock, page, run } from "../support/mock.ts";
import { test, until, visit } from "../support/browser.ts";

test("a still and a film of the view are saved", async () => {
  const mock = new Mock({ page, runs: [run("a", "wave", standingWave(8), 9)] });
  const visitor = await visit(await mock.listen());
  try {
    const view = visitor.page;
    await until(view, "app.view.eye && app.shown()[0]?.frames.isDecoded(8)");
    // Instead of a file on the disk: what would be saved.
    await view.evaluate(`(() => {
      globalThis.saved = [];
      let last;
      const make = URL.createObjectURL;
      URL.createObjectURL = (blob) => make.call(URL, (last = blob));
      HTMLAnchorElement.prototype.click = function () {
        globalThis.saved.push({ name: this.download, type: last.type, size: last.size, address: make.call(URL, last) });
      };
    })()`);
    await view.evaluate("document.activeElement?.blur()");
    await view.keyboard.press("p");
    await view.waitForFunction("globalThis.saved.length === 1");
    await view.evaluate("tailwater.player.setSpeed(10)");
    await view.keyboard.press("m");
    await view.waitForSelector(".film button.primary");
    await view.click(".film button.primary");
    await view.waitForFunction("globalThis.saved.length === 2");
    const saved = (await view.evaluate("saved")) as { name: string; type: string; size: number; address: string }[];
    assert.match(saved[0]!.name, /^wave_0\.000s\.png$/);
    assert.equal(saved[0]!.type, "image/png");
    assert.equal(saved[1]!.name, "wave.webm");
    assert.ok(saved.every(({ size }) => size > 2000));
    // The film lasts as long as its pictures, however long they took to draw.
    const [span, seconds] = (await view.evaluate(`(async () => {
      const video = document.createElement("video");
      video.src = saved[1].address;
      await new Promise((resolve) => (video.onloadedmetadata = video.onerror = resolve));
      const [start, end] = tailwater.player.range;
      return [end - start, video.duration];
    })()`)) as [number, number];
    assert.ok(Math.abs(seconds - span / 10) < 0.1, `${seconds} s of film for ${span} s at ten times the speed`);
    await view.waitForFunction("document.querySelector('.film [role=status]')?.textContent.startsWith('Saved')");
    assert.deepEqual(visitor.faults, []);
  } finally {
    await visitor.close();
    mock.close();
  }
});
