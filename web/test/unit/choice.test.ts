import assert from "node:assert/strict";
import { test } from "node:test";
import { choose } from "../../src/frames/choice.ts";
import { stride, type Frame } from "../../src/frames/format.ts";

/** `n` particles along each side of a lattice of this spacing, in a box of 1 m. */
function lattice(dim: 2 | 3, n: number, spacing: number): Omit<Frame, "ids" | "more"> {
  const count = n ** dim;
  const data = new Uint16Array(count * stride);
  for (let i = 0; i < count; ++i) {
    for (let d = 0; d < dim; ++d) data[i * stride + d] = Math.round(65535 * spacing * (0.5 + (Math.floor(i / n ** d) % n)));
  }
  return {
    dim, order: 0, index: 0, count, time: 0, boxMin: Array(dim).fill(0), boxMax: Array(dim).fill(1), scalars: [], poses: [], payloadBytes: 0, rawBytes: 0,
    payload: 0, data,
  };
}

test("of water in 3D the outer particles are drawn, and none that is far inside", () => {
  const n = 30;
  const chosen = new Set(choose(lattice(3, n, 0.02), 0.02, 0, true));
  const fromOutside = (i: number) => Math.min(...[0, 1, 2].map((d) => Math.floor(i / n ** d) % n).map((k) => Math.min(k, n - 1 - k)));
  for (let i = 0; i < n ** 3; ++i) {
    if (fromOutside(i) === 0) assert.ok(chosen.has(i), `${i} can be seen`);
    if (fromOutside(i) >= 4) assert.ok(!chosen.has(i), `${i} is ${fromOutside(i)} rows inside`);
  }
});

test("a hole in the water is outside too", () => {
  const n = 30;
  const all = lattice(3, n, 0.02);
  const middle = (i: number) => [0, 1, 2].every((d) => Math.abs((Math.floor(i / n ** d) % n) - 14.5) < 4);
  const kept = Array.from({ length: n ** 3 }, (_, i) => i).filter((i) => !middle(i));
  const data = new Uint16Array(kept.length * stride);
  kept.forEach((i, k) => data.set(all.data.subarray(i * stride, (i + 1) * stride), k * stride));
  const chosen = new Set(choose({ ...all, count: kept.length, data }, 0.02, 0, true));
  const beside = kept.findIndex((i) => i % n === 10 && [1, 2].every((d) => Math.floor(i / n ** d) % n === 14));
  assert.ok(chosen.has(beside));
});

test("a particle in each cell that has some, wherever the water is", () => {
  for (const dim of [2, 3] as const) {
    const n = dim === 2 ? 48 : 24;
    const chosen = choose(lattice(dim, n, 0.01), 0.01, 0.04, false);
    const cell = (i: number) => [0, 1, 2].slice(0, dim).map((d) => Math.floor((Math.floor(i / n ** d) % n) / 4)).join();
    assert.equal(chosen.length, (n / 4) ** dim);
    assert.equal(new Set(Array.from(chosen, cell)).size, chosen.length);
    assert.deepEqual(chosen, chosen.slice().sort());
  }
});

test("no water, and all of it", () => {
  const none = { ...lattice(2, 4, 0.01), count: 0, data: new Uint16Array(0) };
  assert.equal(choose(none, 0.01, 0.1, false).length, 0);
  assert.deepEqual(choose(lattice(2, 4, 0.01), 0.01, 0, false), Uint32Array.from({ length: 16 }, (_, i) => i));
});
