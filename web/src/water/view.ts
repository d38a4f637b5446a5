// The picture: stages in one canvas, side by side or one over the other, seen by one camera.
import { Color, Vector4, WebGLRenderer } from "three";
import { bestColumns } from "./columns.ts";
import { Eye } from "./eye.ts";
import type { Effort } from "./pace.ts";
import type { Stage } from "./stage.ts";

/** CSS pixels. */
const legendAndScale = 430;

export interface Cell {
  stages: Stage[];
  /** In the canvas, CSS pixels from its upper left corner. */
  x: number;
  y: number;
  width: number;
  height: number;
}

/** By the name of what draws: browsers give such a context to whoever refuses it with failIfMajorPerformanceCaveat, too. */
function drawnBySoftware(): boolean {
  const probe = document.createElement("canvas").getContext("webgl2");
  if (!probe) return false;
  const names = probe.getExtension("WEBGL_debug_renderer_info");
  const name = String(probe.getParameter(names?.UNMASKED_RENDERER_WEBGL ?? probe.RENDERER));
  probe.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}

export class WaterView {
  readonly renderer: WebGLRenderer;
  eye: Eye | null = null;
  cells: Cell[] = [];
  /** Where the last row of pictures ends and leaves room for legend and scale, CSS pixels; null: it leaves none. */
  beside: number | null = null;
  /** The moment that is shown, s. */
  time = 0;
  /** The browser draws without a graphics card. */
  readonly isSoftware = drawnBySoftware();
  /** The camera has not been moved: it may follow the size of the window. */
  untouched = true;
  private stages: Stage[] = [];
  private over = false;
  private size = { width: 1, height: 1, ratio: 1 };
  private present: Effort = { sharpness: 1, apart: 0 };
  private background = new Color("#fff");

  constructor(readonly canvas: HTMLCanvasElement) {
    this.renderer = new WebGLRenderer({ canvas, antialias: !this.isSoftware, alpha: false, preserveDrawingBuffer: true, powerPreference: "high-performance" });
    this.renderer.autoClear = false;
    this.renderer.info.autoReset = false;
  }

  paper(css: string): void {
    this.background.set(css);
  }

  /** The camera is made for the first stages and stays; it is placed anew only by fit(). */
  set(stages: Stage[], over: boolean): void {
    this.stages = stages;
    this.over = over;
    const first = stages[0];
    const isNew = first !== undefined && this.eye?.dim !== first.scene.dimension;
    if (isNew) this.eye = new Eye(first.scene.dimension, first.scene.gravity);
    this.arrange();
    if (isNew || this.untouched) this.fit();
  }

  resize(width: number, height: number, ratio: number): void {
    this.size = { width: Math.max(1, width), height: Math.max(1, height), ratio };
    this.sharpen();
    this.arrange();
    if (this.untouched) this.fit();
  }

  get effort(): Effort {
    return this.present;
  }

  set effort(effort: Effort) {
    const before = this.present;
    this.present = effort;
    if (effort.sharpness !== before.sharpness) this.sharpen();
  }

  /** Pixels of the picture per pixel of the page. */
  private get ratio(): number {
    return this.size.ratio * this.present.sharpness;
  }

  private sharpen(): void {
    this.renderer.setPixelRatio(this.ratio);
    this.renderer.setSize(this.size.width, this.size.height, false);
  }

  /** How wide a pixel of the picture is, m; of a perspective 0. */
  get pixel(): number {
    const cell = this.cells[0];
    return cell && this.eye?.dim === 2 ? this.eye.span / (cell.height * this.ratio) : 0;
  }

  get aspect(): number {
    const cell = this.cells[0];
    return cell ? cell.width / cell.height : 1;
  }

  fit(): void {
    if (!this.eye || this.stages.length === 0) return;
    const boxes = this.stages.map((stage) => stage.bounds());
    const min = boxes[0]!.min.map((_, d) => Math.min(...boxes.map((b) => b.min[d]!)));
    const max = boxes[0]!.max.map((_, d) => Math.max(...boxes.map((b) => b.max[d]!)));
    const below = this.cells.length === 1 ? this.strip / this.size.height : 0;
    this.eye.fit(min, max, this.aspect, below);
    this.untouched = true;
  }

  private arrange(): void {
    const { width, height } = this.size;
    const n = this.over ? 1 : Math.max(1, this.stages.length);
    const columns = bestColumns(n, width / height, this.shape());
    const rows = Math.ceil(n / columns);
    const filled = ((n - 1) % columns) + 1; // of the last row
    const room = width * (1 - filled / columns);
    this.beside = room > legendAndScale ? width - room : null;
    const high = n > 1 && this.beside === null ? height - this.strip : height;
    this.cells = Array.from({ length: n }, (_, i) => ({
      stages: this.over ? this.stages : this.stages.slice(i, i + 1),
      x: (i % columns) * (width / columns),
      y: Math.floor(i / columns) * (high / rows),
      width: width / columns,
      height: high / rows,
    }));
  }

  /** What stays free for the legend below one picture, and below several where it has no room beside them, CSS pixels. */
  private get strip(): number {
    return Math.min(86, 0.3 * this.size.height);
  }

  /** Width over height of what there is to see. */
  private shape(): number {
    const box = this.stages[0]?.bounds();
    if (!box || this.stages[0]!.scene.dimension === 3) return 1.5;
    return (box.max[0]! - box.min[0]!) / Math.max(1e-9, box.max[1]! - box.min[1]!);
  }

  draw(): void {
    const { renderer, eye, ratio } = this;
    const { width, height } = this.size;
    renderer.setScissorTest(false);
    renderer.setViewport(0, 0, width, height);
    renderer.setClearColor(this.background);
    renderer.clear();
    if (!eye) return;
    renderer.setScissorTest(this.cells.length > 1);
    for (const cell of this.cells) {
      eye.apply(cell.width / cell.height);
      const y = height - cell.y - cell.height;
      const scale = (eye.camera.projectionMatrix.elements[5]! * cell.height * ratio) / 2;
      for (const stage of cell.stages) {
        stage.particles.set("pixels", scale);
        if (!stage.surface?.mesh.visible) continue;
        stage.surface.prepare(renderer, eye.camera, { x: cell.x * ratio, y: y * ratio, width: cell.width * ratio, height: cell.height * ratio });
        renderer.setScissorTest(this.cells.length > 1);
      }
      renderer.setViewport(cell.x, y, cell.width, cell.height);
      renderer.setScissor(cell.x, y, cell.width, cell.height);
      for (const stage of cell.stages) {
        stage.picture(cell.width, cell.height);
        renderer.render(stage.scene3, eye.camera);
      }
    }
  }

  section(plane: Vector4, thickness: number): void {
    for (const stage of this.stages) stage.section(plane, thickness);
  }

  dispose(): void {
    this.renderer.dispose();
  }
}
