import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { createHash } from "node:crypto";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { gzipSync } from "node:zlib";

const web = process.env["TAILWATER_WEB"]!;
const committed = readFileSync(join(web, "dist/view.html"));
const licences = readFileSync(join(web, "dist/licences.txt"));

test("the page and the licences that are committed are what its sources make, byte for byte", () => {
  const folder = mkdtempSync(join(tmpdir(), "tailwater-page-"));
  const built = spawnSync(process.execPath, [join(web, "build.mjs"), join(folder, "view.html")], { encoding: "utf8" });
  assert.equal(built.status, 0, built.stderr);
  const [now, notices] = ["view.html", "licences.txt"].map((name) => readFileSync(join(folder, name)));
  rmSync(folder, { recursive: true });
  assert.ok(now!.equals(committed), "web/dist/view.html is not what web/src makes; remedy: cd web && npm run build");
  assert.ok(notices!.equals(licences), "web/dist/licences.txt is not that of the libraries in the page; remedy: cd web && npm run build");
});

test("the page, which is sent to others, brings the licences of its libraries with it", () => {
  assert.ok(committed.includes(licences.toString("utf8").trim()));
  for (const library of ["three", "uplot", "preact", "@codemirror/view"]) assert.match(licences.toString("utf8"), new RegExp(`^  ${library} [0-9.]+: Copyright`, "m"));
});

test("the page is one file of at most 300 kB, compressed, and names no address of the net", () => {
  assert.ok(gzipSync(committed, { level: 9 }).length <= 300e3);
  const text = committed.toString("utf8");
  assert.equal(text.match(/<!-- tailwater-data -->/g)?.length, 1);
  assert.doesNotMatch(text, /<(script|link|img|iframe)[^>]*(src|href)=["']?(https?:)?\/\//i);
  assert.doesNotMatch(text, /@import|\beval\(|new Function\(/);
});

test("the page's policy lets its own script run and nothing else", () => {
  const text = committed.toString("utf8");
  const policy = /Content-Security-Policy" content="([^"]*)"/.exec(text)![1]!;
  const script = /<script type="module">([\s\S]*)<\/script>/.exec(text)![1]!;
  assert.ok(policy.includes(`'sha256-${createHash("sha256").update(script).digest("base64")}'`));
  assert.match(policy, /default-src 'none'/);
  assert.match(policy, /connect-src 'self'/);
  assert.doesNotMatch(policy.replace("style-src 'unsafe-inline'", ""), /unsafe/);
});
