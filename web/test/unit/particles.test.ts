// What the graphics card gets of the water, without one.
import assert from "node:assert/strict";
import { test } from "node:test";
import { ParticleMark } from "../../src/water/particles.ts";
import type { Frame } from "../../src/frames/format.ts";

test("a run that begins without water has a first picture", () => {
  for (const dim of [2, 3] as const) {
    const mark = new ParticleMark(dim, 0.1, -1, { axis: dim - 1, sign: 1 });
    const dry: Frame = {
      dim, order: 0, index: 0, count: 0, time: 0, boxMin: Array(dim).fill(0), boxMax: Array(dim).fill(1), scalars: [], poses: [], payloadBytes: 0, rawBytes: 0,
      payload: 0, more: [], ids: new Float64Array(0), data: new Uint16Array(0),
    };
    mark.show(dry, dry, 0, null);
    assert.ok(mark.points.geometry.getAttribute("a"));
    mark.dispose();
  }
});
