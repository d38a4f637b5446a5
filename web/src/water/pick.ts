// The particle under the pointer.
import { Matrix4, Raycaster, Vector2 } from "three";
import { distance } from "../case/pointing.ts";
import { stride } from "../frames/format.ts";
import type { Frame } from "../frames/format.ts";
import type { Subject } from "../run/subject.ts";
import type { Staging } from "./staging.ts";
import { placeOf } from "./value.ts";
import type { WaterView } from "./view.ts";

export interface Picked {
  place: number[];
  run: Subject | null;
  frame: Frame | null;
  i: number;
}

/** The particle nearest to a place of the canvas, at most 8 pixels off; in 2D without one, the place itself. */
export function nearest(view: WaterView, staging: Staging, x: number, y: number): Picked | null {
  const cell = view.cells.find((c) => x >= c.x && x < c.x + c.width && y >= c.y && y < c.y + c.height);
  const eye = view.eye;
  if (!cell || !eye) return null;
  const px = (2 * (x - cell.x)) / cell.width - 1;
  const py = 1 - (2 * (y - cell.y)) / cell.height;
  const m = new Matrix4().multiplyMatrices(eye.camera.projectionMatrix, eye.camera.matrixWorldInverse).elements;
  let best: Picked | null = null;
  let closest = 8 ** 2;
  let front = Infinity;
  for (const { run, stage } of staging.shown) {
    if (!cell.stages.includes(stage)) continue;
    const at = run.frames.at(view.time);
    if (!at) continue;
    const { data, boxMin, boxMax, dim } = at.a;
    const low = [0, 1, 2].map((d) => boxMin[d] ?? 0);
    const step = [0, 1, 2].map((d) => ((boxMax[d] ?? 0) - low[d]!) / 65535);
    for (let i = 0, o = 0; o < data.length; ++i, o += stride) {
      const a = low[0]! + data[o]! * step[0]!;
      const b = low[1]! + data[o + 1]! * step[1]!;
      const c = dim === 3 ? low[2]! + data[o + 2]! * step[2]! : 0;
      const w = m[3]! * a + m[7]! * b + m[11]! * c + m[15]!;
      const u = (((m[0]! * a + m[4]! * b + m[8]! * c + m[12]!) / w - px) * cell.width) / 2;
      const v = (((m[1]! * a + m[5]! * b + m[9]! * c + m[13]!) / w - py) * cell.height) / 2;
      const distance = u * u + v * v;
      if (distance < closest - (dim === 3 ? 0 : 1e-9) || (dim === 3 && distance < 9 && w < front)) {
        closest = Math.min(closest, Math.max(distance, dim === 3 ? 9 : 0));
        front = w;
        best = { place: placeOf(at.a, i), run, frame: at.a, i };
      }
    }
  }
  if (best) return best;
  return eye.dim === 2 ? { place: eye.place(px, py), run: null, frame: null, i: -1 } : null;
}

/** The wall under a place of the canvas: in 2D the nearest line within 8 pixels, in 3D the foremost face. */
export function wallNear(view: WaterView, staging: Staging, x: number, y: number): string | null {
  const cell = view.cells.find((c) => x >= c.x && x < c.x + c.width && y >= c.y && y < c.y + c.height);
  const eye = view.eye;
  if (!cell || !eye) return null;
  const screen = (point: number[]): [number, number] | null => {
    const at = eye.project(point);
    return at && [cell.x + ((at.x + 1) * cell.width) / 2, cell.y + ((1 - at.y) * cell.height) / 2];
  };
  let best: string | null = null;
  let closest = 8;
  for (const { stage } of staging.shown) {
    for (const wall of stage.scene.walls) {
      const place = (p: number[]) => screen(wall.moving === null ? p : stage.walls.moved(wall.moving, p));
      for (const line of wall.polylines ?? []) {
        for (let i = 0; i + 1 < line.length; ++i) {
          const [a, b] = [place(line[i]!), place(line[i + 1]!)];
          const far = a && b ? distance([x, y], a, b) : Infinity;
          if (far < closest) {
            closest = far;
            best = wall.name;
          }
        }
      }
    }
    if (eye.dim === 3) {
      const ray = new Raycaster();
      ray.setFromCamera(new Vector2((2 * (x - cell.x)) / cell.width - 1, 1 - (2 * (y - cell.y)) / cell.height), eye.camera);
      best = stage.walls.struck(ray) ?? best;
    }
  }
  return best;
}
