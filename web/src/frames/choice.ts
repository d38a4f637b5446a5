// Which particles are drawn while the picture moves and is slow: in 3D those that may be seen from outside, and of these,
// or of all, one in each cell of a grid.
import { extremes } from "./levels.ts";
import { stride, type Frame } from "./format.ts";

/** A particle is inside where the cells around its own, so wide, in spacings, hold water too. */
const wall = 1.5;

type Moment = Omit<Frame, "ids" | "more">;

/** Cells over the water of a frame, as wide as asked for or wider: there are no more than `most`. */
class Grid {
  readonly counts: number[];
  readonly cells: number;
  private first: number[];
  private scale: number[];

  constructor(private frame: Moment, width: number, most = 1 << 24) {
    const size = frame.boxMax.map((high, d) => (high - frame.boxMin[d]!) / 65535);
    const [first, last] = extremes(frame);
    const wide = size.map((x, d) => Math.max(0, last[d]! - first[d]!) * x);
    const needed = wide.reduce((product, x) => product * (x / width + 1), 1);
    const w = width * Math.max(1, needed / most) ** (1 / wide.length);
    this.counts = wide.map((x) => Math.floor(x / w) + 1);
    this.cells = this.counts.reduce((a, b) => a * b, 1);
    this.first = first;
    this.scale = size.map((x) => x / w);
  }

  /** Calls `take` with each particle and the number of its cell. */
  each(take: (i: number, cell: number) => void): void {
    const { data, count, dim } = this.frame;
    const [nx, ny] = this.counts as [number, number];
    const [x, y, z] = this.first as [number, number, number];
    const [sx, sy, sz] = this.scale as [number, number, number];
    for (let i = 0, o = 0; i < count; ++i, o += stride) {
      const flat = ((data[o]! - x) * sx | 0) + nx * ((data[o + 1]! - y) * sy | 0);
      take(i, dim === 2 ? flat : flat + nx * ny * ((data[o + 2]! - z) * sz | 0));
    }
  }
}

/** Of each cell whether it and all around it are taken. */
function inner(taken: Uint8Array, counts: number[]): Uint8Array {
  let from = taken;
  let step = 1;
  for (const n of counts) {
    const to = new Uint8Array(from.length);
    for (let i = 0; i < from.length; ++i) {
      const k = Math.floor(i / step) % n;
      if (k > 0 && k < n - 1) to[i] = from[i]! & from[i - step]! & from[i + step]!;
    }
    from = to;
    step *= n;
  }
  return from;
}

/** Of each particle 1 where water is all around it. */
function insides(frame: Moment, spacing: number): Uint8Array {
  const grid = new Grid(frame, wall * spacing);
  const taken = new Uint8Array(grid.cells);
  grid.each((_, cell) => (taken[cell] = 1));
  const deep = inner(taken, grid.counts);
  const inside = new Uint8Array(frame.count);
  grid.each((i, cell) => (inside[i] = deep[cell]!));
  return inside;
}

/** Particles by their places in the frame, ascending. `width`: of a cell, m, that gives one particle; 0: all do. */
export function choose(frame: Moment, spacing: number, width: number, outside: boolean): Uint32Array {
  const inside = outside ? insides(frame, spacing) : null;
  const chosen = new Uint32Array(frame.count);
  let n = 0;
  if (width > 0) {
    const grid = new Grid(frame, width);
    const taken = new Uint8Array(grid.cells);
    grid.each((i, cell) => {
      if (taken[cell] || inside?.[i]) return;
      taken[cell] = 1;
      chosen[n++] = i;
    });
  } else {
    for (let i = 0; i < frame.count; ++i) if (!inside?.[i]) chosen[n++] = i;
  }
  return chosen.slice(0, n);
}
