// How high the water stands in each column of space: what "depth below the surface" is measured from.
import { stride, type Frame } from "./format.ts";

export interface Levels {
  /** Columns along the horizontal axes: how many, where the first begins, how wide, m. */
  counts: number[];
  origin: number[];
  width: number;
  /** Height of the connected water of each column, m; -Infinity where there is none. */
  top: Float32Array;
}

/** The least and the largest number of each coordinate. */
export function extremes(frame: Omit<Frame, "ids" | "more">): [number[], number[]] {
  const first = frame.boxMin.map(() => 65535);
  const last = frame.boxMin.map(() => 0);
  for (let i = 0; i < frame.data.length; i += stride) {
    for (let d = 0; d < first.length; ++d) {
      const q = frame.data[i + d]!;
      if (q < first[d]!) first[d] = q;
      if (q > last[d]!) last[d] = q;
    }
  }
  return [first, last];
}

const known = new WeakMap<object, Levels>();

/** The levels of a frame, found when they are first asked for. */
export function levelsOf(frame: Frame, up: { axis: number; sign: 1 | -1 }, spacing: number): Levels {
  let found = known.get(frame);
  if (!found) known.set(frame, (found = levels(frame, up.axis, up.sign, 2 * spacing)));
  return found;
}

/**
 * The water of a column is what stands connected from its lowest particle upwards, with gaps of at most three cells, so
 * that spray above does not count. `up`: the axis against gravity; `sign` -1: gravity points along +up.
 */
export function levels(frame: Omit<Frame, "ids" | "more">, up: number, sign: 1 | -1, width: number): Levels {
  const size = frame.boxMax.map((high, d) => high - frame.boxMin[d]!);
  const [first, last] = extremes(frame);
  const across = size.map((_, d) => d).filter((d) => d !== up);
  const wide = across.map((d) => ((last[d]! - first[d]!) / 65535) * size[d]!); // the box may be much larger
  const total = wide.map((x) => Math.max(1, Math.ceil(x / width)));
  const coarser = Math.max(1, Math.sqrt(total.reduce((a, b) => a * b, 1) / 4e4)); // at most some 40 000 columns
  const w = width * coarser;
  const counts = wide.map((x) => Math.max(1, Math.ceil(x / w)));
  const rows = Math.min(4096, Math.max(1, Math.ceil(size[up]! / width)));
  const columns = counts.reduce((a, b) => a * b, 1);
  const full = new Uint8Array(columns * rows);
  const scale = across.map((d) => (size[d]! / 65535) / w);
  const riser = (rows - 1e-3) / 65535;
  const [a, b] = across;
  for (let i = 0; i < frame.data.length; i += stride) {
    let column = Math.min(counts[0]! - 1, ((frame.data[i + a!]! - first[a!]!) * scale[0]!) | 0);
    if (b !== undefined) column += counts[0]! * Math.min(counts[1]! - 1, ((frame.data[i + b]! - first[b]!) * scale[1]!) | 0);
    const q = frame.data[i + up]!;
    full[column * rows + (((sign > 0 ? q : 65535 - q) * riser) | 0)] = 1;
  }
  const top = new Float32Array(columns).fill(-Infinity);
  const base = sign > 0 ? frame.boxMin[up]! : -frame.boxMax[up]!;
  for (let column = 0; column < columns; ++column) {
    let gap = 0;
    let highest = -1;
    for (let row = 0; row < rows && gap <= 3; ++row) {
      if (full[column * rows + row]) {
        highest = row;
        gap = 0;
      } else if (highest >= 0) {
        ++gap;
      }
    }
    if (highest >= 0) top[column] = base + ((highest + 1) * size[up]!) / rows;
  }
  return { counts, origin: across.map((d) => frame.boxMin[d]! + (first[d]! / 65535) * size[d]!), width: w, top };
}
