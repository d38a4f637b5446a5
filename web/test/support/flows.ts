// Small flows made of formulas, so that the page can be tried without the solver.
import type { Scene } from "../../src/contract.ts";
import type { Moment } from "./encode.ts";

export interface Flow {
  scene: Scene;
  moment(time: number): Moment;
  /** Reading of a probe by name. */
  reading(probe: string, time: number): number[];
}

const base = { format: 1, bodies: [], inlets: [], outlets: [], pockets: [], vents: [], measurements: [], liquids: [], scalars: [{ name: "pressure", unit: "Pa" }, { name: "speed", unit: "m/s" }] };

/** A standing wave in a tank 2 m long and 0.5 m deep, with a gate that turns, in `rows` rows of particles. */
export function standingWave(rows = 25, end = 4): Flow {
  const [length, depth, height] = [2, 0.5, 1];
  const dx = depth / rows;
  const columns = Math.round(length / dx);
  const k = (2 * Math.PI) / length;
  const omega = Math.sqrt(9.81 * k * Math.tanh(k * depth));
  const height_ = 0.08;
  const eta = (x: number, t: number) => height_ * Math.cos(k * x) * Math.cos(omega * t);
  const scene: Scene = {
    ...base, title: "Standing wave", dimension: 2, spacing: dx, gravity: [0, -9.81], end, box: { min: [0, 0], max: [length, height] },
    walls: [
      { name: "tank", kind: "wall", moving: null, polylines: [[[0, height], [0, 0], [length, 0], [length, height]]] },
      { name: "flap", kind: "gate", moving: 0, polylines: [[[0, 0], [0, 0.3]]] },
    ],
    probes: [
      { name: "H1", type: "depth", points: [[0.5, 0]], columns: ["connected_m", "highest_m"] },
      { name: "P1", type: "wall-pressure", points: [[length, 0.1]], columns: ["pressure_Pa"] },
      { name: "energy", type: "energy", points: [], columns: ["total_J"] },
    ],
    measurements: [{ probe: "H1", column: "connected_m", file: "laboratory.csv", time: [0, 0.5, 1, 1.5, 2], value: [0, 1, 2, 3, 4].map((i) => depth + eta(0.5, i / 2)) }],
  };
  const n = columns * rows;
  return {
    scene,
    moment(time) {
      const [x, y, pressure, speed] = [0, 1, 2, 3].map(() => new Float64Array(n)) as [Float64Array, Float64Array, Float64Array, Float64Array];
      for (let i = 0; i < n; ++i) {
        const x0 = ((i % columns) + 0.5) * dx;
        const s = (Math.floor(i / columns) + 0.5) / rows;
        const move = -height_ * (Math.sin(k * x0) / (k * depth)) * Math.cos(omega * time);
        x[i] = x0 + move;
        y[i] = s * (depth + eta(x0, time));
        pressure[i] = 9810 * (1 - s) * (depth + eta(x0, time));
        speed[i] = Math.abs(height_ * omega * Math.sin(omega * time)) * Math.hypot(Math.sin(k * x0) / (k * depth), s * Math.cos(k * x0));
      }
      return { time, ids: Uint32Array.from({ length: n }, (_, i) => i), places: [x, y], scalars: [pressure, speed], poses: [[0, 0, -0.3 - 0.2 * Math.sin(omega * time)]] };
    },
    reading(probe, time) {
      if (probe === "H1") return [depth + eta(0.5, time), depth + eta(0.5, time) + dx];
      if (probe === "P1") return [9810 * (depth + eta(length, time) - 0.1)];
      return [1000 + 5 * Math.cos(2 * omega * time)];
    },
  };
}

/** A wave that runs round in a 3D basin with a block in it; `n` particles or a few more. */
export function basin(n = 20_000, end = 4): Flow {
  const [lx, ly, depth] = [2, 1, 0.4];
  const dx = Math.cbrt((lx * ly * depth) / n);
  const [nx, ny, nz] = [Math.round(lx / dx), Math.round(ly / dx), Math.round(depth / dx)];
  const count = nx * ny * nz;
  const eta = (x: number, y: number, t: number) => 0.07 * Math.cos(Math.PI * (x - 0.6 * t)) * Math.cos(Math.PI * y + t);
  const box = (min: number[], max: number[], inside: boolean) => {
    const positions = [0, 1, 2, 3, 4, 5, 6, 7].flatMap((c) => [0, 1, 2].map((d) => ((c >> d) & 1 ? max[d]! : min[d]!)));
    // Outward; seen from the water inside they turn the other way. A tank is open at the top.
    const faces = [[0, 2, 3, 0, 3, 1], [0, 1, 5, 0, 5, 4], [2, 6, 7, 2, 7, 3], [0, 4, 6, 0, 6, 2], [1, 3, 7, 1, 7, 5], ...(inside ? [] : [[4, 5, 7, 4, 7, 6]])].flat();
    return { positions, indices: inside ? faces.map((_, i) => faces[3 * Math.floor(i / 3) + [0, 2, 1][i % 3]!]!) : faces };
  };
  const scene: Scene = {
    ...base, title: "Wave in a basin", dimension: 3, spacing: dx, gravity: [0, 0, -9.81], end, box: { min: [0, 0, 0], max: [lx, ly, 0.8] },
    walls: [
      { name: "basin", kind: "wall", moving: null, triangles: box([0, 0, 0], [lx, ly, 0.8], true) },
      { name: "float", kind: "body", moving: 0, triangles: box([-0.15, -0.15, -0.1], [0.15, 0.15, 0.1], false) },
    ],
    probes: [{ name: "H1", type: "depth", points: [[0.5, 0.5, 0]], columns: ["connected_m"] }],
  };
  return {
    scene,
    moment(time) {
      const columns = Array.from({ length: 5 }, () => new Float64Array(count));
      const [x, y, z, pressure, speed] = columns as [Float64Array, Float64Array, Float64Array, Float64Array, Float64Array];
      for (let i = 0; i < count; ++i) {
        x[i] = ((i % nx) + 0.5) * dx;
        y[i] = ((Math.floor(i / nx) % ny) + 0.5) * dx;
        const s = (Math.floor(i / (nx * ny)) + 0.5) / nz;
        const h = depth + eta(x[i]!, y[i]!, time);
        z[i] = s * h;
        pressure[i] = 9810 * (1 - s) * h;
        speed[i] = 0.4 * s * Math.abs(Math.sin(Math.PI * (x[i]! - 0.6 * time)));
      }
      const turn = 0.2 * Math.sin(2 * time);
      return {
        time, ids: Uint32Array.from({ length: count }, (_, i) => i), places: [x, y, z], scalars: [pressure, speed],
        poses: [[1.4, 0.5, depth + 0.05 * Math.sin(3 * time), Math.cos(turn / 2), 0, Math.sin(turn / 2), 0]],
      };
    },
    reading: (_, time) => [depth + eta(0.5, 0.5, time)],
  };
}
