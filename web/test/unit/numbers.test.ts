import assert from "node:assert/strict";
import { test } from "node:test";
import { colourMaps, table } from "../../src/colours.ts";
import { axisLabel, choices, favourite, measuredFor } from "../../src/gauges/curves.ts";
import { linear } from "../../src/gauges/plot.tsx";
import { wetLines } from "../../src/gauges/profiles.ts";
import type { Probe } from "../../src/contract.ts";
import type { Subject } from "../../src/run/subject.ts";
import { block, Table, toCsv, valueAt } from "../../src/tables.ts";
import { decimals, duration, length, niceBelow, number, timeDecimals, withUncertainty } from "../../src/units.ts";
import { ticks, toSvg } from "../../src/picture/svg.ts";
import { bestColumns } from "../../src/water/columns.ts";
import { Player } from "../../src/time/player.ts";

test("numbers as people read them", () => {
  assert.deepEqual([0, 1234.5678, 0.00123456, -3.5, 12345678, 1e-9, 1 / 3].map((x) => number(x)), ["0", "1235", "0.001235", "−3.5", "1.235·10⁷", "1·10⁻⁹", "0.3333"]);
  assert.deepEqual([0.004, 0.05, 2, 5000].map(length), ["4 mm", "5 cm", "2 m", "5 km"]);
  assert.deepEqual([0.3, 42, 200, 7500, 90000].map(duration), ["under 1 s", "42 s", "3 min 20 s", "2 h 5 min", "1 d 1 h"]);
  assert.deepEqual([0.99, 1, 3.7, 80].map(niceBelow), [0.5, 1, 2, 50]);
  assert.deepEqual([0.5, 2, 60, 5000].map(timeDecimals), [4, 3, 2, 1]);
});

test("a place has the decimals of a pixel, a value those of its uncertainty", () => {
  assert.deepEqual([[-0.0094741, 3], [-0.0004, 3], [12.5, -1], [2, 2]].map(([x, places]) => decimals(x!, places!)), ["−0.009", "0.000", "13", "2.00"]);
  assert.deepEqual([[0.05048, 0.015], [0.39071, 0.0046], [1234.5, 20], [-3, 1], [1, 0]].map(([x, u]) => withUncertainty(x!, u!)),
    ["0.050 ± 0.015", "0.3907 ± 0.0046", "1235 ± 20", "−3.0 ± 1.0", "1 ± 0"]);
});

test("a column is shown with the name and the unit of its scene", () => {
  const probe = { name: "q", type: "discharge", points: [], columns: ["discharge_m3_per_s", "wet_share"], names: ["discharge", "wet_share"], units: ["m^3/s per m", ""] };
  assert.deepEqual(probe.columns.map((column) => axisLabel(probe, column)), ["discharge, m³/s per m", "wet share"]);
  assert.equal(axisLabel({ ...probe, names: undefined, units: undefined }, "discharge_m3_per_s"), "discharge m3 per s");
});

test("readings that are all 0 are not drawn up to 100", () => {
  assert.deepEqual(linear(null, 0, 0), [0, 1]);
  assert.deepEqual(linear(null, null, null), [null, null]);
  const [low, high] = linear(null, 0, 0.2);
  assert.ok(low === 0 && high! >= 0.2 && high! < 0.25);
});

test("a gauge opens with the column that matters", () => {
  const table = new Table();
  table.append("time_s,force_x_N_per_m,force_y_N_per_m,moment_N_m_per_m\n0,-1,300,900\n1,2,290,900\n");
  const run = { table: () => table, scene: { measurements: [] } } as unknown as Subject;
  const probe = (type: string) => ({ name: "it", type, points: [], columns: [], walls: [] }) as unknown as Probe;
  assert.equal(favourite(run, probe("force"), choices(run, probe("force"))), "force_y_N_per_m");
  const profile = new Table();
  profile.append("time_s,height_m,u_m_s,v_m_s,depth_m\n0,0,1,0,0.2\n");
  const flume = { ...run, table: () => profile } as unknown as Subject;
  assert.deepEqual(choices(flume, probe("velocity-profile")), ["u_m_s", "v_m_s", "depth_m"]);
  assert.equal(favourite(flume, probe("velocity-profile"), choices(flume, probe("velocity-profile"))), "u_m_s");
});

test("a table is read by its tails, whole lines only, and written as it came", () => {
  const table = new Table();
  const [first, second] = ["# a comment\ntime_s,connected_m\n0,0.5\n0.1,0.", "6\n0.2,0.7\n"];
  table.append(first);
  assert.equal(table.rows, 1);
  table.append(second);
  assert.deepEqual(table.column("connected_m"), [0.5, 0.6, 0.7]);
  assert.equal(table.bytes, first.length + second.length);
  assert.deepEqual(table.values, [[0, 0.1, 0.2], [0.5, 0.6, 0.7]]);
  assert.equal(toCsv(table.columns, table.values), "time_s,connected_m\n0,0.5\n0.1,0.6\n0.2,0.7\n");
});

