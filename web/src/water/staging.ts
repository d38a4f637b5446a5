// Runs on stage and their look: keeps the stages of the view in step with the choice of the user.
import { Color, Vector2, Vector4 } from "three";
import { series } from "../colours.ts";
import type { Subject } from "../run/subject.ts";
import type { Look } from "../store.ts";
import type { Theme } from "../theme.ts";
import type { Frame } from "../frames/format.ts";
import { Stage } from "./stage.ts";
import { origins, quantity, spread, valuesOf } from "./value.ts";
import type { WaterView } from "./view.ts";

/** Particles whose values are looked at for one picture, beside those that are shown: they take a few ms. */
const most = 2e6;

export class Staging {
  shown: { run: Subject; stage: Stage }[] = [];
  private key = "";
  private lookKey = "";
  private spreads = new WeakMap<Subject, { by: Map<string, [number, number]>; seen: WeakMap<Frame, Set<string>> }>();
  private ownOf = new WeakMap<Stage, { frame: Frame; colouring: Look["colouring"] }>();

  constructor(private view: WaterView) {}

  sync(runs: Subject[], look: Look, theme: Theme): void {
    const key = runs.map((run) => run.id).join(" ") + look.layout;
    if (key !== this.key) {
      const before = this.shown;
      this.shown = runs.map((run) => before.find((s) => s.run === run) ?? { run, stage: new Stage(run.scene) });
      for (const old of before) if (!this.shown.includes(old)) old.stage.dispose();
      this.view.set(this.shown.map((s) => s.stage), look.layout === "over");
      this.key = key;
      this.lookKey = "";
    }
    const lookKey = JSON.stringify([look, theme]);
    if (lookKey === this.lookKey) return;
    this.lookKey = lookKey;
    const over = look.layout === "over" && runs.length > 1;
    this.shown.forEach(({ run, stage }, i) => {
      stage.colours(theme);
      stage.walls.group.visible = look.walls;
      stage.asSurface(look.water === "surface" && !over);
      const mark = stage.particles;
      mark.colours(look.map);
      mark.colourBy(over ? "plain" : quantity(run, look.colouring));
      mark.set("radius", 0.5 * run.scene.spacing * look.size * (run.scene.dimension === 2 ? 1.46 : 1.1));
      const tint = new Color(over ? series[look.theme][i % 6] : theme.water).convertLinearToSRGB();
      mark.set("tint", new Vector4(tint.r, tint.g, tint.b, 0));
      mark.set("opacity", over && i > 0 ? 0.55 : 1);
    });
  }

  /** Limits of the colours, and what is uploaded only for some of them. */
  colour(run: Subject, stage: Stage, at: { a: Frame }, look: Look): [number, number] {
    const limits = this.limits(run, stage, at.a, look);
    stage.particles.set("limits", new Vector2(...limits));
    const { colouring } = look;
    const known = this.ownOf.get(stage);
    if (quantity(run, colouring) === "own" && (known?.frame !== at.a || known.colouring !== colouring)) {
      const first = run.frames.frame(0) ?? at.a;
      const byAge = run.scene.inlets.length > 0;
      stage.particles.own(colouring === "origin" ? origins(first, at.a, stage.up.axis === 0 ? 1 : 0, byAge) : valuesOf(run, at.a, colouring));
      this.ownOf.set(stage, { frame: at.a, colouring });
    }
    return limits;
  }

  limits(run: Subject, stage: Stage, frame: Frame, look: Look): [number, number] {
    const { colouring } = look;
    if (colouring === "origin" || colouring === "plain") return [0, 1];
    const fixed = look.limits[colouring];
    if (fixed) return fixed;
    if (look.momentary) return spread(run, frame, colouring, stage.up);
    const known = this.spreads.get(run) ?? { by: new Map<string, [number, number]>(), seen: new WeakMap<Frame, Set<string>>() };
    this.spreads.set(run, known);
    const take = (one: Frame): boolean => {
      const seen = known.seen.get(one) ?? new Set();
      if (seen.has(colouring)) return false;
      known.seen.set(one, seen.add(colouring));
      const [low, high] = spread(run, one, colouring, stage.up);
      const [l, h] = known.by.get(colouring) ?? [low, high];
      known.by.set(colouring, [Math.min(l, low), Math.max(h, high)]);
      return true;
    };
    take(frame);
    // All frames that are available, so that colours mean the same from the first on; some of them at a time.
    const { list } = run.frames;
    for (let place = 0, room = most; colouring !== "depth" && place < list.length && room > 0; ++place) {
      const other = run.frames.frame(place);
      if (other && take(other)) room -= other.count;
    }
    const [low, high] = known.by.get(colouring)!;
    return [colouring === "speed" ? 0 : low, high];
  }

  section(cut: Look["section"]): void {
    for (const { stage } of this.shown) {
      if (!cut || stage.scene.dimension === 2) {
        stage.section(new Vector4(0, 0, 0, 1), 1e9);
        continue;
      }
      const { min, max } = stage.bounds();
      const x = min[cut.axis]! + cut.share * (max[cut.axis]! - min[cut.axis]!);
      const sign = cut.flip ? -1 : 1;
      const plane = new Vector4(0, 0, 0, -sign * x).setComponent(cut.axis, sign);
      stage.section(plane, cut.slice ? 2 * stage.scene.spacing : 1e9);
    }
  }

  dispose(): void {
    for (const { stage } of this.shown) stage.dispose();
  }
}
