import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { series } from "../../src/colours.ts";

const css = readFileSync(join(process.env["TAILWATER_WEB"]!, "src/style.css"), "utf8");

/** The variables of a theme. */
function theme(selector: string): Record<string, string> {
  const start = css.indexOf(`${selector} {`);
  const body = css.slice(start, css.indexOf("}", start));
  return Object.fromEntries([...body.matchAll(/--([\w-]+):\s*(#[0-9a-f]{6})/g)].map((m) => [m[1]!, m[2]!]));
}

/** Relative luminance and contrast as WCAG 2.1 has them. */
function luminance(hex: string): number {
  const [r, g, b] = [1, 3, 5].map((i) => {
    const v = parseInt(hex.slice(i, i + 2), 16) / 255;
    return v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4;
  }) as [number, number, number];
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

function contrast(a: string, b: string): number {
  const [low, high] = [luminance(a), luminance(b)].sort((x, y) => x - y) as [number, number];
  return (high + 0.05) / (low + 0.05);
}

for (const [name, selector] of [["light", ":root"], ["dark", ':root[data-theme="dark"]']] as const) {
  test(`text of the ${name} page has the contrast that WCAG AA asks for, 4.5, and lines 3`, () => {
    const c = theme(selector);
    const texts = ["text", "faint", "accent", "good", "bad", "probe", "open", "gate", "body", "code-comment", "code-table", "code-string", "code-number"];
    for (const text of texts) {
      for (const ground of ["panel", "paper"]) assert.ok(contrast(c[text]!, c[ground]!) >= 4.5, `${text} on ${ground}: ${contrast(c[text]!, c[ground]!)}`);
    }
    assert.ok(contrast(c["warn"]!, c["warn-back"]!) >= 4.5);
    assert.ok(contrast(c["on-accent"]!, c["accent"]!) >= 4.5);
    for (const line of ["wall", "profile", "water"]) assert.ok(contrast(c[line]!, c["paper"]!) >= 3, line);
    for (const colour of series[name]) assert.ok(contrast(colour, c["panel"]!) >= 3, colour);
  });
}
