import assert from "node:assert/strict";
import { test } from "node:test";
import { hover, offers } from "../../src/case/help.ts";
import { distance, linesOf, nameAt } from "../../src/case/pointing.ts";
import { placeAt } from "../../src/case/toml.ts";
import type { Drawing, Spec } from "../../src/contract.ts";
import { toCsv } from "../../src/tables.ts";

const text = ['[case]', 'title = "a # b" # the name', "", "[[wall]]", 'name = "tank"', "points = [[0, 1],", "  [0, 0]]", "sl", 'slip = "', "[[pro", "[[probe]] # a gauge"];
const spec: Spec = {
  tables: [
    { name: "case", is_list: false, documentation: "The case as a whole", keys: [{ name: "title", type: "text", default: "untitled", documentation: "Title of the case" }] },
    {
      name: "wall", is_list: true, documentation: "A wall",
      keys: [
        { name: "name", type: "text", documentation: "Its name" },
        { name: "slip", type: "choice", choices: ["free-slip", '"no-slip"'], documentation: "What water does at the wall" },
        { name: "both_sides", type: "true or false", documentation: "Water on both sides" },
        { name: "roughness", type: "number", unit: "m", minimum: 0, default: 0, goes_with: { key: "shape", choices: ["box"] }, documentation: "Height of the grains" },
      ],
    },
  ],
};

test("the place in a case file: table, key or value, and what the table has already", () => {
  assert.deepEqual(placeAt(text, 1, 3), { table: "case", part: "key", key: "title", present: [] });
  assert.equal(placeAt(text, 1, 12).part, "value"); // the # stands in a string
  assert.equal(placeAt(text, 1, 22).part, "comment");
  assert.deepEqual(placeAt(text, 7, 2), { table: "wall", part: "key", key: "", present: ["name", "points", "slip"] });
  assert.deepEqual([placeAt(text, 8, 8).part, placeAt(text, 8, 8).key], ["value", "slip"]);
  assert.equal(placeAt(text, 9, 5).part, "table");
  assert.equal(placeAt(text, 6, 4).table, "wall"); // a list over two lines is no table
});

test("what is offered and told is what the program's description says", () => {
  assert.deepEqual(offers(spec, { table: "wall", part: "key", key: "", present: ["name"] }).map((o) => o.label), ["slip", "both_sides", "roughness"]);
  assert.deepEqual(offers(spec, { table: "wall", part: "value", key: "slip", present: [] }).map((o) => o.insert), ['"free-slip"', '"no-slip"']);
  assert.deepEqual(offers(spec, { table: "wall", part: "value", key: "both_sides", present: [] }).map((o) => o.insert), ["true", "false"]);
  assert.deepEqual(offers(spec, { table: "", part: "table", key: "", present: [] }).map((o) => o.insert), ["[case]", "[[wall]]"]);
  assert.deepEqual(offers(spec, { table: "wall", part: "comment", key: "", present: [] }), []);
  assert.deepEqual(offers(spec, { table: "none", part: "key", key: "", present: [] }), []);
  assert.equal(hover(spec, { table: "wall", part: "value", key: "roughness", present: [] })?.text, "Height of the grains\nnumber, m; at least 0; default 0; goes with shape = box");
  assert.equal(hover(spec, { table: "wall", part: "table", key: "", present: [] })?.title, "[[wall]]");
  assert.equal(hover(spec, { table: "wall", part: "key", key: "unknown", present: [] }), null);
});

test("from the drawing to the lines and back", () => {
  const drawing = { walls: [{ name: "bed", lines: [3, 6] }], bodies: [], inlets: [{ name: "in", lines: [8, 9] }], outlets: [], pockets: [], vents: [{ name: "vent1", lines: [10, 12] }], probes: [{ name: "H1" }] } as unknown as Drawing;
  assert.deepEqual(linesOf(drawing, "bed"), [3, 6]);
  assert.deepEqual(linesOf(drawing, "vent1"), [10, 12]);
  assert.equal(linesOf(drawing, "H1"), null);
  assert.deepEqual([nameAt(drawing, 6), nameAt(drawing, 7), nameAt(drawing, 8)], ["bed", null, "in"]);
  assert.equal(distance([1, 1], [0, 0], [2, 0]), 1);
  assert.equal(distance([3, 0], [0, 0], [2, 0]), 1);
  assert.equal(distance([3, 4], [0, 0], [0, 0]), 5);
  assert.equal(toCsv(["a"], []), "a\n");
});
