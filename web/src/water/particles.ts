// The water as discs (2D) or shaded spheres (3D). The graphics card finds each particle between two frames, its value
// and its colour; the page uploads two blocks of integers per frame and nothing per picture.
import {
  BufferAttribute, BufferGeometry, DataTexture, FloatType, GLSL3, NearestFilter, Points, RawShaderMaterial, RedFormat, RGBAFormat,
  UnsignedByteType, Vector2, Vector3, Vector4, LinearFilter,
} from "three";
import { choose } from "../frames/choice.ts";
import { follow } from "../frames/pair.ts";
import { stride, type Frame } from "../frames/format.ts";
import { levelsOf } from "../frames/levels.ts";
import { table, type ColourMap } from "../colours.ts";
import { fragment, vertex } from "./particles.glsl.ts";

/** Of the particles one in each cell of a width, m (0: all); in 3D of those only that may be seen from outside. */
export interface Choice {
  width: number;
  outside: boolean;
}

/** Particles that stand for a cell are so much larger than it: they lie anywhere in theirs. */
const overlap = 1.25;

export type Quantity = "scalar0" | "scalar1" | "depth" | "own" | "plain";

export class ParticleMark {
  readonly points: Points<BufferGeometry, RawShaderMaterial>;
  readonly material: RawShaderMaterial;
  private shown: { a: Frame; b: Frame } | null = null;
  private chosen: { frame: Frame; choice: Choice } | null = null;
  private index = new BufferAttribute(new Uint32Array(0), 1);
  private capacity = -1; // so that even a moment without water allocates a buffer
  private levelsOf: Frame | null = null;

  /** `sizeAt`: which of the scalars is the size of each particle; -1: all have that of the spacing. */
  constructor(dim: 2 | 3, private spacing: number, private sizeAt: number, private up: { axis: number; sign: 1 | -1 }) {
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

  /** Shows the moment `share` of the way from frame `a` to frame `b`; of the particles those of a choice, or all. */
  show(a: Frame, b: Frame, share: number, choice: Choice | null): void {
    this.set("share", share);
    this.load(a, b);
    this.choose(a, choice);
  }

  /** Draws a choice from frame `a`; fewer ones as much larger. */
  private choose(a: Frame, choice: Choice | null): void {
    const geometry = this.points.geometry;
    this.set("larger", Math.max(1, (overlap * (choice?.width ?? 0)) / this.spacing));
    if (!choice) {
      geometry.setIndex(null);
      geometry.setDrawRange(0, a.count);
      this.chosen = null;
      return;
    }
    const { width, outside } = choice;
    if (this.chosen?.frame === a && this.chosen.choice.width === width && this.chosen.choice.outside === outside) return;
    const places = choose(a, this.spacing, width, outside);
    (this.index.array as Uint32Array).set(places);
    this.index.clearUpdateRanges();
    this.index.addUpdateRange(0, places.length);
    this.index.needsUpdate = true;
    geometry.setIndex(this.index);
    geometry.setDrawRange(0, places.length);
    this.chosen = { frame: a, choice };
  }

  private load(a: Frame, b: Frame): void {
    if (this.shown?.a === a && this.shown.b === b) return;
    const geometry = this.room(a.count);
    if (this.shown && this.shown.b === a && this.shown.a.ids === a.ids) {
      const first = geometry.getAttribute("a");
      geometry.setAttribute("a", geometry.getAttribute("b")); // "b" has the data of the next frame already
      geometry.setAttribute("b", first);
    } else {
      this.upload("a", a.data);
    }
    this.upload("b", follow(a, b));
    if (this.sizeAt >= 2 && this.shown?.a !== a) this.uploadSizes(a);
    this.shown = { a, b };
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
    (attribute.array as Float32Array).set(values);
    attribute.needsUpdate = true;
  }

  private room(count: number): BufferGeometry {
    if (count > this.capacity) {
      this.capacity = Math.ceil(1.2 * count) + 64;
      this.points.geometry.setIndex(this.index); // goes with it
      this.points.geometry.dispose();
      this.index = new BufferAttribute(new Uint32Array(this.capacity), 1);
      const geometry = (this.points.geometry = new BufferGeometry());
      for (const name of ["a", "b"]) geometry.setAttribute(name, new BufferAttribute(new Uint16Array(this.capacity * stride), stride, true));
      geometry.setAttribute("own", new BufferAttribute(new Float32Array(this.capacity), 1));
      geometry.setAttribute("grain", new BufferAttribute(new Float32Array(this.capacity).fill(1), 1));
      this.shown = this.chosen = null;
    }
    return this.points.geometry;
  }

  /** Sizes over the spacing. */
  private uploadSizes(frame: Frame): void {
    const bytes = frame.more[this.sizeAt - 2];
    const range = frame.scalars[this.sizeAt];
    if (!bytes || !range) return;
    const attribute = this.points.geometry.getAttribute("grain") as BufferAttribute;
    const sizes = attribute.array as Float32Array;
    for (let i = 0; i < bytes.length; ++i) sizes[i] = (range.low + (bytes[i]! / 255) * (range.high - range.low)) / this.spacing;
    attribute.needsUpdate = true;
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
