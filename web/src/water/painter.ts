// Draws the picture: the runs at the moment that is shown, names over them, and the scale.
import type { App } from "../app.ts";
import { profileLines } from "../gauges/profiles.ts";
import { colours } from "../theme.ts";
import { length, niceBelow } from "../units.ts";
import type { Labels } from "./labels.ts";
import type { Choice } from "./particles.ts";
import type { Stage } from "./stage.ts";
import type { Staging } from "./staging.ts";
import type { WaterView } from "./view.ts";

export class Painter {
  /** What was drawn last is of its own moment. */
  whole = false;
  /** Of what was drawn last. */
  ids = "";

  constructor(
    private app: App,
    private view: WaterView,
    private staging: Staging,
    private labels: Labels,
    private scale: HTMLElement,
  ) {}

  draw(): void {
    const { app, view, staging } = this;
    const look = app.look.now;
    const theme = colours();
    view.paper(theme.paper);
    staging.sync(app.shown(), look, theme);
    this.whole = staging.shown.map((one) => this.show(one)).every((exact) => exact);
    this.ids = staging.shown.map(({ run }) => run.id).join();
    staging.section(look.section);
    view.time = app.player.time;
    view.draw();
    this.labels.sync(view, staging, look);
    this.measure();
    app.frameDrawn(this.whole);
  }

  /** Whether the frames of the moment itself were there. */
  private show({ run, stage }: Staging["shown"][number]): boolean {
    const { app, staging } = this;
    const look = app.look.now;
    const at = run.frames.at(app.player.time);
    stage.particles.points.visible = at !== null;
    stage.select(look.probe);
    stage.walls.mark(look.marked);
    if (!at) return false;
    stage.show(at, this.choice(stage));
    const limits = staging.colour(run, stage, at, look);
    if (run === staging.shown[0]!.run) app.setLimits(limits);
    stage.overlay(look.profiles ? profileLines(run, app.player.time) : []);
    return at.exact;
  }

  /** Of the particles those that are drawn: never finer than the picture's pixels, unless all are; null: all. */
  private choice(stage: Stage): Choice | null {
    const { effort, pixel } = this.view;
    const { section, size } = this.app.look.now;
    const { spacing, dimension } = stage.scene;
    if (effort.apart === 0) return null;
    const width = Math.max(effort.apart > 1 ? effort.apart * spacing : 0, pixel > spacing ? pixel : 0);
    const outside = dimension === 3 && !section && size >= 1; // smaller ones can be seen through
    return width > 0 || outside ? { width, outside } : null;
  }

  private measure(): void {
    const { beside, eye, cells } = this.view;
    const cell = cells[0];
    this.scale.hidden = !eye || !cell;
    if (!eye || !cell) return;
    const left = beside === null ? "" : `${beside + 14}px`;
    const holder = this.scale.parentElement!;
    if (holder.style.getPropertyValue("--free") !== left) holder.style.setProperty("--free", left);
    const metres = niceBelow((eye.span / cell.height) * Math.min(180, cell.width * 0.3));
    const width = `${((metres / eye.span) * cell.height).toFixed(1)}px`;
    if (this.scale.style.width === width && this.scale.textContent === length(metres)) return; // either costs a layout
    this.scale.style.width = width;
    this.scale.textContent = length(metres);
  }
}
