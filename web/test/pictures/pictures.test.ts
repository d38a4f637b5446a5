// Makes the pictures of the page in the documents, docs/images/view_*.webp, from runs of its own: npm run pictures.
// They take some five minutes of CPU time. Somebody looks at them before they are committed.
import { execFileSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import type { Page } from "puppeteer-core";
import { until } from "../support/browser.ts";
import { withProgram, type Workplace } from "../support/program.ts";

const images = join(process.env["TAILWATER_WEB"]!, "../docs/images");

/** What the page shows now, as of a run that goes on. */
async function saveNow(page: Page, name: string): Promise<void> {
  const path = join(images, `view_${name}.webp`);
  await page.screenshot({ path, type: "webp", quality: 80 });
  execFileSync(join(images, "../../scripts/picture_record.py"), [path]);
}

/** What the page shows, once the picture is whole and rests. */
async function save(page: Page, name: string, height = 720): Promise<void> {
  await page.setViewport({ width: 1280, height });
  await page.evaluate(`new Promise((found) => {
    const app = tailwater;
    let rests = setTimeout(found, 1500);
    app.drawn = () => {
      clearTimeout(rests);
      rests = setTimeout(() => ((app.drawn = null), found()), 1500);
    };
  })`);
  await saveNow(page, name);
}

/** The water of all runs at a time (s). */
async function at(page: Page, time: number): Promise<void> {
  await page.evaluate(`tailwater.player.seek(${time})`);
  await until(page, `app.shownRuns().every((run) => run.frames.at(${time})?.exact)`);
}

/** The template, its weir 0.3 m high. */
function weir(place: Workplace): void {
  place.call("new", "weir", "my_weir.toml");
  const path = place.path("my_weir.toml");
  writeFileSync(path, readFileSync(path, "utf8").replace(/^P = \S+/m, "P = 0.3"));
}

test("the walk of guide/film_of_a_weir.md: case, live, weir, film", async (context) => {
  await withProgram(context, async (place, open) => {
    weir(place);
    const page = await open(await place.view("my_weir.toml"));
    await until(page, "app.shown()[0]?.scene.walls.some((wall) => wall.name === 'weir')");
    await page.waitForFunction("/About \\d+ steps/.test(document.querySelector('.found').textContent)");
    await page.evaluate("tailwater.pick('weir', false)");
    await save(page, "case");
    await page.click("button.primary");
    await until(page, "app.look.now.tab === 'run' && app.shownRuns()[0]?.end > 1.5");
    await saveNow(page, "live");
    await until(page, "app.shownRuns()[0].info.state === 'done'");
    await page.keyboard.press("g");
    await page.evaluate("tailwater.pick('upstream', true)");
    await at(page, 5);
    await save(page, "weir");
    await page.keyboard.press("m");
    await page.waitForSelector(".film button.primary");
    await save(page, "film");
  });
});

test("a pier in 3D: 3d", async (context) => {
  await withProgram(context, async (place, open) => {
    place.call("new", "pier", "pier.toml");
    place.call("run", "pier.toml", "--out", "pier", "--quiet");
    const page = await open(await place.view("pier"));
    await until(page, "app.view?.eye");
    await page.evaluate("tailwater.look.change({ water: 'surface' })");
    await page.keyboard.press("t");
    await at(page, 0.9);
    await save(page, "3d");
  });
});

test("three spacings: sweep", async (context) => {
  await withProgram(context, async (place, open) => {
    weir(place);
    place.call("run", "my_weir.toml", "--out", "sweep", "--quiet", "--sweep", "particles.spacing=P/8,P/10,P/12");
    const page = await open(await place.view("sweep"));
    await until(page, "app.view?.cells.length === 3");
    await page.keyboard.press("t");
    await at(page, 6);
    await save(page, "sweep");
  });
});

test("a report: report", async (context) => {
  await withProgram(context, async (place, open) => {
    place.call("validate", "zhou1999", "martin_moyce1952", "weir", "drop", "couette", "ritter", "--out", "validation");
    const page = await open(await place.view("validation"));
    await page.waitForSelector(".one-panel canvas");
    await page.evaluate("document.querySelector('.peers').scrollIntoView()");
    await save(page, "report", 800);
  });
});
