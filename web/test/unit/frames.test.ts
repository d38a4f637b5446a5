import assert from "node:assert/strict";
import { test } from "node:test";
import { unzlibSync } from "fflate";
import { change, Decoder } from "../../src/frames/decode.ts";
import { FrameError, readHeader, stride, type Frame } from "../../src/frames/format.ts";
import { bracket } from "../../src/frames/bracket.ts";
import { inflate } from "../../src/frames/inflate.ts";
import { levels } from "../../src/frames/levels.ts";
import { follow } from "../../src/frames/pair.ts";
import { Encoder, type Moment } from "../support/encode.ts";

function random(seed: number): () => number {
  let state = seed;
  return () => ((state = (Math.imul(state, 1664525) + 1013904223) >>> 0) / 2 ** 32);
}

/** Particles that fly in arcs; from the fifth moment on some leave and others come. Some have the ids of split ones. */
function moments(n: number, dim: 2 | 3, count: number): Moment[] {
  const next = random(7);
  const start = Array.from({ length: 2 * n }, () => Array.from({ length: 2 * dim }, next));
  return Array.from({ length: count }, (_, k) => {
    const first = k < 4 ? 0 : 3 * (k - 3);
    const own = Array.from({ length: n }, (_, i) => first + i + (k >= 6 && i > n / 2 ? 5 : 0)).reverse();
    const t = k / count;
    const at = (id: number, d: number) => start[id]![d]! + start[id]![dim + d]! * t - (d === 1 ? 0.3 * t * t : 0);
    return {
      time: t, ids: own.map((id) => (id % 7 === 0 ? id + 2 ** 40 : id)), places: Array.from({ length: dim }, (_, d) => own.map((id) => at(id, d))),
      scalars: [own.map((id) => 1000 * start[id]![0]!), own.map((id) => start[id]![1]! * t), own.map((id) => 0.01 * (1 + (id % 3)))],
      poses: [dim === 2 ? [t, 2 * t, 0.1 * t] : [t, 0, 0, 1, 0, 0, 0]],
    };
  });
}

function decoded(decoder: Decoder, bytes: Uint8Array): Frame {
  const header = readHeader(bytes);
  return decoder.decode(header, unzlibSync(bytes.subarray(header.payload, header.payload + header.payloadBytes)));
}

for (const dim of [2, 3] as const) {
  test(`frames in ${dim}D come back within half a step of their integers, with particles that come and go`, () => {
    const encoder = new Encoder(8);
    const decoder = new Decoder();
    const orders = new Set<number>();
    moments(120, dim, 20).forEach((moment, index) => {
      const frame = decoded(decoder, encoder.encode(moment));
      orders.add(frame.order);
      assert.equal(frame.index, index);
      assert.equal(frame.count, 120);
      assert.deepEqual(frame.poses, moment.poses);
      assert.deepEqual([...frame.ids], [...moment.ids].sort((a, b) => a - b));
      frame.ids.forEach((id, i) => {
        const place = Array.from(moment.ids).indexOf(id);
        for (let d = 0; d < dim; ++d) {
          const step = (frame.boxMax[d]! - frame.boxMin[d]!) / 65535;
          const x = frame.boxMin[d]! + frame.data[i * stride + d]! * step;
          assert.ok(Math.abs(x - moment.places[d]![place]!) <= 0.5000001 * step, `frame ${index}, particle ${id}, coordinate ${d}`);
        }
        frame.scalars.forEach((range, s) => {
          const byte = s < 2 ? (frame.data[i * stride + 3]! >> (8 * s)) & 255 : frame.more[s - 2]![i]!;
          const value = range.low + (byte / 255) * (range.high - range.low);
          assert.ok(Math.abs(value - moment.scalars[s]![place]!) <= (0.501 * (range.high - range.low)) / 255);
        });
      });
    });
    assert.deepEqual([...orders].sort(), [0, 1, 2]);
  });
}

