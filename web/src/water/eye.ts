// The camera: where it looks and from where, in numbers that no new data change.
import { OrthographicCamera, PerspectiveCamera, Vector3, type Camera } from "three";

const fieldOfView = (30 * Math.PI) / 180;

export class Eye {
  readonly target = new Vector3();
  /** Height of what is seen at the target, m. */
  span = 1;
  azimuth = -1.1;
  elevation = 0.38;
  readonly camera: Camera;
  private up: Vector3;
  private across: [Vector3, Vector3];
  private reach = 1; // size of the scene

  constructor(readonly dim: 2 | 3, gravity: number[]) {
    this.camera = dim === 2 ? new OrthographicCamera() : new PerspectiveCamera();
    const { axis, sign } = upward(gravity, dim);
    this.up = new Vector3().setComponent(axis, sign);
    const first = new Vector3(axis === 0 ? 0 : 1, axis === 0 ? 1 : 0, 0);
    this.across = [first, new Vector3().crossVectors(this.up, first)];
  }

  /** Shows the whole box in a picture of `aspect` = width / height; the share `below` of its height stays free for the legend. */
  fit(min: number[], max: number[], aspect: number, below = 0): void {
    const size = max.map((x, d) => x - min[d]!);
    this.target.set(...(([0, 1, 2] as const).map((d) => (d < this.dim ? (min[d]! + max[d]!) / 2 : 0)) as [number, number, number]));
    this.reach = Math.hypot(...size);
    if (this.dim === 2) {
      this.span = 1.1 * Math.max(size[1]! / (1 - below), size[0]! / aspect, 1e-6);
      // The box stands in the middle where that leaves enough below it, else as high as it must.
      const free = (this.span - size[1]!) / 2;
      this.target.y -= Math.max(0, Math.min(below * this.span - free, 0.9 * free));
    } else {
      this.span = Math.max(0.82 * this.reach, (0.98 * this.reach) / aspect, 1e-6);
    }
  }

  /** Brings `camera` up to date for a picture of this aspect. */
  apply(aspect: number): void {
    const camera = this.camera;
    if (camera instanceof OrthographicCamera) {
      camera.top = this.span / 2;
      camera.bottom = -camera.top;
      camera.right = camera.top * aspect;
      camera.left = -camera.right;
      camera.near = -10;
      camera.far = 10;
      camera.position.copy(this.target);
      camera.updateProjectionMatrix();
    } else if (camera instanceof PerspectiveCamera) {
      const distance = this.distance;
      camera.up.copy(this.up);
      camera.position.copy(this.target).addScaledVector(this.direction(), distance);
      camera.lookAt(this.target);
      camera.fov = (fieldOfView * 180) / Math.PI;
      camera.aspect = aspect;
      camera.near = Math.max(distance * 0.01, distance - 2 * this.reach);
      camera.far = distance + 3 * this.reach;
      camera.updateProjectionMatrix();
    }
    camera.updateMatrixWorld();
  }

  private get distance(): number {
    return this.span / 2 / Math.tan(fieldOfView / 2);
  }

  private direction(): Vector3 {
    const flat = Math.cos(this.elevation);
    return new Vector3()
      .addScaledVector(this.across[0], flat * Math.cos(this.azimuth))
      .addScaledVector(this.across[1], flat * Math.sin(this.azimuth))
      .addScaledVector(this.up, Math.sin(this.elevation));
  }

  /** The picture follows the pointer by dx, dy pixels (y down) in a picture `height` pixels high. */
  pan(dx: number, dy: number, height: number): void {
    const metres = this.span / height;
    const right = new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 0);
    const up = new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 1);
    this.target.addScaledVector(right, -dx * metres).addScaledVector(up, dy * metres);
  }

  turn(dx: number, dy: number): void {
    this.azimuth -= dx;
    this.elevation = Math.min(1.55, Math.max(-1.55, this.elevation + dy));
  }

  /** `factor` below 1 comes nearer; x, y: the point of the picture that stays, from -1 to 1 (y up). */
  zoom(factor: number, x: number, y: number, aspect: number): void {
    const before = this.span;
    this.span = Math.min(100 * this.reach, Math.max(1e-5 * this.reach, this.span * factor));
    const moved = (before - this.span) / 2;
    const right = new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 0);
    const up = new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 1);
    this.target.addScaledVector(right, x * moved * aspect).addScaledVector(up, y * moved);
  }

  /** Where a point of space is in the picture, from -1 to 1; null: behind the camera. */
  project(point: number[]): { x: number; y: number; depth: number } | null {
    const p = new Vector3(point[0], point[1], point[2] ?? 0).project(this.camera);
    return p.z > 1 || p.z < -1 ? null : { x: p.x, y: p.y, depth: p.z };
  }

  /** In 2D: the point of space at a place of the picture. */
  place(x: number, y: number): number[] {
    const p = new Vector3(x, y, 0).unproject(this.camera);
    return [p.x, p.y];
  }
}

/** The axis that points most against gravity, and its sign; without gravity the last axis. */
export function upward(gravity: number[], dim: number): { axis: number; sign: 1 | -1 } {
  let axis = dim - 1;
  gravity.slice(0, dim).forEach((g, d) => {
    if (Math.abs(g) > Math.abs(gravity[axis] ?? 0)) axis = d;
  });
  return { axis, sign: (gravity[axis] ?? 0) > 0 ? -1 : 1 };
}