test("values between readings, and blocks of rows of one moment", () => {
  assert.equal(valueAt([0, 1, 2], [0, 10, 30], 1.5), 20);
  assert.ok(Number.isNaN(valueAt([0, 1], [0, 1], 1.1)));
  assert.ok(Number.isNaN(valueAt([], [], 0)));
  assert.deepEqual(block([1, 1, 2, 2, 2, 3], 2.5), [2, 5]);
  assert.deepEqual(block([1, 1, 2], 0), [0, 2]);
});

test("the level of a profile is over its bed, and what was measured goes with the profile at or after its time", () => {
  const table = new Table();
  table.append("time_s,x_m,bed_m,connected_m\n0.5,0,0.1,0.4\n0.5,1,0.2,0\n0.5,2,0.1,0.3\n");
  assert.deepEqual(wetLines(table, "connected_m").filter((line) => line.length > 0), [[[0, 0.5]], [[2, 0.4]]]);
  const lab = { probe: "p", column: "connected_m", file: "f", time: [0.5, 0.5, 0.4, 0.6], value: [7, 8, 9, 10], x: [2, 1, 0, 0] };
  assert.deepEqual(measuredFor(lab, 0.4001, 0.5002), [[1, 8], [2, 7]]);
  assert.deepEqual(measuredFor(lab, -Infinity, 0.4001), [[0, 9]]);
});

test("axes have round ticks, and the drawing of a plot is whole SVG", () => {
  assert.deepEqual(ticks(0, 1, 5).map((t) => number(t)), ["0", "0.2", "0.4", "0.6", "0.8", "1"]);
  assert.deepEqual(ticks(2, 2, 5), [2]);
  const svg = toSvg([{ name: "a<b", x: [0, 1, 2], y: [1, NaN, 3], colour: "red" }], "time, s", "level, m", { paper: "#fff", text: "#000", grid: "#eee" }, "H & P");
  assert.match(svg, /a&#60;b/);
  assert.match(svg, /H &#38; P/);
  assert.ok(!svg.includes("NaN"));
});

test("every colour map's lightness rises evenly, so that it is read without colours", () => {
  for (const name of Object.keys(colourMaps) as (keyof typeof colourMaps)[]) {
    const bytes = table(name);
    const lightness = Array.from({ length: 256 }, (_, i) => {
      const [r, g, b] = [0, 1, 2].map((c) => {
        const v = bytes[4 * i + c]! / 255;
        return v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4;
      }) as [number, number, number];
      const y = 0.2126 * r + 0.7152 * g + 0.0722 * b;
      return y > 0.008856 ? 116 * Math.cbrt(y) - 16 : 903.3 * y;
    });
    for (let i = 16; i < 256; i += 16) assert.ok(lightness[i]! > lightness[i - 16]! + 1, `${name} at ${i}`);
    assert.ok(lightness[255]! - lightness[0]! > 60, name);
  }
});

test("pictures side by side are as large as they can be", () => {
  assert.equal(bestColumns(1, 1.5, 1), 1);
  assert.equal(bestColumns(3, 1.5, 1), 2);
  assert.equal(bestColumns(3, 3, 1), 3);
  assert.equal(bestColumns(2, 1.5, 4), 1); // long flumes stand one over the other
});

test("the clock plays, stops at the end, loops, steps and follows", () => {
  const player = new Player();
  player.extend(0, 2);
  player.play();
  player.tick(0.5);
  assert.equal(player.time, 0.5);
  player.shift(1);
  player.tick(0.5);
  assert.equal(player.time, 1.5);
  player.tick(1);
  assert.deepEqual([player.time, player.playing], [2, false]);
  player.setLoop(true);
  player.play();
  player.tick(1.25);
  assert.equal(player.time, 0.5);
  player.step([0, 0.4, 0.8, 1.2], 1);
  assert.deepEqual([player.time, player.playing], [0.8, false]);
  player.step([0, 0.4, 0.8, 1.2], -1);
  assert.equal(player.time, 0.4);
  player.step([0, 0.4, 0.8, 1.2], 10);
  assert.equal(player.time, 1.2);
  player.step([0, 0.4, 0.8, 1.2], -10);
  assert.equal(player.time, 0);
  player.follow();
  player.extend(0, 3);
  assert.equal(player.time, 3);
  player.seek(1);
  player.extend(0, 4);
  assert.equal(player.time, 1);
});
