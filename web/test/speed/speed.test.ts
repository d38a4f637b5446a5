// How fast the page is, in headless Chromium without a graphics card: npm run speed.
import { readFileSync } from "node:fs";
import { readdirSync } from "node:fs";
import { cpus } from "node:os";
import { test } from "node:test";
import { readHeader } from "../../src/frames/format.ts";
import { visit, until } from "../support/browser.ts";
import { bulk } from "../support/bulk.ts";
import { Mock, page, run, type MockRun } from "../support/mock.ts";
import { basin, standingWave } from "../support/flows.ts";

function large(n: number, dim: 2 | 3, frames: number): MockRun {
  const flow = dim === 2 ? standingWave(4, frames / 50) : basin(100, frames / 50);
  const scene = { ...flow.scene, spacing: dim === 2 ? Math.sqrt(2 / n) : Math.cbrt(2 / n), box: { min: [0, 0, 0].slice(0, dim), max: [2, 1, 1].slice(0, dim) } };
  const base = run("a", "large", { ...flow, scene }, frames, 0);
  base.frames = [...bulk(n, dim, frames)].map((bytes, index) => ({ index, time: index / 50, key: readHeader(bytes).order === 0, bytes }));
  return Object.assign(base, { info: { ...base.info, state: "done" } });
}

/** CPU time of a process and all that it started, ms: what the page takes however loaded the machine is. */
function cpuTime(root: number): number {
  const all = readdirSync("/proc").filter((name) => /^\d+$/.test(name)).flatMap((pid) => {
    try {
      const stat = readFileSync(`/proc/${pid}/stat`, "utf8");
      const f = stat.slice(stat.lastIndexOf(")") + 2).split(" ");
      return [{ pid: Number(pid), parent: Number(f[1]), ms: (Number(f[11]) + Number(f[12])) * 10 }];
    } catch {
      return []; // it has ended meanwhile
    }
  });
  const of = (pid: number): number => (all.find((p) => p.pid === pid)?.ms ?? 0) + all.filter((p) => p.parent === pid).reduce((sum, p) => sum + of(p.pid), 0);
  return of(root);
}

test("speed of the page", { timeout: 900_000 }, async () => {
  const rows = ["| particles | | | first picture, s | decoding a frame, ms | frames a second | CPU time of a frame, ms | sharpness | particles drawn |", "| --- | --- | --- | --- | --- | --- | --- | --- | --- |"];
  for (const all of [false, true]) for (const [n, dim] of [[10_000, 2], [100_000, 2], [1_000_000, 2], [10_000, 3], [100_000, 3], [1_000_000, 3]] as const) {
    const frames = n > 500_000 ? 12 : 24;
    const mock = new Mock({ page, runs: [large(n, dim, frames)] });
    const visitor = await visit("about:blank");
    const view = visitor.page;
    await view.evaluateOnNewDocument(`
      addEventListener("DOMContentLoaded", () => {
        const wait = setInterval(() => {
          const app = globalThis.tailwater;
          if (!app) return;
          clearInterval(wait);
          app.drawn = (exact) => { if (exact && app.shown()[0]?.frames.isDecoded(0)) { globalThis.first ??= performance.now(); app.drawn = null; } };
        }, 5);
      });`);
    await view.goto(await mock.listen());
    await until(view, "globalThis.first && app.shown()[0].frames.list.every((_, i) => app.shown()[0].frames.isDecoded(i))");
    const first = (await view.evaluate("first")) as number;
    const decoding = (await view.evaluate("tailwater.shown()[0].frames.milliseconds.sort((a, b) => a - b)[tailwater.shown()[0].frames.milliseconds.length >> 1]")) as number;
    await view.evaluate(`(async () => {
      const app = tailwater;
      app.recording = ${all};
      app.player.setLoop(true);
      app.player.setSpeed(0.25);
      app.player.play();
      await new Promise((resolve) => setTimeout(resolve, 1500)); // until it has found its pace
    })()`);
    const before = cpuTime(visitor.browser.process()!.pid!);
    const result = (await view.evaluate(`(async () => {
      const app = tailwater;
      let drawn = 0;
      const began = performance.now();
      app.drawn = () => ++drawn;
      await new Promise((resolve) => setTimeout(resolve, 4000));
      const result = { drawn, rate: drawn / ((performance.now() - began) / 1000), sharpness: app.view.effort.sharpness, particles: app.view.stages[0].particles.points.geometry.drawRange.count };
      app.player.pause();
      return result;
    })()`)) as { drawn: number; rate: number; sharpness: number; particles: number };
    console.log(rows[rows.push(`| ${n.toLocaleString("en").replaceAll(",", " ")} | ${dim}D | ${all ? "all" : "as it plays"} | ${(first / 1000).toFixed(2)} | ${decoding.toFixed(0)} | ${result.rate.toFixed(1)} | ${((cpuTime(visitor.browser.process()!.pid!) - before) / result.drawn).toFixed(0)} | ${result.sharpness} | ${result.particles} |`) - 1]);
    await visitor.close();
    mock.close();
    if (visitor.faults.length > 0) throw new Error(visitor.faults.join("\n"));
  }
  console.log(`${cpus()[0]?.model}, ${cpus().length} cores, 1280 x 720\n${rows.join("\n")}`);
});
