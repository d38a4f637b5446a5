// Walls, gates and bodies as they are drawn in the case; what moves is moved by the poses of the frames.
import { BackSide, BufferAttribute, BufferGeometry, Color, DoubleSide, FrontSide, GLSL3, Group, Matrix4, Mesh, Quaternion, RawShaderMaterial, type Raycaster, Vector3, Vector4, type Side } from "three";
import type { Scene, Wall } from "../contract.ts";
import { edges, LineMark } from "./lines.ts";

const vertex = /* glsl */ `
precision highp float;
in vec3 position;
uniform mat4 modelViewMatrix, projectionMatrix, modelMatrix;
uniform vec4 plane;
out vec3 eye;
out float side;
void main() {
  vec4 e = modelViewMatrix * vec4(position, 1.0);
  eye = e.xyz;
  side = dot(plane.xyz, (modelMatrix * vec4(position, 1.0)).xyz) + plane.w;
  gl_Position = projectionMatrix * e;
}
`;

const fragment = /* glsl */ `
precision highp float;
uniform vec3 colour;
uniform float opacity;
in vec3 eye;
in float side;
out vec4 pixel;
void main() {
  if (side < 0.0) discard;
  vec3 n = normalize(cross(dFdx(eye), dFdy(eye)));
  float light = 0.66 + 0.34 * abs(dot(n, normalize(vec3(0.25, 0.75, 0.62))));
  pixel = vec4(colour * light, opacity);
}
`;

export interface WallColours {
  wall: string;
  /** Of the faces of resting walls in 3D. */
  sheet: string;
  gate: string;
  body: string;
  paper: string;
}

const roleOf = (wall: Wall): "wall" | "gate" | "body" => (wall.kind === "body" ? "body" : wall.kind === "gate" || wall.kind === "wave_maker" ? "gate" : "wall");

export class WallMarks {
  readonly group = new Group();
  private parts: { wall: Wall; holder: Group; lines: LineMark; casing: LineMark | null; sheets: Mesh<BufferGeometry, RawShaderMaterial>[] }[] = [];

  constructor(scene: Scene, private dim: 2 | 3) {
    for (const wall of scene.walls) {
      const holder = new Group();
      holder.matrixAutoUpdate = false;
      const lines = new LineMark({ colour: "#000", width: dim === 2 ? 3 : 1.2, opacity: dim === 2 ? 1 : 0.8 });
      const casing = dim === 2 ? new LineMark({ colour: "#fff", width: 6 }) : null; // so that walls show before the water
      const sheets: Mesh<BufferGeometry, RawShaderMaterial>[] = [];
      if (wall.polylines) {
        lines.set(wall.polylines);
        casing?.set(wall.polylines);
      }
      if (wall.triangles) {
        const { positions, indices } = wall.triangles;
        const edge = edges(positions, indices);
        lines.segments(edge.from, edge.to);
        const geometry = new BufferGeometry();
        geometry.setAttribute("position", new BufferAttribute(new Float32Array(positions), 3));
        geometry.setIndex(indices);
        if (wall.plate) sheets.push(sheet(geometry, DoubleSide, 1));
        else sheets.push(sheet(geometry, FrontSide, 1), sheet(geometry, BackSide, 0.06));
      }
      if (casing) {
        casing.mesh.renderOrder = 1;
        lines.mesh.renderOrder = 2;
        holder.add(casing.mesh);
      }
      holder.add(...sheets, lines.mesh);
      this.group.add(holder);
      this.parts.push({ wall, holder, lines, casing, sheets });
    }
  }

  colours(colours: WallColours): void {
    for (const { wall, lines, casing, sheets } of this.parts) {
      lines.colour(colours[roleOf(wall)]);
      casing?.colour(colours.paper);
      const face = roleOf(wall) === "wall" ? colours.sheet : colours[roleOf(wall)];
      for (const one of sheets) (one.material.uniforms["colour"]!.value as Color).set(face).convertLinearToSRGB();
    }
  }

  /** Marks one wall by wider lines; null: none. */
  mark(name: string | null): void {
    for (const { wall, lines } of this.parts) lines.width((this.dim === 2 ? 3 : 1.2) * (wall.name === name ? 2 : 1));
  }

  section(plane: Vector4): void {
    for (const { sheets } of this.parts) for (const one of sheets) (one.material.uniforms["plane"]!.value as Vector4).copy(plane);
  }

  picture(width: number, height: number): void {
    for (const { lines, casing } of this.parts) for (const one of [lines, casing]) one?.picture(width, height);
  }

  move(posesA: number[][], posesB: number[][], share: number): void {
    for (const { wall, holder } of this.parts) {
      if (wall.moving === null || wall.moving === undefined) continue;
      const a = posesA[wall.moving];
      const b = posesB[wall.moving];
      if (a && b) {
        holder.matrix.copy(between(a, b, share));
        holder.matrixWorldNeedsUpdate = true;
      }
    }
  }

  /** The wall whose face a ray meets first. */
  struck(ray: Raycaster): string | null {
    const faces = this.parts.flatMap(({ wall, sheets }) => sheets.slice(0, 1).map((mesh) => ({ wall, mesh })));
    const [first] = ray.intersectObjects(faces.map(({ mesh }) => mesh), false);
    return faces.find(({ mesh }) => mesh === first?.object)?.wall.name ?? null;
  }

  /** Where a point as drawn is now, moved by a pose. */
  moved(pose: number, point: number[]): number[] {
    const part = this.parts.find(({ wall }) => wall.moving === pose);
    return part ? new Vector3(point[0], point[1], point[2] ?? 0).applyMatrix4(part.holder.matrix).toArray() : point;
  }

  dispose(): void {
    for (const { lines, casing, sheets } of this.parts) {
      lines.dispose();
      casing?.dispose();
      for (const one of sheets) {
        one.geometry.dispose();
        one.material.dispose();
      }
    }
  }
}

function sheet(geometry: BufferGeometry, side: Side, opacity: number): Mesh<BufferGeometry, RawShaderMaterial> {
  const mesh = new Mesh(
    geometry,
    new RawShaderMaterial({
      glslVersion: GLSL3, vertexShader: vertex, fragmentShader: fragment, side,
      transparent: opacity < 1, depthWrite: opacity === 1, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
      uniforms: { colour: { value: new Color() }, opacity: { value: opacity }, plane: { value: new Vector4(0, 0, 0, 1) } },
    }),
  );
  mesh.frustumCulled = false;
  return mesh;
}

/** Rotation about the origin and displacement, a share of the way from pose `a` to pose `b`: x' = R x + t. */
export function between(a: number[], b: number[], share: number): Matrix4 {
  const mix = (i: number) => a[i]! + share * (b[i]! - a[i]!);
  const one = new Vector3(1, 1, 1);
  if (a.length === 3) {
    return new Matrix4().compose(new Vector3(mix(0), mix(1), 0), new Quaternion().setFromAxisAngle(new Vector3(0, 0, 1), mix(2)), one);
  }
  const turn = (p: number[]) => new Quaternion(p[4], p[5], p[6], p[3]).normalize();
  return new Matrix4().compose(new Vector3(mix(0), mix(1), mix(2)), turn(a).slerp(turn(b), share), one);
}
