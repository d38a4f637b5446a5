// How many particles are drawn while something moves: as many as make some 20 pictures a second, all as soon as it rests.

/** Slower than this, ms from picture to picture, half as many are drawn; faster than that, twice as many. */
const slow = 60;
const fast = 18;
const most = 16;
/** Pictures between two changes. */
const patience = 4;

export class Pace {
  oneIn = 1;
  private wanted = 1;
  private sum = 0;
  private n = 0;

  /** After a picture that came `milliseconds` after the one before, while something moves. */
  moved(milliseconds: number): void {
    this.oneIn = this.wanted;
    this.sum += milliseconds;
    if (++this.n < patience) return;
    const mean = this.sum / this.n;
    this.sum = this.n = 0;
    if (mean > slow) this.wanted = Math.min(most, this.wanted * 2);
    else if (mean < fast) this.wanted = Math.max(1, this.wanted / 2);
    this.oneIn = this.wanted;
  }

  /** Nothing moves: everything is drawn. Returns whether that is new. */
  rest(): boolean {
    const was = this.oneIn;
    this.oneIn = 1;
    this.sum = this.n = 0;
    return was !== 1;
  }
}
