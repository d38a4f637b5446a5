// One run in the picture: its water, walls, open ends, probes and the lines that are measured over the water.
import { Scene as ThreeScene, Vector4 } from "three";
import type { AirPlace, OpenEnd, Probe, Scene } from "../contract.ts";
import type { Frame } from "../frames/format.ts";
import { upward } from "./eye.ts";
import { LineMark } from "./lines.ts";
import { ParticleMark, type Choice } from "./particles.ts";
import { SurfaceMark } from "./surface.ts";
import { WallMarks, type WallColours } from "./walls.ts";

export interface StageColours extends WallColours {
  open: string;
  probe: string;
  accent: string;
  profile: string;
}

export class Stage {
  readonly scene3 = new ThreeScene();
  readonly particles: ParticleMark;
  readonly walls: WallMarks;
  readonly up: { axis: number; sign: 1 | -1 };
  /** In 3D, where the surface is asked for. */
  surface: SurfaceMark | null = null;
  private ends: LineMark;
  private vents: LineMark;
  private probes: LineMark;
  private lit: LineMark;
  private profile: LineMark;
  private selected: string | null = null;

  constructor(readonly scene: Scene) {
    const dim = scene.dimension;
    this.up = upward(scene.gravity, dim);
    this.particles = new ParticleMark(dim, scene.spacing, scene.scalars.findIndex((s) => s.name === "size"), this.up);
    this.walls = new WallMarks(scene, dim);
    this.ends = new LineMark({ colour: "#000", width: 2, dash: 12 });
    this.vents = new LineMark({ colour: "#000", width: 2, onTop: true });
    this.probes = new LineMark({ colour: "#000", width: 1.5, onTop: true, opacity: 0.9 });
    this.lit = new LineMark({ colour: "#000", width: 3.5, onTop: true });
    this.profile = new LineMark({ colour: "#000", width: 2.5, onTop: dim === 2 });
    this.ends.set([...scene.inlets, ...scene.outlets].map((end) => outline(end, dim)));
    this.vents.set(scene.vents.flatMap((vent) => rings(vent, dim, scene.spacing)));
    this.probes.set(scene.probes.map((probe) => this.mark(probe)));
    this.scene3.add(this.walls.group, this.particles.points, this.ends.mesh, this.vents.mesh, this.profile.mesh, this.probes.mesh, this.lit.mesh);
    this.particles.points.renderOrder = dim === 2 ? -1 : 0;
    for (const mark of this.marks) mark.mesh.renderOrder = 3;
  }

  private get marks(): LineMark[] {
    return [this.ends, this.vents, this.profile, this.probes, this.lit];
  }

  colours(c: StageColours): void {
    this.walls.colours(c);
    this.ends.colour(c.open);
    this.vents.colour(c.open);
    this.probes.colour(c.probe);
    this.lit.colour(c.accent);
    this.profile.colour(c.profile);
  }

  /** Shows the water as a surface (3D), or as particles. */
  asSurface(yes: boolean): void {
    if (yes && !this.surface && this.scene.dimension === 3) {
      this.surface = new SurfaceMark(this.particles, this.scene.spacing);
      this.scene3.add(this.surface.mesh);
    }
    if (this.surface) this.surface.mesh.visible = yes;
    this.particles.material.visible = !(yes && this.surface);
  }

  picture(width: number, height: number): void {
    this.walls.picture(width, height);
    for (const mark of this.marks) mark.picture(width, height);
  }

  /** `choice`: which of the particles are drawn. */
  show(at: { a: Frame; b: Frame; share: number }, choice: Choice | null): void {
    this.particles.show(at.a, at.b, at.share, choice);
    this.walls.move(at.a.poses, at.b.poses, at.share);
  }

  /** Cuts away what lies before the plane n x + w >= 0; a finite thickness leaves a slice. */
  section(plane: Vector4, thickness: number): void {
    this.particles.set("plane", plane);
    this.particles.set("thickness", thickness);
    this.walls.section(plane);
  }

  select(probe: string | null): void {
    if (probe === this.selected) return;
    this.selected = probe;
    const found = this.scene.probes.find((p) => p.name === probe);
    this.lit.set(found ? [this.mark(found)] : []);
  }

  /** How a probe is drawn: a depth gauge as the plumb line that it reads, others as they are placed. */
  private mark(probe: Probe): number[][] {
    const [point] = probe.points;
    if (!point || probe.points.length > 1 || (probe.type !== "depth" && probe.type !== "velocity-profile")) return probeLine(probe.points);
    const { axis, sign } = this.up;
    const { min, max } = this.scene.box;
    const top = [...point];
    top[axis] = sign > 0 ? max[axis]! : min[axis]!;
    return [point, top];
  }

  overlay(lines: number[][][]): void {
    this.profile.set(lines);
  }

  /** A box around all there is to see. */
  bounds(): { min: number[]; max: number[] } {
    const { min, max } = this.scene.box;
    return { min: [...min], max: [...max] };
  }

  dispose(): void {
    this.surface?.dispose();
    this.particles.dispose();
    this.walls.dispose();
    for (const mark of this.marks) mark.dispose();
  }
}

/** The rim of an open end; in 3D a rectangle that `from` and `to` are corners of. */
export function outline(end: OpenEnd, dim: 2 | 3): number[][] {
  if (end.corners) return end.corners.length > 2 ? [...end.corners, end.corners[0]!] : end.corners;
  if (!end.from || !end.to) return [];
  return dim === 2 ? [end.from, end.to] : rectangle(end.from, end.to);
}

/** Circles around a vent, as wide as it is but so wide that they show: one in 2D, three in 3D. */
function rings({ at, width = 0 }: AirPlace, dim: 2 | 3, spacing: number): number[][][] {
  const radius = Math.max(width, spacing) / 2;
  const planes = dim === 2 ? [[0, 1]] : [[0, 1], [1, 2], [2, 0]];
  return planes.map(([u, v]) =>
    Array.from({ length: 33 }, (_, i) => at.map((x, d) => x + radius * (d === u ? Math.cos((i * Math.PI) / 16) : d === v ? Math.sin((i * Math.PI) / 16) : 0))),
  );
}

/** The flat axis-parallel rectangle between opposite corners. */
function rectangle(from: number[], to: number[]): number[][] {
  const flat = [0, 1, 2].find((d) => from[d] === to[d]) ?? 2;
  const [u] = [0, 1, 2].filter((d) => d !== flat) as [number, number];
  const second = [...from];
  second[u] = to[u]!;
  const fourth = [...to];
  fourth[u] = from[u]!;
  return [from, second, to, fourth, from];
}

function probeLine(points: number[][]): number[][] {
  if (points.length < 2) return [];
  if (points.length === 2) return points;
  const closed = points[0]!.every((x, d) => x === points.at(-1)![d]);
  return closed ? points : [...points, points[0]!];
}
