// The program itself: runs, and the server behind `tailwater view`, each in a folder of its own.
import assert from "node:assert/strict";
import { spawn, spawnSync, type ChildProcess } from "node:child_process";
import { existsSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import type { TestContext } from "node:test";
import type { Page } from "puppeteer-core";
import { visit, type Visit } from "./browser.ts";

/** $TAILWATER, or what is built beside these sources. */
const program = process.env["TAILWATER"] ?? resolve(process.env["TAILWATER_WEB"]!, "../build/release/bin/tailwater");

export class Workplace {
  readonly folder = mkdtempSync(join(tmpdir(), "tailwater-program-"));
  private children: ChildProcess[] = [];

  /** Calls the program and waits for it; throws what it says if it fails. */
  call(...words: string[]): string {
    const { status, stdout, stderr } = spawnSync(program, words, { cwd: this.folder, encoding: "utf8" });
    if (status !== 0) throw new Error(`tailwater ${words.join(" ")} ends with ${status}: ${stderr}`);
    return stdout;
  }

  /** Starts the program; it is ended with this workplace. */
  start(...words: string[]): ChildProcess {
    const child = spawn(program, words, { cwd: this.folder, stdio: ["ignore", "pipe", "inherit"] });
    this.children.push(child);
    return child;
  }

  /** Starts the server, and returns the address that it prints. */
  view(...words: string[]): Promise<string> {
    const child = this.start("view", ...words, "--no-browser");
    return new Promise((found, failed) => {
      let text = "";
      child.stdout!.setEncoding("utf8").on("data", (part: string) => {
        text += part;
        if (text.includes("\n")) found(text.trim());
      });
      child.on("exit", (code) => failed(new Error(`tailwater view ends with ${code}`)));
    });
  }

  /** Waits until `child` has written this file; throws if it ends without. */
  async written(child: ChildProcess, file: string): Promise<void> {
    while (!existsSync(this.path(file))) {
      const end = child.exitCode ?? child.signalCode;
      if (end !== null) throw new Error(`tailwater ends with ${end} and has not written ${file}`);
      await new Promise((resolve) => setTimeout(resolve, 10));
    }
  }

  path(...names: string[]): string {
    return join(this.folder, ...names);
  }

  async close(): Promise<void> {
    for (const child of this.children) {
      if (child.exitCode !== null || child.signalCode !== null) continue;
      const ended = new Promise((resolve) => child.once("exit", resolve));
      child.kill("SIGTERM");
      await ended;
    }
    rmSync(this.folder, { recursive: true, force: true, maxRetries: 5 });
  }
}

const dam = `[case]
title = "Dam break"
[particles]
spacing = 0.04
[[fluid]]
name = "column"
min = [0, 0]
max = [0.8, 0.4]
[[wall]]
name = "tank"
points = [[0, 1.5], [0, 0], [2.4, 0], [2.4, 1.5]]
[time]
end = 1.0
[[probe]]
name = "gauge"
type = "depth"
at = [0.4, 0]
interval = 0.01
[[measurement]]
probe = "gauge"
column = "highest"
file = "lab.csv"
`;

/** Of the gauge, as a laboratory might have measured it for 100 s. */
const lab = "t [s], depth [mm]\n0, 400\n0.1, 395\n0.2, 380\n100, 133\n";

/** Calls `body` with a workplace that holds the case as dam.toml with lab.csv, and a browser; there is no fault in its console. */
export async function withProgram(context: TestContext, body: (place: Workplace, open: (address: string) => Promise<Page>) => Promise<void>): Promise<void> {
  if (!existsSync(program)) return context.skip(`there is no ${program}`);
  const place = new Workplace();
  writeFileSync(place.path("dam.toml"), dam);
  writeFileSync(place.path("lab.csv"), lab);
  const visits: Visit[] = [];
  context.after(async () => { // of a test that has hung, too
    for (const one of visits) await one.close();
    await place.close();
  });
  await body(place, async (address) => {
    visits.push(await visit(address));
    return visits.at(-1)!.page;
  });
  for (const { faults } of visits) assert.deepEqual(faults, []);
}

/** The measured points in the plot of the gauge, [s, m], and what is told of them. */
export const measured = (page: Page) =>
  page.evaluate(`(() => {
    const { time, value } = tailwater.shown()[0].scene.measurements[0];
    return [time.map((t, i) => [t, value[i]]), document.querySelector(".gauge .score")?.textContent.trim()];
  })()`);

/** Presses the button with this word, once it is there. */
export async function press(page: Page, word: string): Promise<void> {
  await page.waitForFunction((w) => [...document.querySelectorAll("button")].some((b) => b.textContent === w && !b.disabled), {}, word);
  await page.evaluate((w) => [...document.querySelectorAll("button")].find((b) => b.textContent === w)!.click(), word);
}
