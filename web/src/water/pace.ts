// How the picture is drawn while something moves: as well as is quick enough. When it rests, everything is drawn sharply.

/** How well: pixels of the picture per pixel of the screen, along each side; and of the particles all (0), those that may
 * be seen (1), or of these one in each cell of so many spacings. */
export interface Effort {
  sharpness: number;
  apart: number;
}

const efforts: Effort[] = [
  { sharpness: 1, apart: 0 },
  { sharpness: 0.5, apart: 1 },
  { sharpness: 0.5, apart: 1.6 },
  { sharpness: 0.5, apart: 2.5 },
  { sharpness: 0.5, apart: 4 },
];

/** ms from picture to picture: above the first, less is done; below the second, more is tried now and then. */
const slow = 60;
const fast = 18;
/** The same for the first step where the browser draws without a graphics card: it need not look as if it were slow. */
const slowInSoftware = 20;
/** Pictures between two changes, and at first until more is tried. */
const patience = 4;
const firstTrial = 30;

export class Pace {
  private level = 0;
  private resting = false;
  private sum = 0;
  private n = 0;
  private since = 0;
  private trial = firstTrial;

  /** `software`: the browser draws without a graphics card. */
  constructor(private software: boolean) {}

  /** What is drawn now. A still is smooth: with a graphics card by its own means, else by twice as many pixels. */
  get effort(): Effort {
    return this.resting ? { sharpness: this.software ? 2 : 1, apart: 0 } : efforts[this.level]!;
  }

  /** After a picture that came `milliseconds` after the one before, while something moves; undefined: that is not known. */
  moved(milliseconds?: number): void {
    this.resting = false;
    if (milliseconds === undefined) return;
    this.sum += milliseconds;
    ++this.since;
    if (++this.n < patience) return;
    const mean = this.sum / this.n;
    this.sum = this.n = 0;
    if (mean > (this.software && this.level === 0 ? slowInSoftware : slow) && this.level + 1 < efforts.length) {
      if (this.since < 2 * patience) this.trial *= 2; // it was too much again
      this.change(1);
    } else if (mean < fast && this.since > this.trial && this.level > 0) {
      this.change(-1);
    }
  }

  private change(by: number): void {
    this.level += by;
    this.since = 0;
  }

  /** Nothing moves. Returns whether that is new. */
  rest(): boolean {
    const was = this.resting;
    this.resting = true;
    this.sum = this.n = this.since = 0;
    return !was;
  }
}
