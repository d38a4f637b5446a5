// The writer's side of the frames, for tests and for the mock server: straightforward, without care for speed.
import { zlibSync } from "fflate";
import { formatVersion, magic, type Range } from "../../src/frames/format.ts";

/** A moment of a run. Columns; ids need not be sorted. */
export interface Moment {
  time: number;
  ids: number[] | Uint32Array;
  /** Per dimension one column of places, m. */
  places: ArrayLike<number>[];
  scalars: ArrayLike<number>[];
  poses?: number[][];
}

function varint(out: number[], value: number): void {
  for (; value >= 128; value = Math.floor(value / 128)) out.push((value % 128) | 128); // ids reach beyond 32 bits
  out.push(value);
}

function u32(out: number[], value: number): void {
  out.push(value & 255, (value >>> 8) & 255, (value >>> 16) & 255, value >>> 24);
}

function differences(out: number[], values: number[]): void {
  let last = 0;
  for (const value of values) {
    varint(out, value - last);
    last = value;
  }
}

export class Encoder {
  private before: Map<number, { q: number[]; s: number[] }>[] = [];
  private ids: number[] = [];
  private box: { min: number[]; max: number[] } | null = null;
  private ranges: Range[] = [];
  private sinceKey = 0;
  private index = 0;

  constructor(private keyEvery = 10, private highestOrder: 1 | 2 = 2) {}

  encode(moment: Moment): Uint8Array {
    const dim = moment.places.length as 2 | 3;
    const sorted = Array.from(moment.ids, (id, place) => ({ id, place })).sort((a, b) => a.id - b.id);
    const ids = sorted.map((p) => p.id);
    const places = moment.places.map((column) => sorted.map((p) => column[p.place]!));
    const scalars = moment.scalars.map((column) => sorted.map((p) => column[p.place]!));
    const key = this.sinceKey % this.keyEvery === 0 || this.leaves(places, scalars);
    if (key) this.frame(places, scalars);
    const order = key ? 0 : Math.min(this.highestOrder, this.before.length);
    if (key) this.before = [];
    this.sinceKey = key ? 1 : this.sinceKey + 1;

    const { min, max } = this.box!;
    const raw: number[] = [];
    if (key) {
      differences(raw, ids);
    } else {
      const now = new Set(ids);
      const was = new Set(this.ids);
      const removed = this.ids.flatMap((id, place) => (now.has(id) ? [] : [place]));
      const added = ids.filter((id) => !was.has(id));
      u32(raw, removed.length);
      differences(raw, removed);
      u32(raw, added.length);
      differences(raw, added);
    }
    const places16 = places.map((column, d) => column.map((x) => quantised(x, min[d]!, max[d]!, 65535)));
    const scalars8 = scalars.map((column, s) => column.map((v) => quantised(v, this.ranges[s]!.low, this.ranges[s]!.high, 255)));
    const [one, two] = this.before;
    for (let d = 0; d < dim; ++d) {
      const residuals = ids.map((id, i) => {
        const q = places16[d]![i]!;
        if (order === 0) return q;
        const q1 = one?.get(id)?.q[d];
        const q2 = two?.get(id)?.q[d];
        const predicted = q1 === undefined ? 0 : q2 === undefined || order === 1 ? q1 : 2 * q1 - q2;
        const r = ((q - predicted) << 16) >> 16;
        return ((r << 1) ^ (r >> 15)) & 0xffff;
      });
      for (const r of residuals) raw.push(r & 255);
      for (const r of residuals) raw.push(r >> 8);
    }
    for (let s = 0; s < scalars.length; ++s) {
      ids.forEach((id, i) => raw.push((scalars8[s]![i]! - (order === 0 ? 0 : (one?.get(id)?.s[s] ?? 0))) & 255));
    }
    const map = new Map(ids.map((id, i) => [id, { q: places16.map((c) => c[i]!), s: scalars8.map((c) => c[i]!) }]));
    this.before = [map, ...this.before].slice(0, 2);
    this.ids = ids;
    return this.file(dim, order, moment, ids.length, new Uint8Array(raw));
  }

  private leaves(places: number[][], scalars: number[][]): boolean {
    const { min, max } = this.box!;
    return (
      places.some((column, d) => column.some((x) => x < min[d]! || x > max[d]!)) ||
      scalars.some((column, s) => column.some((v) => v < this.ranges[s]!.low || v > this.ranges[s]!.high))
    );
  }

  private frame(places: number[][], scalars: number[][]): void {
    const lowest = (column: number[]) => column.reduce((a, b) => Math.min(a, b), Infinity);
    const highest = (column: number[]) => column.reduce((a, b) => Math.max(a, b), -Infinity);
    const ends = places.map((column) => ({ low: lowest(column), high: highest(column) }));
    this.box = {
      min: ends.map((e) => e.low - 0.2 * (e.high - e.low) - 1e-6),
      max: ends.map((e) => e.high + 0.2 * (e.high - e.low) + 1e-6),
    };
    this.ranges = scalars.map((column) => ({ low: Math.fround(Math.min(0, lowest(column)) - 1e-3), high: Math.fround(1.5 * highest(column) + 1e-3) }));
  }

  private file(dim: number, order: number, moment: Moment, count: number, raw: Uint8Array): Uint8Array {
    const payload = zlibSync(raw, { level: 6 });
    const poses = moment.poses ?? [];
    const size = 4 + 2 + 2 + 4 + 4 + 8 + 8 + 16 * dim + 8 * this.ranges.length + poses.flat().length * 8 + 8;
    const bytes = new Uint8Array(size + payload.length);
    const view = new DataView(bytes.buffer);
    let at = 0;
    const put = (length: number, write: () => void) => {
      write();
      at += length;
    };
    for (const letter of magic) put(1, () => view.setUint8(at, letter.charCodeAt(0)));
    put(2, () => view.setUint16(at, formatVersion, true));
    put(1, () => view.setUint8(at, dim));
    put(1, () => view.setUint8(at, order));
    put(4, () => view.setUint32(at, this.index++, true));
    put(4, () => view.setUint32(at, count, true));
    put(8, () => view.setFloat64(at, moment.time, true));
    put(4, () => view.setUint32(at, poses.length, true));
    put(4, () => view.setUint32(at, this.ranges.length, true));
    for (const x of [...this.box!.min, ...this.box!.max]) put(8, () => view.setFloat64(at, x, true));
    for (const range of this.ranges) {
      put(4, () => view.setFloat32(at, range.low, true));
      put(4, () => view.setFloat32(at, range.high, true));
    }
    for (const x of poses.flat()) put(8, () => view.setFloat64(at, x, true));
    put(4, () => view.setUint32(at, payload.length, true));
    put(4, () => view.setUint32(at, raw.length, true));
    bytes.set(payload, at);
    return bytes;
  }
}

function quantised(x: number, low: number, high: number, steps: number): number {
  return Math.round(((x - low) / (high - low)) * steps);
}
