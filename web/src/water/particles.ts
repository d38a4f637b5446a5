// The water as discs (2D) or shaded spheres (3D). The graphics card finds each particle between two frames, its value
// and its colour; the page uploads two blocks of integers per frame and nothing per picture.
import {
  BufferAttribute, BufferGeometry, DataTexture, FloatType, GLSL3, NearestFilter, Points, RawShaderMaterial, RedFormat, RGBAFormat,
  UnsignedByteType, Vector2, Vector3, Vector4, LinearFilter,
} from "three";
import { follow } from "../frames/pair.ts";
import { stride, type Frame } from "../frames/format.ts";
import { levelsOf } from "../frames/levels.ts";
import { table, type ColourMap } from "../colours.ts";
import { fragment, vertex } from "./particles.glsl.ts";

export type Quantity = "scalar0" | "scalar1" | "depth" | "own" | "plain";

export class ParticleMark {
  readonly points: Points<BufferGeometry, RawShaderMaterial>;
  readonly material: RawShaderMaterial;
  private shown: { a: Frame; b: Frame; oneIn: number } | null = null;
  private capacity = 0;
  private levelsOf: Frame | null = null;

  constructor(private dim: 2 | 3, private spacing: number, private up: { axis: number; sign: 1 | -1 }) {
    const map = new DataTexture(table("water") as Uint8Array<ArrayBuffer>, 256, 1, RGBAFormat, UnsignedByteType);
    map.magFilter = map.minFilter = LinearFilter;
    map.needsUpdate = true;
    this.material = new RawShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: vertex,
      fragmentShader: fragment,
      defines: { DIM: dim },
      uniforms: {
        share: { value: 0 },
        minA: { value: new Vector3() }, sizeA: { value: new Vector3() }, minB: { value: new Vector3() }, sizeB: { value: new Vector3() },
        rangeA: { value: new Vector4() }, rangeB: { value: new Vector4() },
        quantity: { value: 1 }, limits: { value: new Vector2(0, 1) }, map: { value: map },
        levels: { value: null }, levelGrid: { value: new Vector4() }, levelOrigin: { value: new Vector2() },
        up: { value: new Vector4(0, 0, 0, up.sign).setComponent(up.axis, up.sign) }, upAxis: { value: up.axis },
        radius: { value: 0.5 * spacing }, larger: { value: 1 }, pixels: { value: 1 }, smallest: { value: 1.5 },
        plane: { value: new Vector4(0, 0, 0, 1) }, thickness: { value: 1e9 },
        tint: { value: new Vector4(0, 0, 0, 0) }, opacity: { value: 1 },
      },
      transparent: dim === 2,
      depthTest: dim === 3,
      depthWrite: dim === 3,
    });
    this.points = new Points(new BufferGeometry(), this.material);
    this.points.frustumCulled = false;
  }

  set(name: string, value: unknown): void {
    this.material.uniforms[name]!.value = value;
  }

  colours(map: ColourMap): void {
    const texture = this.material.uniforms["map"]!.value as DataTexture;
    (texture.image.data as Uint8Array).set(table(map));
    texture.needsUpdate = true;
  }

  /** Shows the moment `share` of the way from frame `a` to frame `b`; of the particles one in `oneIn`, as much larger. */
  show(a: Frame, b: Frame, share: number, oneIn: number): void {
    this.set("share", share);
    if (this.shown?.a === a && this.shown.b === b && this.shown.oneIn === oneIn) return;
    const count = Math.ceil(a.count / oneIn);
    const geometry = this.room(count);
    this.set("larger", oneIn ** (1 / this.dim));
    if (this.shown && this.shown.b === a && this.shown.a.ids === a.ids && this.shown.oneIn === oneIn) {
      const first = geometry.getAttribute("a");
      geometry.setAttribute("a", geometry.getAttribute("b")); // what was next is here already
      geometry.setAttribute("b", first);
    } else {
      this.upload("a", thinned(a.data, oneIn));
    }
    this.upload("b", thinned(follow(a, b), oneIn));
    geometry.setDrawRange(0, count);
    this.shown = { a, b, oneIn };
    const u = this.material.uniforms;
    const box = (frame: Frame, min: string, size: string, range: string) => {
      const at = (list: number[], d: number) => list[d] ?? 0;
      (u[min]!.value as Vector3).set(at(frame.boxMin, 0), at(frame.boxMin, 1), at(frame.boxMin, 2));
      (u[size]!.value as Vector3).set(at(frame.boxMax, 0), at(frame.boxMax, 1), at(frame.boxMax, 2)).sub(u[min]!.value as Vector3);
      const [s, t] = frame.scalars;
      (u[range]!.value as Vector4).set(s?.low ?? 0, s?.high ?? 1, t?.low ?? 0, t?.high ?? 1);
    };
    box(a, "minA", "sizeA", "rangeA");
    box(b, "minB", "sizeB", "rangeB");
    if (u["quantity"]!.value === 2) this.uploadLevels(a);
  }

  colourBy(quantity: Quantity): void {
    this.set("quantity", ["scalar0", "scalar1", "depth", "own", "plain"].indexOf(quantity));
    if (quantity === "depth" && this.shown) this.uploadLevels(this.shown.a);
  }

  /** A value of each particle's own, 0 to 1, in the order of the frame that is shown. */
  own(values: Float32Array): void {
    const attribute = this.points.geometry.getAttribute("own") as BufferAttribute;
    const oneIn = this.shown?.oneIn ?? 1;
    for (let i = 0, j = 0; i < values.length && j < this.capacity; i += oneIn, ++j) (attribute.array as Float32Array)[j] = values[i]!;
    attribute.needsUpdate = true;
  }

  private room(count: number): BufferGeometry {
    if (count > this.capacity) {
      this.capacity = Math.ceil(1.2 * count) + 64;
      this.points.geometry.dispose();
      const geometry = (this.points.geometry = new BufferGeometry());
      for (const name of ["a", "b"]) geometry.setAttribute(name, new BufferAttribute(new Uint16Array(this.capacity * stride), stride, true));
      geometry.setAttribute("own", new BufferAttribute(new Float32Array(this.capacity), 1));
      this.shown = null;
    }
    return this.points.geometry;
  }

  private upload(name: string, data: Uint16Array): void {
    const attribute = this.points.geometry.getAttribute(name) as BufferAttribute;
    (attribute.array as Uint16Array).set(data);
    attribute.clearUpdateRanges();
    attribute.addUpdateRange(0, data.length);
    attribute.needsUpdate = true;
  }

  private uploadLevels(frame: Frame): void {
    if (this.levelsOf === frame) return;
    this.levelsOf = frame;
    const { counts, origin, width, top } = levelsOf(frame, this.up, this.spacing);
    const u = this.material.uniforms;
    (u["levels"]!.value as DataTexture | null)?.dispose();
    const texture = new DataTexture(top as Float32Array<ArrayBuffer>, counts[0], counts[1] ?? 1, RedFormat, FloatType);
    texture.magFilter = texture.minFilter = NearestFilter;
    texture.needsUpdate = true;
    u["levels"]!.value = texture;
    (u["levelGrid"]!.value as Vector4).set(counts[0]!, counts[1] ?? 1, width, 0);
    (u["levelOrigin"]!.value as Vector2).set(origin[0]!, origin[1] ?? 0);
  }

  dispose(): void {
    this.points.geometry.dispose();
    this.material.dispose();
    for (const name of ["map", "levels"]) (this.material.uniforms[name]!.value as DataTexture | null)?.dispose();
  }
}

/** Every `oneIn`th particle of a block. */
function thinned(data: Uint16Array, oneIn: number): Uint16Array {
  if (oneIn === 1) return data;
  const out = new Uint16Array(Math.ceil(data.length / stride / oneIn) * stride);
  for (let i = 0, j = 0; i < data.length; i += stride * oneIn, j += stride) for (let c = 0; c < stride; ++c) out[j + c] = data[i + c]!;
  return out;
}
