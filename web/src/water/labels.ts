// Names in the picture. Those of probes are buttons: a click, or the tab and enter keys, light up their plots.
import type { Scene } from "../contract.ts";
import type { Look } from "../store.ts";
import type { Staging } from "./staging.ts";
import type { WaterView } from "./view.ts";

interface Label {
  element: HTMLElement;
  point: number[];
  /** Which pose moves it; null: none. */
  moving: number | null;
  probe: string | null;
  width: number;
}

export class Labels {
  private labels: { cell: number; list: Label[] }[] = [];
  private key = "";
  private places: { probe: string; x: number; y: number }[] = [];

  constructor(private holder: HTMLElement, private pick: (name: string, isProbe: boolean) => void) {}

  sync(view: WaterView, staging: Staging, look: Look): void {
    const key = staging.shown.map((s) => s.run.id).join(" ") + look.layout + String(look.labels);
    if (key !== this.key) {
      this.key = key;
      this.build(view, staging, look);
    }
    this.places = [];
    const taken: { x: number; y: number; w: number }[] = [];
    for (const { cell: index, list } of this.labels) {
      const cell = view.cells[index];
      if (!cell || !view.eye) continue;
      view.eye.apply(cell.width / cell.height);
      for (const label of list) {
        const at = view.eye.project(label.moving === null ? label.point : (staging.shown[index]?.stage.walls.moved(label.moving, label.point) ?? label.point));
        const placeX = at ? cell.x + ((at.x + 1) * cell.width) / 2 : 0;
        const placeY = at ? cell.y + ((1 - at.y) * cell.height) / 2 : 0;
        const half = label.width / 2;
        const x = Math.max(cell.x + half, Math.min(cell.x + cell.width - half, placeX)); // no name is cut off
        let y = placeY;
        const visible = at !== null && Math.abs(at.x) <= 1 && Math.abs(at.y) <= 1;
        label.element.style.visibility = visible ? "visible" : "hidden";
        if (!visible) continue;
        if (label.probe) this.places.push({ probe: label.probe, x: placeX, y: placeY });
        // Names that would lie on each other move up, a few lines at most.
        for (let tries = 0; tries < 5; ++tries) {
          const w = label.width;
          if (!taken.some((t) => Math.abs(t.x - x) < (t.w + w) / 2 && Math.abs(t.y - y) < 19)) break;
          y -= 19;
        }
        taken.push({ x, y, w: label.width });
        label.element.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translate(-50%, -100%)`;
        label.element.style.setProperty("--from", `${(placeX - x).toFixed(1)}px`); // the dot stays where the probe is
        label.element.style.setProperty("--below", `${(placeY - y).toFixed(1)}px`);
        const pressed = String(label.probe === look.probe);
        if (label.probe && label.element.ariaPressed !== pressed) label.element.ariaPressed = pressed;
      }
    }
  }

  /** The probe whose mark is within reach of a click. */
  probeNear(x: number, y: number): string | null {
    let best: string | null = null;
    let closest = 14;
    for (const place of this.places) {
      const distance = Math.hypot(place.x - x, place.y - y);
      if (distance < closest) {
        closest = distance;
        best = place.probe;
      }
    }
    return best;
  }

  private build(view: WaterView, staging: Staging, look: Look): void {
    this.holder.replaceChildren();
    const over = look.layout === "over";
    this.labels = [];
    const runs = over ? staging.shown.slice(0, 1) : staging.shown;
    runs.forEach(({ run }, cell) => {
      const list = look.labels ? this.ofScene(run.scene, run.id.startsWith("case-")) : [];
      this.labels.push({ cell, list });
      for (const { element } of list) this.holder.append(element);
      if (staging.shown.length > 1) {
        const where = view.cells[cell]!;
        const title = document.createElement("div");
        title.className = "run-name";
        title.textContent = over ? staging.shown.map((s) => s.run.name).join("  ·  ") : run.name;
        title.style.transform = `translate(${where.x + 12}px, ${where.y + 10}px)`;
        this.holder.append(title);
      }
      for (const label of list) label.width = label.element.offsetWidth + 4;
    });
  }

  private ofScene(scene: Scene, isCase: boolean): Label[] {
    const list: Label[] = [];
    const add = (name: string, role: string, point: number[] | undefined, probe: string | null = null, moving: number | null = null) => {
      if (!point) return;
      const element = document.createElement(probe || isCase ? "button" : "div");
      element.className = `label ${role}`;
      element.textContent = name;
      if (probe) element.title = `Show the plot of ${probe}`;
      element.addEventListener("click", () => this.pick(name, probe !== null));
      list.push({ element, point, moving, probe, width: 0 });
    };
    for (const probe of scene.probes) add(probe.name, "probe", middle(probe.points), probe.name);
    for (const end of [...scene.inlets, ...scene.outlets]) add(end.name, "open", middle(end.corners ?? [end.from, end.to].filter((p) => p !== undefined)));
    for (const place of [...scene.vents, ...(isCase ? scene.pockets : [])]) add(place.name, "open", place.at);
    for (const wall of scene.walls) {
      if (wall.kind === "wall" && !isCase) continue;
      const point = wall.polylines ? ofLongest(wall.polylines) : centre(wall.triangles?.positions ?? []);
      add(wall.name, wall.kind, point, null, wall.moving ?? null);
    }
    return list;
  }
}

function middle(points: number[][]): number[] | undefined {
  if (points.length === 0) return undefined;
  return points[0]!.map((_, d) => points.reduce((sum, p) => sum + p[d]!, 0) / points.length);
}

/** The middle of the longest segment. */
function ofLongest(lines: number[][][]): number[] | undefined {
  let best: number[] | undefined;
  let longest = 0;
  for (const line of lines) {
    for (let i = 0; i + 1 < line.length; ++i) {
      const [p, q] = [line[i]!, line[i + 1]!];
      const size = Math.hypot(q[0]! - p[0]!, q[1]! - p[1]!);
      if (size > longest) {
        longest = size;
        best = middle([p, q]);
      }
    }
  }
  return best;
}

function centre(positions: number[]): number[] | undefined {
  const n = positions.length / 3;
  return n > 0 ? [0, 1, 2].map((d) => positions.reduce((sum, x, i) => (i % 3 === d ? sum + x : sum), 0) / n) : undefined;
}
