import assert from "node:assert/strict";
import { test } from "node:test";
import { limit, meanOf } from "../../src/gauges/limit.ts";

test("means of still and of trembling readings, and too few of them", () => {
  const time = Array.from({ length: 103 }, (_, i) => i / 10);
  assert.deepEqual(meanOf(0.1, time, time.map(() => 2), 1, 9), { spacing: 0.1, mean: 2, error: 0 });
  const tremble = meanOf(0.1, time, time.map((_, i) => (i % 2 ? 1 : -1)), 0, 99)!;
  assert.ok(Math.abs(tremble.mean) < 0.02 && tremble.error < 0.1);
  assert.equal(meanOf(0.1, time, time, 0, 0.5), null);
});

test("the limit of values on a straight line is exact; off it, the lines through fewer runs tell the uncertainty", () => {
  const on = [0.1, 0.2, 0.4].map((spacing) => ({ spacing, mean: 3 + 2 * spacing, error: 0 }));
  const exact = limit(on)!;
  assert.ok(Math.abs(exact.value - 3) < 1e-12 && exact.uncertainty < 1e-12);
  assert.equal(limit(on.slice(0, 2)), null);
  // Of 0, 0, 1 at dx = 1, 2, 3 the line ends at -2/3; those through two of them end at 0, -1/2 and -2.
  const off = limit([1, 2, 3].map((spacing, i) => ({ spacing, mean: i === 2 ? 1 : 0, error: 0 })))!;
  assert.ok(Math.abs(off.value + 2 / 3) < 1e-12);
  assert.ok(Math.abs(off.uncertainty - 4 / 3) < 1e-12);
  // Equal errors of three runs: twice the norm of the weights of the line's end, (4, 1, -2) / 3.
  const noisy = limit([1, 2, 3].map((spacing) => ({ spacing, mean: 5, error: 0.3 })))!;
  assert.ok(Math.abs(noisy.uncertainty - (0.6 * Math.sqrt(21)) / 3) < 1e-12);
});
