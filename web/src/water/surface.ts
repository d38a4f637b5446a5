// The surface of the water in 3D, made in the picture (van der Laan, Green and Sainz, I3D 2009): the spheres' depth is
// drawn into a texture, smoothed there but not across edges, and lit by the slopes of the result.
import {
  BufferAttribute, BufferGeometry, FloatType, GLSL3, Mesh, NearestFilter, PerspectiveCamera, Points, RawShaderMaterial, RGBAFormat, Scene, Vector2, Vector3,
  WebGLRenderTarget, type Camera, type WebGLRenderer,
} from "three";
import { vertex as particleVertex } from "./particles.glsl.ts";
import type { ParticleMark } from "./particles.ts";
import { compose, depth, full, smooth } from "./surface.glsl.ts";

/** How far the smoothing reaches, in spacings, and how often it is done. */
const reach = 1.6;
const rounds = 2;

const screen = () => {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]), 3));
  return geometry;
};

export class SurfaceMark {
  /** Drawn with the rest of the stage, in the place of the particles. */
  readonly mesh: Mesh<BufferGeometry, RawShaderMaterial>;
  private spheres: Points<BufferGeometry, RawShaderMaterial>;
  private spheresScene = new Scene();
  private smoother: Mesh<BufferGeometry, RawShaderMaterial>;
  private smootherScene = new Scene();
  private targets: WebGLRenderTarget[];

  constructor(private particles: ParticleMark, spacing: number) {
    const target = (count: number) => new WebGLRenderTarget(1, 1, { type: FloatType, format: RGBAFormat, minFilter: NearestFilter, magFilter: NearestFilter, count, depthBuffer: count > 1 });
    this.targets = [target(2), target(1), target(1)];
    this.spheres = new Points(
      particles.points.geometry,
      new RawShaderMaterial({ glslVersion: GLSL3, vertexShader: particleVertex, fragmentShader: depth, defines: { DIM: 3 }, uniforms: particles.material.uniforms }),
    );
    this.spheres.frustumCulled = false;
    this.spheresScene.add(this.spheres);
    this.smoother = new Mesh(
      screen(),
      new RawShaderMaterial({
        glslVersion: GLSL3, vertexShader: full, fragmentShader: smooth, depthTest: false, depthWrite: false,
        uniforms: { from: { value: null }, along: { value: new Vector2() }, pixels: { value: 1 }, spacing: { value: spacing }, reach: { value: reach } },
      }),
    );
    this.smoother.frustumCulled = false;
    this.smootherScene.add(this.smoother);
    this.mesh = new Mesh(
      screen(),
      new RawShaderMaterial({
        glslVersion: GLSL3, vertexShader: full, fragmentShader: compose,
        uniforms: { depths: { value: null }, colours: { value: null }, corner: { value: new Vector2() }, ends: { value: new Vector2() }, size: { value: new Vector2() }, origin: { value: new Vector2() }, up: { value: new Vector3(0, 1, 0) } },
      }),
    );
    this.mesh.frustumCulled = false;
    this.mesh.visible = false;
  }

  /** Draws and smooths the depths for a picture of this size, in pixels of the screen, whose lower left corner is at x, y. */
  prepare(renderer: WebGLRenderer, camera: Camera, at: { x: number; y: number; width: number; height: number }): void {
    if (!(camera instanceof PerspectiveCamera)) return;
    const [width, height] = [Math.max(1, Math.round(at.width)), Math.max(1, Math.round(at.height))];
    const [first, second, third] = this.targets as [WebGLRenderTarget, WebGLRenderTarget, WebGLRenderTarget];
    for (const target of this.targets) target.setSize(width, height);
    this.spheres.geometry = this.particles.points.geometry;
    const uniforms = this.particles.material.uniforms;
    const radius = uniforms["radius"]!.value as number;
    uniforms["radius"]!.value = 1.3 * radius; // spheres must overlap to be a surface
    this.draw(renderer, first, this.spheresScene, camera);
    uniforms["radius"]!.value = radius;
    const u = this.smoother.material.uniforms;
    u["pixels"]!.value = (camera.projectionMatrix.elements[5]! * height) / 2;
    let from = first.textures[0]!;
    for (let round = 0; round < rounds; ++round) {
      for (const [to, x, y] of [[second, 1, 0], [third, 0, 1]] as const) {
        u["from"]!.value = from;
        (u["along"]!.value as Vector2).set(x, y);
        this.draw(renderer, to, this.smootherScene, camera);
        from = to.texture;
      }
    }
    u["from"]!.value = from;
    (u["along"]!.value as Vector2).set(1, 1);
    this.draw(renderer, second, this.smootherScene, camera);
    from = second.texture;
    renderer.setRenderTarget(null);
    const c = this.mesh.material.uniforms;
    c["depths"]!.value = from;
    c["colours"]!.value = first.textures[1]!;
    (c["corner"]!.value as Vector2).set(1 / camera.projectionMatrix.elements[0]!, 1 / camera.projectionMatrix.elements[5]!);
    (c["ends"]!.value as Vector2).set(camera.near, camera.far);
    (c["size"]!.value as Vector2).set(width, height);
    (c["origin"]!.value as Vector2).set(at.x, at.y);
    (c["up"]!.value as Vector3).copy(camera.up).transformDirection(camera.matrixWorldInverse);
  }

  private draw(renderer: WebGLRenderer, target: WebGLRenderTarget, scene: Scene, camera: Camera): void {
    renderer.setRenderTarget(target);
    renderer.setScissorTest(false);
    const alpha = renderer.getClearAlpha();
    renderer.setClearAlpha(0);
    renderer.clear();
    renderer.setClearAlpha(alpha);
    renderer.render(scene, camera);
  }

  dispose(): void {
    for (const target of this.targets) target.dispose();
    for (const part of [this.spheres, this.smoother, this.mesh]) part.material.dispose();
    this.smoother.geometry.dispose();
    this.mesh.geometry.dispose();
  }
}