test("a damaged frame is refused with a reason, and the decoder goes on from the next key frame", () => {
  const encoder = new Encoder(4);
  const files = moments(50, 2, 12).map((moment) => encoder.encode(moment));
  const order = files.map((file) => readHeader(file).order);
  const late = order.findIndex((o, i) => i > 1 && o > 0);
  assert.throws(() => readHeader(files[0]!.subarray(0, 20)), /ends inside its header/);
  assert.throws(() => readHeader(files[0]!.subarray(0, files[0]!.length - 1)), /is cut off/);
  assert.throws(() => readHeader(new TextEncoder().encode("<html>  ")), FrameError);
  const newer = files[0]!.slice();
  newer[4] = 9;
  assert.throws(() => readHeader(newer), /format 9; this page reads 1/);
  const decoder = new Decoder();
  decoded(decoder, files[0]!);
  assert.throws(() => decoded(decoder, files[late]!), /does not follow/);
  const header = readHeader(files[1]!);
  assert.throws(() => decoder.decode(header, new Uint8Array(header.rawBytes - 1)), /bytes, not/);
  const key = order.findIndex((o, i) => i > late && o === 0);
  assert.equal(decoded(decoder, files[key]!).index, key);
});

test("changes of the list of ids say where each particle was", () => {
  const { ids, from } = change(Float64Array.of(2, 4, 6, 8), Float64Array.of(1, 3), Float64Array.of(1, 5, 9));
  assert.deepEqual([...ids], [1, 2, 5, 6, 9]);
  assert.deepEqual([...from], [-1, 0, -1, 2, -1]);
});

test("a particle that leaves stays where it is until the next frame, also where the box changes", () => {
  const frame = (ids: number[], x: number[], min: number, max: number): Frame =>
    ({
      dim: 2, order: 0, index: 0, count: ids.length, time: 0, boxMin: [min, min], boxMax: [max, max], scalars: [], poses: [], payloadBytes: 0, rawBytes: 0, payload: 0,
      more: [], ids: Float64Array.from(ids), data: Uint16Array.from(x.flatMap((v) => [Math.round((65535 * (v - min)) / (max - min)), 0, 0, 0])),
    });
  const out = follow(frame([1, 2, 3], [0.25, 0.5, 0.75], 0, 1), frame([1, 3, 4], [0.3, 0.8, 0.9], -1, 1));
  const places = [0, 1, 2].map((i) => -1 + (out[i * stride]! / 65535) * 2);
  [0.3, 0.5, 0.8].forEach((x, i) => assert.ok(Math.abs(places[i]! - x) < 1e-4));
});

test("a time lies between two frames, and at the ends in one", () => {
  const list = [0, 1, 3].map((time) => ({ time }));
  assert.deepEqual(bracket(list, -1), { place: 0, share: 0 });
  assert.deepEqual(bracket(list, 2), { place: 1, share: 0.5 });
  assert.deepEqual(bracket(list, 3), { place: 2, share: 0 });
  assert.deepEqual(bracket(list, 9), { place: 2, share: 0 });
});

test("the level of a column is that of its connected water, without the spray above", () => {
  const heights = [0.05, 0.15, 0.25, 0.35, 0.95]; // the last one flies
  const column = heights.flatMap((y) => [0, Math.round(65535 * y), 0, 0]);
  const data = Uint16Array.from([...column, 65535, Math.round(65535 * 0.15), 0, 0]); // a second one at the other end
  const frame = { dim: 2 as const, order: 0 as const, index: 0, count: 6, time: 0, boxMin: [0, 0], boxMax: [1, 1], scalars: [], poses: [], payloadBytes: 0, rawBytes: 0, payload: 0, data };
  const { top, counts } = levels(frame, 1, 1, 0.1);
  assert.deepEqual(counts, [10]);
  assert.ok(Math.abs(top[0]! - 0.4) < 1e-6);
  assert.equal(top[5], -Infinity);
  assert.ok(Math.abs(top[9]! - 0.2) < 1e-6);
});

test("the browser's inflater and a damaged or wrong stream", async () => {
  const encoder = new Encoder();
  const bytes = encoder.encode(moments(50, 2, 1)[0]!);
  const header = readHeader(bytes);
  const payload = bytes.slice(header.payload);
  assert.deepEqual(await inflate(payload, header.rawBytes), unzlibSync(payload));
  await assert.rejects(inflate(payload, header.rawBytes - 1), /more than/);
  payload[8]! ^= 255;
  payload[payload.length - 1]! ^= 255;
  await assert.rejects(inflate(payload, header.rawBytes));
});
