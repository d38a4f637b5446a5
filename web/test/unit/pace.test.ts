import assert from "node:assert/strict";
import { test } from "node:test";
import { Pace } from "../../src/water/pace.ts";

const pictures = (pace: Pace, count: number, milliseconds: number) => {
  for (let i = 0; i < count; ++i) pace.moved(milliseconds);
  return pace.effort;
};

test("what is quick enough is drawn whole, what is slow with less effort, and a still as well as can be", () => {
  const pace = new Pace(false);
  assert.deepEqual(pictures(pace, 20, 17), { sharpness: 1, apart: 0 });
  assert.deepEqual(pictures(pace, 4, 100), { sharpness: 0.5, apart: 1 });
  assert.ok(pictures(pace, 4, 100).apart > 1);
  const least = pictures(pace, 100, 1000);
  assert.deepEqual(pictures(pace, 100, 1000), least);
  assert.ok(pace.rest());
  assert.deepEqual(pace.effort, { sharpness: 1, apart: 0 });
  assert.ok(!pace.rest());
});

test("without a graphics card stills have more pixels, and a slow picture fewer", () => {
  const pace = new Pace(true);
  assert.equal(pace.effort.sharpness, 1); // at first it must be quick
  pace.rest();
  assert.equal(pace.effort.sharpness, 2);
  pace.moved();
  assert.equal(pace.effort.sharpness, 1);
  assert.equal(pictures(pace, 1, 30).sharpness, 1);
  assert.equal(pictures(pace, 4, 30).sharpness, 0.5);
  assert.equal(pictures(pace, 4, 30).apart, 1);
});

test("more is tried where it is quick again, and less often where that was too much", () => {
  const pace = new Pace(true);
  pictures(pace, 4, 30);
  const quickPictures = () => {
    let count = 0;
    while (pace.effort.sharpness < 1) pictures(pace, 1, 16.7), ++count;
    return count;
  };
  const first = quickPictures();
  pictures(pace, 4, 30);
  assert.ok(quickPictures() > 1.5 * first);
});
