// Lines of a width in pixels, whatever the zoom: walls of 2D, edges, probes, profiles over the water. Each segment is a
// rectangle that the vertex shader widens in the picture.
import {
  BufferAttribute, Color, DoubleSide, GLSL3, InstancedBufferAttribute, InstancedBufferGeometry, Mesh, RawShaderMaterial, Vector2,
} from "three";

const vertex = /* glsl */ `
precision highp float;
in vec2 corner;
in vec3 from, to;
uniform mat4 modelViewMatrix, projectionMatrix;
uniform vec2 picture;
uniform float width, lift;
out float way;
void main() {
  vec4 p = projectionMatrix * modelViewMatrix * vec4(from, 1.0);
  vec4 q = projectionMatrix * modelViewMatrix * vec4(to, 1.0);
  vec2 line = (q.xy / q.w - p.xy / p.w) * picture;
  float length_ = max(length(line), 1e-6);
  vec2 forward = line / length_;
  vec2 side = vec2(-forward.y, forward.x);
  vec4 here = corner.x < 0.0 ? p : q;
  vec2 shift = (forward * corner.x * 0.5 + side * corner.y) * width / picture;
  gl_Position = here + vec4(shift * here.w, -lift * here.w, 0.0);
  way = corner.x < 0.0 ? 0.0 : length_ * 0.5;
}
`;

const fragment = /* glsl */ `
precision highp float;
uniform vec3 colour;
uniform float opacity, dash;
in float way;
out vec4 pixel;
void main() {
  if (dash > 0.0 && fract(way / dash) > 0.55) discard;
  pixel = vec4(colour, opacity);
}
`;

export interface LineLook {
  colour: string;
  width: number;
  dash?: number;
  opacity?: number;
  /** In 3D also where something is before it. */
  onTop?: boolean;
}

export class LineMark {
  readonly mesh: Mesh<InstancedBufferGeometry, RawShaderMaterial>;

  constructor(look: LineLook) {
    const material = new RawShaderMaterial({
      glslVersion: GLSL3, vertexShader: vertex, fragmentShader: fragment, transparent: true, side: DoubleSide,
      depthTest: !look.onTop, depthWrite: false,
      uniforms: {
        picture: { value: new Vector2(1, 1) }, width: { value: look.width }, colour: { value: new Color() }, opacity: { value: look.opacity ?? 1 },
        dash: { value: look.dash ?? 0 }, lift: { value: look.onTop ? 0 : 1e-4 },
      },
    });
    this.mesh = new Mesh(new InstancedBufferGeometry(), material);
    this.mesh.frustumCulled = false;
    this.colour(look.colour);
    this.set([]);
  }

  colour(css: string): void {
    (this.mesh.material.uniforms["colour"]!.value as Color).set(css).convertLinearToSRGB();
  }

  width(pixels: number): void {
    this.mesh.material.uniforms["width"]!.value = pixels;
  }

  /** Size of the picture in pixels. */
  picture(width: number, height: number): void {
    (this.mesh.material.uniforms["picture"]!.value as Vector2).set(width, height);
  }

  /** Lines through points of 2 or 3 coordinates. */
  set(lines: number[][][]): void {
    const from: number[] = [];
    const to: number[] = [];
    for (const line of lines) {
      for (let i = 0; i + 1 < line.length; ++i) {
        from.push(line[i]![0]!, line[i]![1]!, line[i]![2] ?? 0);
        to.push(line[i + 1]![0]!, line[i + 1]![1]!, line[i + 1]![2] ?? 0);
      }
    }
    this.segments(new Float32Array(from), new Float32Array(to));
  }

  segments(from: Float32Array, to: Float32Array): void {
    this.mesh.geometry.dispose();
    const geometry = new InstancedBufferGeometry();
    geometry.setAttribute("corner", new BufferAttribute(new Float32Array([-1, -1, 1, -1, 1, 1, -1, 1]), 2));
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    geometry.setAttribute("from", new InstancedBufferAttribute(from, 3));
    geometry.setAttribute("to", new InstancedBufferAttribute(to, 3));
    geometry.instanceCount = from.length / 3;
    this.mesh.geometry = geometry;
    this.mesh.visible = from.length > 0;
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}

/** Edges of a triangle mesh where it bends by more than some 20 degrees, or ends. */
export function edges(positions: ArrayLike<number>, indices: ArrayLike<number>): { from: Float32Array; to: Float32Array } {
  const key = (i: number) => `${positions[3 * i]!.toPrecision(8)} ${positions[3 * i + 1]!.toPrecision(8)} ${positions[3 * i + 2]!.toPrecision(8)}`;
  const seen = new Map<string, { a: number; b: number; normal: number[]; bend: number | null }>();
  const point = (i: number) => [positions[3 * i]!, positions[3 * i + 1]!, positions[3 * i + 2]!];
  for (let t = 0; t < indices.length; t += 3) {
    const corners = [indices[t]!, indices[t + 1]!, indices[t + 2]!];
    const [p, q, r] = corners.map(point) as [number[], number[], number[]];
    const u = q.map((x, d) => x - p[d]!);
    const v = r.map((x, d) => x - p[d]!);
    const n = [u[1]! * v[2]! - u[2]! * v[1]!, u[2]! * v[0]! - u[0]! * v[2]!, u[0]! * v[1]! - u[1]! * v[0]!];
    const size = Math.hypot(...n) || 1;
    const normal = n.map((x) => x / size);
    for (let e = 0; e < 3; ++e) {
      const a = corners[e]!;
      const b = corners[(e + 1) % 3]!;
      const name = [key(a), key(b)].sort().join("|");
      const other = seen.get(name);
      if (other) other.bend = Math.min(other.bend ?? 1, Math.abs(normal.reduce((sum, x, d) => sum + x * other.normal[d]!, 0)));
      else seen.set(name, { a, b, normal, bend: null });
    }
  }
  const from: number[] = [];
  const to: number[] = [];
  for (const { a, b, bend } of seen.values()) {
    if (bend === null || bend < 0.94) {
      from.push(...point(a));
      to.push(...point(b));
    }
  }
  return { from: new Float32Array(from), to: new Float32Array(to) };
}
