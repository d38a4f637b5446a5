// Frames of very many particles, all there from the beginning: columns of integers, no objects.
import { deflateSync } from "node:zlib";
import { formatVersion, magic } from "../../src/frames/format.ts";

/** Frames of `n` particles that sway in a box; each coordinate moves smoothly, as in water. */
export function* bulk(n: number, dim: 2 | 3, frames: number, keyEvery = 10): Generator<Uint8Array> {
  const side = Math.ceil(dim === 2 ? Math.sqrt(n) : Math.cbrt(n));
  const last = Array.from({ length: dim }, () => new Uint16Array(n));
  const before = Array.from({ length: dim }, () => new Uint16Array(n));
  const scalar = [new Uint8Array(n), new Uint8Array(n)];
  for (let index = 0; index < frames; ++index) {
    const order = Math.min(2, index % keyEvery);
    const ids = order === 0 ? new Uint8Array(n).fill(1).fill(0, 0, 1) : new Uint8Array(8);
    const planes = new Uint8Array(n * (2 * dim + 2));
    for (let d = 0; d < dim; ++d) {
      for (let i = 0; i < n; ++i) {
        const cell = d === 0 ? i % side : d === 1 ? Math.floor(i / side) % side : Math.floor(i / side / side);
        const noise = (Math.imul(i + 7 * index, 2654435761) >>> 30) - 1;
        const q = Math.round((0.1 + (0.8 * cell) / side + 0.05 * Math.sin(index / 15 + (3 * cell) / side + d)) * 65535) + noise;
        const one = last[d]![i]!;
        const residual = order === 0 ? q : ((q - (order === 1 ? one : 2 * one - before[d]![i]!)) << 16) >> 16;
        const coded = order === 0 ? q : ((residual << 1) ^ (residual >> 15)) & 0xffff;
        planes[2 * d * n + i] = coded & 255;
        planes[2 * d * n + n + i] = coded >> 8;
        before[d]![i] = one;
        last[d]![i] = q;
      }
    }
    scalar.forEach((was, s) => {
      for (let i = 0; i < n; ++i) {
        const value = (128 + 100 * Math.sin(index / 20 + ((i % side) * 4) / side + s)) & 255;
        planes[(2 * dim + s) * n + i] = value - (order === 0 ? 0 : was[i]!);
        was[i] = value;
      }
    });
    const raw = Buffer.concat([ids, planes]);
    const payload = deflateSync(raw, { level: 6 });
    const head = Buffer.alloc(4 + 4 + 4 + 4 + 8 + 8 + 16 * dim + 16 + 8);
    head.write(magic, 0, "latin1");
    head.writeUInt16LE(formatVersion, 4);
    head[6] = dim;
    head[7] = order;
    head.writeUInt32LE(index, 8);
    head.writeUInt32LE(n, 12);
    head.writeDoubleLE(index / 50, 16);
    head.writeUInt32LE(0, 24);
    head.writeUInt32LE(2, 28);
    for (let d = 0; d < dim; ++d) {
      head.writeDoubleLE(0, 32 + 8 * d);
      head.writeDoubleLE(d === 0 ? 2 : 1, 32 + 8 * (dim + d));
    }
    [0, 5000, 0, 3].forEach((x, i) => head.writeFloatLE(x, 32 + 16 * dim + 4 * i));
    head.writeUInt32LE(payload.length, head.length - 8);
    head.writeUInt32LE(raw.length, head.length - 4);
    yield new Uint8Array(Buffer.concat([head, payload]));
  }
}
