// When the picture is drawn: once for each picture of the screen in which something has changed, and not at all else.
import type { App } from "../app.ts";
import { Pace, type Effort } from "./pace.ts";
import type { Painter } from "./painter.ts";
import type { WaterView } from "./view.ts";

/** How long news that change nothing in the picture wait, and how long after a movement it is drawn whole, ms. */
const patience = 500;
const settling = 300;

/** In a film: all that there is. */
const whole: Effort = { sharpness: 1, apart: 0 };

export class Loop {
  private dirty = true;
  private moving = false; // the camera, by a hand
  private later = 0;
  private handle = 0;
  private movedAt = performance.now(); // the first picture must be quick, too
  private drawnAt = performance.now();
  private before = performance.now();
  private pace: Pace;
  private stops: (() => void)[];

  constructor(
    private app: App,
    private view: WaterView,
    private painter: Painter,
  ) {
    this.pace = new Pace(view.isSoftware);
    app.touch = this.touch;
    this.stops = [app.look.on(this.touch), app.data.on(this.news), app.player.on(this.touch)];
    this.handle = requestAnimationFrame(this.tick);
  }

  touch = (): void => {
    this.dirty = true;
  };

  /** A hand has moved the camera. */
  moved(): void {
    this.dirty = this.moving = true;
  }

  /** New data are drawn at once where they are waited for, else now and then: a frame for later changes nothing here. */
  private news = (): void => {
    const { painter } = this;
    const ids = this.app.shown().map((subject) => subject.id).join();
    if (!painter.whole || ids !== painter.ids) this.dirty = true;
    else if (!this.later) this.later = window.setTimeout(() => ((this.later = 0), (this.dirty = true)), patience);
  };

  private tick = (now: number): void => {
    this.handle = requestAnimationFrame(this.tick);
    const seconds = Math.min(0.1, (now - this.before) / 1000);
    this.before = now;
    this.app.player.tick(seconds);
    if (this.app.player.playing || this.moving) this.movedAt = now;
    this.moving = false;
    if (now - this.movedAt > settling && this.pace.rest()) this.dirty = true;
    if (!this.dirty) return;
    this.dirty = false;
    if (now - this.movedAt < settling) this.pace.moved(Math.min(now - this.drawnAt, 1500));
    this.drawnAt = now;
    this.view.effort = this.app.recording ? whole : this.pace.effort;
    this.painter.draw();
  };

  dispose(): void {
    cancelAnimationFrame(this.handle);
    clearTimeout(this.later);
    this.stops.forEach((stop) => stop());
  }
}
