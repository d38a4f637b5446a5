// Subject of a picture: a run, or the drawing of a case.
import type { Drawing, Info, Scene } from "../contract.ts";
import { stride, type Frame } from "../frames/format.ts";
import { fromBase64, type FrameEntry } from "../source.ts";
import type { Table } from "../tables.ts";

export interface Subject {
  readonly id: string;
  readonly name: string;
  readonly scene: Scene;
  readonly info: Info | null;
  readonly isLive: boolean;
  /** Time of the newest frame, s. */
  readonly end: number;
  readonly frames: {
    readonly list: readonly FrameEntry[];
    readonly times: number[];
    at(time: number): { a: Frame; b: Frame; share: number; exact: boolean } | null;
    frame(place: number): Frame | undefined;
    isDecoded(place: number): boolean;
  };
  table(probe: string): Table | undefined;
  /** Largest, mean and last levels of a level map along a channel (2D), as far as they are written. */
  map(probe: string): Table | undefined;
}

/** A scene as the page wants it: every list is there, and a box around all that is drawn. */
export function whole<S extends Scene>(scene: S): S {
  const lists = { walls: [], bodies: [], inlets: [], outlets: [], pockets: [], vents: [], probes: [], scalars: [], liquids: [], measurements: [] };
  const filled = { ...lists, ...Object.fromEntries(Object.entries(scene).filter(([, value]) => value !== null)) } as unknown as S;
  return { ...filled, box: filled.box ?? around(filled) };
}

function around(scene: Scene): Scene["box"] {
  const min = Array.from({ length: scene.dimension }, () => Infinity);
  const max = min.map(() => -Infinity);
  const take = (point: ArrayLike<number>) => {
    for (let d = 0; d < scene.dimension; ++d) {
      min[d] = Math.min(min[d]!, point[d]!);
      max[d] = Math.max(max[d]!, point[d]!);
    }
  };
  for (const wall of scene.walls) {
    wall.polylines?.flat().forEach(take);
    const positions = wall.triangles?.positions ?? [];
    for (let i = 0; i < positions.length; i += 3) take(positions.slice(i, i + 3));
  }
  for (const end of [...scene.inlets, ...scene.outlets]) (end.corners ?? [end.from, end.to]).forEach((p) => p && take(p));
  return min[0]! <= max[0]! ? { min, max } : { min: min.map(() => 0), max: max.map(() => 1) };
}

/** The drawing of a case as something to show: one frame, of the water at the start. */
export function drawn(drawing: Drawing, name: string, id: string): Subject {
  const scene = { ...whole(drawing), scalars: [] };
  const frame = startFrame(scene, drawing);
  const at = frame ? { a: frame, b: frame, share: 0, exact: true } : null;
  return {
    id, name, scene, info: null, isLive: false, end: 0,
    frames: { list: [], times: [], at: () => at, frame: () => frame ?? undefined, isDecoded: () => frame !== null },
    table: () => undefined,
    map: () => undefined,
  };
}

function startFrame(scene: Scene, drawing: Drawing): Frame | null {
  if (!drawing.particles || drawing.particles.shown === 0) return null;
  const dim = scene.dimension;
  const places = new Float32Array(fromBase64(drawing.particles.positions).buffer);
  const n = Math.floor(places.length / dim);
  const boxMin = Array.from({ length: dim }, () => Infinity);
  const boxMax = boxMin.map(() => -Infinity);
  for (let i = 0; i < n * dim; ++i) {
    boxMin[i % dim] = Math.min(boxMin[i % dim]!, places[i]!);
    boxMax[i % dim] = Math.max(boxMax[i % dim]!, places[i]!);
  }
  for (let d = 0; d < dim; ++d) boxMax[d] = Math.max(boxMax[d]!, boxMin[d]! + scene.spacing);
  const data = new Uint16Array(n * stride);
  for (let i = 0; i < n; ++i) {
    for (let d = 0; d < dim; ++d) data[i * stride + d] = Math.round((65535 * (places[i * dim + d]! - boxMin[d]!)) / (boxMax[d]! - boxMin[d]!));
  }
  return {
    dim, order: 0, index: 0, count: n, time: 0, boxMin, boxMax, scalars: [], poses: [], payloadBytes: 0, rawBytes: 0, payload: 0, data,
    more: [], ids: Float64Array.from({ length: n }, (_, i) => i),
  };
}
