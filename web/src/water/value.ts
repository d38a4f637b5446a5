// Meaning of the water's colour: the quantity, its unit, its limits, and the value of one particle.
import type { Colouring } from "../store.ts";
import type { Subject } from "../run/subject.ts";
import { stride, type Frame } from "../frames/format.ts";
import { levelsOf } from "../frames/levels.ts";
import type { Quantity } from "./particles.ts";

export const colourings: { name: Colouring; title: string; unit: string; key: string }[] = [
  { name: "speed", title: "Speed", unit: "m/s", key: "1" },
  { name: "pressure", title: "Pressure", unit: "Pa", key: "2" },
  { name: "depth", title: "Depth below the surface", unit: "m", key: "3" },
  { name: "origin", title: "Age, or where it started", unit: "", key: "4" },
  { name: "plain", title: "One colour", unit: "", key: "5" },
  { name: "size", title: "Spacing", unit: "m", key: "6" },
  { name: "liquid", title: "Liquid", unit: "", key: "7" },
];

const scalarOf = (run: Subject, name: string) => run.scene.scalars.findIndex((s) => s.name === name);

/** Whether a run can be coloured so: ids of particles that split do not say where they started. */
export function isOffered(run: Subject | undefined, colouring: Colouring): boolean {
  const has = (name: string) => run !== undefined && scalarOf(run, name) >= 0;
  if (colouring === "size" || colouring === "liquid") return has(colouring);
  return colouring !== "origin" || !has("size");
}

export function quantity(run: Subject, colouring: Colouring): Quantity {
  if (!isOffered(run, colouring) || colouring === "plain") return "plain";
  if (colouring === "depth") return "depth";
  if (colouring === "origin" || colouring === "size" || colouring === "liquid") return "own";
  const at = scalarOf(run, colouring);
  return at === 0 ? "scalar0" : at === 1 ? "scalar1" : "plain";
}

/** The whole number of a scalar of one particle, 0 to 255. */
function byteOf(frame: Frame, s: number, i: number): number {
  return s < 2 ? (frame.data[i * stride + 3]! >> (8 * s)) & 255 : frame.more[s - 2]![i]!;
}

/** A particle's value, and NaN where the frame has none. */
export function valueOf(run: Subject, frame: Frame, colouring: Colouring, i: number): number {
  const s = scalarOf(run, colouring);
  const range = frame.scalars[s];
  return range ? range.low + (byteOf(frame, s, i) / 255) * (range.high - range.low) : NaN;
}

/** The values of all particles of a frame. */
export function valuesOf(run: Subject, frame: Frame, colouring: Colouring): Float32Array {
  return Float32Array.from({ length: frame.count }, (_, i) => valueOf(run, frame, colouring, i));
}

/** Lowest and highest values but for the outermost 0.5 % of the particles at each end: single ones do not fade the rest. */
export function spread(run: Subject, frame: Frame, colouring: Colouring, up: { axis: number; sign: 1 | -1 }): [number, number] {
  if (colouring === "depth") {
    const lowest = lowestHeight(frame, up);
    const deepest = levelsOf(frame, up, run.scene.spacing).top.reduce((most, height) => Math.max(most, height - lowest), 0);
    return [0, deepest || 1];
  }
  const s = scalarOf(run, colouring);
  if (!frame.scalars[s]) return [0, 1];
  if (colouring === "liquid") return [0, Math.max(1, run.scene.liquids.length - 1)];
  const counts = new Uint32Array(256);
  for (let i = 0; i < frame.count; ++i) counts[byteOf(frame, s, i)]!++;
  const few = 0.005 * frame.count;
  let low = 0;
  let high = 255;
  for (let sum = 0; low < 255 && (sum += counts[low]!) <= few; ) ++low;
  for (let sum = 0; high > low && (sum += counts[high]!) <= few; ) --high;
  const range = frame.scalars[s]!;
  const value = (byte: number) => range.low + (byte / 255) * (range.high - range.low);
  return [value(low), value(Math.max(high, low + 1))];
}

function lowestHeight(frame: Frame, up: { axis: number; sign: number }): number {
  let lowest = up.sign > 0 ? 65535 : 0;
  for (let o = up.axis; o < frame.data.length; o += stride) {
    const q = frame.data[o]!;
    if (up.sign > 0 ? q < lowest : q > lowest) lowest = q;
  }
  const x = frame.boxMin[up.axis]! + (lowest / 65535) * (frame.boxMax[up.axis]! - frame.boxMin[up.axis]!);
  return up.sign * x;
}

/** Where particle `i` of a frame is. */
export function placeOf(frame: Frame, i: number): number[] {
  return frame.boxMin.map((low, d) => low + (frame.data[i * stride + d]! / 65535) * (frame.boxMax[d]! - low));
}

/**
 * Water tagged by where it came from, 0 to 1: in a closed tank the place along the flume where each particle started, with
 * an inlet its age from 0 (oldest) to 1 (newest), since ids are given in order of entry.
 */
export function origins(first: Frame, frame: Frame, along: number, byAge: boolean): Float32Array {
  const out = new Float32Array(frame.ids.length);
  if (byAge) {
    const oldest = frame.ids[0] ?? 0;
    const reach = Math.max(1, (frame.ids.at(-1) ?? 0) - oldest);
    return out.map((_, i) => (frame.ids[i]! - oldest) / reach);
  }
  let low = 65535;
  let high = 0;
  for (let o = along; o < first.data.length; o += stride) {
    low = Math.min(low, first.data[o]!);
    high = Math.max(high, first.data[o]!);
  }
  for (let i = 0, j = 0; i < out.length; ++i) {
    while (j < first.ids.length && first.ids[j]! < frame.ids[i]!) ++j;
    if (first.ids[j] === frame.ids[i]) out[i] = (first.data[j * stride + along]! - low) / Math.max(1, high - low);
  }
  return out;
}
