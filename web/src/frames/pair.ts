// Two frames made ready for the graphics card: where each particle of the first is in the second.
import { stride, type Frame } from "./format.ts";

/** The block of `b` in the order of `a`. A particle that is no longer in `b` stays where it is, in `b`'s box. */
export function follow(a: Frame, b: Frame): Uint16Array {
  if (a === b || sameIds(a.ids, b.ids)) return b.data;
  const out = new Uint16Array(a.data.length);
  const toB = a.boxMin.map((low, d) => {
    const sizeB = b.boxMax[d]! - b.boxMin[d]!;
    return { scale: (a.boxMax[d]! - low) / sizeB, shift: (65535 * (low - b.boxMin[d]!)) / sizeB };
  });
  let j = 0;
  for (let i = 0; i < a.ids.length; ++i) {
    const id = a.ids[i]!;
    while (j < b.ids.length && b.ids[j]! < id) ++j;
    const o = i * stride;
    if (j < b.ids.length && b.ids[j] === id) {
      for (let c = 0; c < stride; ++c) out[o + c] = b.data[j * stride + c]!;
    } else {
      toB.forEach(({ scale, shift }, d) => (out[o + d] = Math.min(65535, Math.max(0, Math.round(a.data[o + d]! * scale + shift)))));
      out[o + 3] = a.data[o + 3]!;
    }
  }
  return out;
}

function sameIds(a: Float64Array, b: Float64Array): boolean {
  if (a === b) return true;
  if (a.length !== b.length) return false;
  for (let i = 0; i < a.length; ++i) if (a[i] !== b[i]) return false;
  return true;
}
