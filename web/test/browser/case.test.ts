import assert from "node:assert/strict";
import type { Check, Spec } from "../../src/contract.ts";
import { Mock, page, run } from "../support/mock.ts";
import { standingWave } from "../support/flows.ts";
import { allowed, test, until, visit } from "../support/browser.ts";

const text = `[case]
title = "Tank"

[[wall]]
name = "tank"
points = [[0, 1], [0, 0], [2, 0], [2, 1]]

[[vent]]
at = [1, 0.9]
area = 0.1

[[probe]]
name = "H1"
type = "depth"
at = [0.5, 0]
`;
const spec: Spec = {
  tables: [
    { name: "wall", is_list: true, documentation: "A wall", keys: [{ name: "slip", type: "choice", choices: ["free-slip", "no-slip"], documentation: "What water does at the wall" }] },
    { name: "probe", is_list: true, documentation: "A measurement", keys: [{ name: "interval", type: "number", unit: "s", default: 0, documentation: "Time between two readings" }] },
  ],
};

/** As the program would: an unknown key is an error of its line; the drawing has the lines of what it draws. */
function check(given: string): Check {
  const { scene } = standingWave(10);
  const lines = given.split("\n");
  const wrong = lines.findIndex((line) => line.startsWith("pionts"));
  const line = (word: string) => lines.findIndex((l) => l.includes(word)) + 1;
  const positions = Buffer.from(new Float32Array([0.5, 0.1, 1, 0.2, 1.5, 0.1]).buffer).toString("base64");
  return {
    findings: wrong < 0 ? [] : [{ severity: "error", line: wrong + 1, column: 1, end_column: 7, key: "wall.pionts", message: 'unknown key "pionts"; did you mean "points"?' }],
    drawing: {
      ...scene,
      walls: [{ ...scene.walls[0]!, lines: [line("[[wall]]"), line("[[wall]]") + 2] }],
      vents: [{ name: "vent1", at: [1, 0.9], width: 0.1, lines: [line("[[vent]]"), line("[[vent]]") + 2] }],
      probes: [{ ...scene.probes[0]!, lines: [line("[[probe]]"), line("[[probe]]") + 3] }],
      particles: { count: 3, shown: 3, positions },
    },
    summary: ["3 particles."],
  };
}

test("a case: drawn and checked at each key, an error shown, a wall pressed, help at hand, and run", async () => {
  const mock = new Mock({ page, runs: [run("a", "wave", standingWave(10), 5)], mode: "case", caseText: text, check, spec });
  const visitor = await visit(await mock.listen());
  try {
    const view = visitor.page;
    await until(view, "app.shown()[0]?.scene.probes[0].name === 'H1' && document.querySelector('.label.probe')");

    // A wall in the drawing marks its lines.
    const point = (await view.evaluate(`(() => {
      const p = tailwater.view.eye.project([1, 0]);
      const c = tailwater.view.canvas.getBoundingClientRect();
      return [c.left + (p.x + 1) * c.width / 2, c.top + (1 - p.y) * c.height / 2];
    })()`)) as [number, number];
    await view.mouse.click(...point);
    await view.waitForFunction("document.querySelectorAll('.cm-marked').length === 3");
    assert.equal(await view.evaluate("document.querySelector('.cm-marked').textContent"), "[[wall]]");

    // A vent is named, and its name marks its lines.
    await view.evaluate("[...document.querySelectorAll('.label.open')].find((label) => label.textContent === 'vent1').click()");
    await view.waitForFunction("document.querySelector('.cm-marked')?.textContent === '[[vent]]'");

    // A mistake is told within 0.3 s of the last key, of which the page waits 0.12.
    await view.evaluate("document.querySelector('.cm-content').focus()");
    await view.keyboard.down("Control");
    await view.keyboard.press("End");
    await view.keyboard.up("Control");
    await view.evaluate(`(() => {
      addEventListener("keydown", () => (globalThis.typed = performance.now()), true);
      new MutationObserver(() => {
        if (document.querySelector(".found .error")) globalThis.told ??= performance.now();
      }).observe(document.body, { subtree: true, childList: true });
    })()`);
    const mistake = "pionts = 1";
    await view.keyboard.type("\n");
    let took = Infinity;
    for (let attempt = 1; ; ++attempt) {
      await view.keyboard.type(mistake);
      await view.waitForSelector(".found .error");
      took = (await view.evaluate("told - typed")) as number;
      if (took < (await allowed(view, 300)) || attempt === 3) break;  // another program may have held the page up once
      for (let i = 0; i < mistake.length; ++i) await view.keyboard.press("Backspace");
      await view.waitForFunction("!document.querySelector('.found .error')");
      await view.evaluate("globalThis.told = undefined");
    }
    assert.ok(took < (await allowed(view, 300)), `an error is told within 0.3 s; here ${took} ms`);
    assert.match((await view.$eval(".found .error", (e) => e.textContent)) ?? "", /line 17: unknown key "pionts"/);
    assert.ok(await view.$(".cm-lintRange-error"));
    assert.equal(await view.$eval("button.primary", (b) => (b as HTMLButtonElement).disabled), true);

    // Completion knows the table that the cursor is in.
    for (let i = 0; i < mistake.length; ++i) await view.keyboard.press("Backspace");
    await view.keyboard.type("int");
    await view.waitForSelector(".cm-tooltip-autocomplete");
    assert.match((await view.$eval(".cm-tooltip-autocomplete", (e) => e.textContent)) ?? "", /interval/);
    await view.keyboard.press("Escape");

    // Run: the page becomes the run.
    await view.waitForFunction("!document.querySelector('.found .error')");
    await view.waitForFunction("!document.querySelector('button.primary').disabled");
    await view.click("button.primary");
    await until(view, "app.look.now.tab === 'run' && app.shown()[0]?.id === 'a' && app.shown()[0].frames.at(0)?.exact");
    assert.ok(mock.posts.includes("start"));
    assert.deepEqual(visitor.faults, []);
  } finally {
    await visitor.close();
    mock.close();
  }
});
