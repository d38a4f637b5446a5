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
  private moving = false; // the camera, by a hand, or the clock
  private later = 0;
  private handle = 0; // 0: the loop sleeps
  private clockedAt = -Infinity; // when the clock last stood elsewhere
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
    this.stops = [app.look.on(this.touch), app.data.on(this.news), app.player.on(this.clocked)];
    this.wake();
  }

  touch = (): void => {
    this.dirty = true;
    this.wake();
  };

  /** A hand has moved the camera. */
  moved(): void {
    this.moving = true;
    this.touch();
  }

  /** A clock that stands elsewhere again and again moves: it plays, or a hand drags it. */
  private clocked = (): void => {
    const now = performance.now();
    if (now - this.clockedAt < settling) this.moving = true;
    this.clockedAt = now;
    this.touch();
  };

  private wake(): void {
    if (this.handle) return;
    this.before = performance.now();
    this.handle = requestAnimationFrame(this.tick);
  }

  /** New data are drawn at once where they are waited for, else now and then: a frame for later changes nothing here. */
  private news = (): void => {
    const { painter } = this;
    const ids = this.app.shown().map((subject) => subject.id).join();
    if (!painter.whole || ids !== painter.ids) this.touch();
    else if (!this.later) this.later = window.setTimeout(() => ((this.later = 0), this.touch()), patience);
  };

  private tick = (now: number): void => {
    const { app, pace, before } = this;
    this.before = now;
    app.player.tick(Math.min(0.1, Math.max(0, now - before) / 1000));
    if (this.moving) this.movedAt = now;
    this.moving = false;
    const rests = now - this.movedAt > settling;
    if (rests && pace.rest()) this.dirty = true;
    if (this.dirty) {
      this.dirty = false;
      // The time to the next picture is the cost of this one only if the next was requested meanwhile.
      if (!rests) pace.moved(this.drawnAt === before ? Math.min(now - before, 1500) : undefined);
      this.drawnAt = now;
      this.view.effort = app.recording ? whole : pace.effort;
      this.painter.draw();
    }
    this.handle = rests && !app.player.playing && !this.dirty ? 0 : requestAnimationFrame(this.tick);
  };

  dispose(): void {
    cancelAnimationFrame(this.handle);
    clearTimeout(this.later);
    this.stops.forEach((stop) => stop());
  }
}
