// From the drawing to the lines of the case file, and back.
import type { Drawing, Lines } from "../contract.ts";

interface Named {
  name: string;
  lines?: Lines;
}

/** Everything in a drawing that has lines in the case file. */
function named(drawing: Drawing): Named[] {
  return [...drawing.walls, ...drawing.bodies, ...drawing.inlets, ...drawing.outlets, ...drawing.pockets, ...drawing.vents, ...drawing.probes, ...(drawing.fluid ?? [])];
}

export function linesOf(drawing: Drawing, name: string): Lines | null {
  return named(drawing).find((one) => one.name === name)?.lines ?? null;
}

/** The name of what line `line` of the case file describes. */
export function nameAt(drawing: Drawing, line: number): string | null {
  return named(drawing).find(({ lines }) => lines && lines[0] <= line && line <= lines[1])?.name ?? null;
}

/** Distance of a point from a segment, all in the plane. */
export function distance(p: [number, number], a: [number, number], b: [number, number]): number {
  const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
  const size = dx * dx + dy * dy;
  const share = size > 0 ? Math.min(1, Math.max(0, ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / size)) : 0;
  return Math.hypot(p[0] - a[0] - share * dx, p[1] - a[1] - share * dy);
}
