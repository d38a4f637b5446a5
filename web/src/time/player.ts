// The clock: which moment of the runs is shown.

export const speeds = [0.02, 0.05, 0.1, 0.25, 0.5, 1, 2, 5, 10];

export class Player {
  time = 0;
  playing = false;
  /** Simulated seconds per second. */
  speed = 1;
  /** Stays at the newest frame of a run that goes on. */
  following = false;
  loop = false;
  private start = 0;
  private end = 0;
  private listeners = new Set<() => void>();

  get range(): [number, number] {
    return [this.start, this.end];
  }

  on(listener: () => void): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  private tell(): void {
    for (const listener of this.listeners) listener();
  }

  /** The times that there are. */
  extend(start: number, end: number): void {
    if (start === this.start && end === this.end) return;
    this.start = start;
    this.end = end;
    if (this.following) this.time = end;
    this.time = Math.min(end, Math.max(start, this.time));
    this.tell();
  }

  seek(time: number): void {
    this.following = false;
    this.time = Math.min(this.end, Math.max(this.start, time));
    this.tell();
  }

  follow(): void {
    this.following = true;
    this.playing = false;
    this.time = this.end;
    this.tell();
  }

  play(): void {
    if (this.time >= this.end) this.time = this.start;
    this.following = false;
    this.playing = true;
    this.tell();
  }

  pause(): void {
    this.playing = false;
    this.tell();
  }

  toggle(): void {
    if (this.playing) this.pause();
    else this.play();
  }

  setSpeed(speed: number): void {
    this.speed = speed;
    this.tell();
  }

  /** To the next faster (1) or slower (-1) of the speeds. */
  shift(by: 1 | -1): void {
    const sorted = by > 0 ? speeds : [...speeds].reverse();
    this.setSpeed(sorted.find((s) => (by > 0 ? s > this.speed : s < this.speed)) ?? this.speed);
  }

  setLoop(loop: boolean): void {
    this.loop = loop;
    this.tell();
  }

  /** `times`: of the frames, ascending; `by` frames on. */
  step(times: number[], by: number): void {
    if (times.length === 0) return;
    const slack = 1e-9 * Math.max(1, Math.abs(this.time));
    let place: number;
    if (by > 0) place = times.findIndex((t) => t > this.time + slack) + by - 1;
    else place = times.findLastIndex((t) => t < this.time - slack) + by + 1;
    if (by > 0 && place < by - 1) place = times.length - 1;
    this.playing = false;
    this.seek(times[Math.min(times.length - 1, Math.max(0, place))]!);
  }

  /** `seconds` have gone by on the wall. */
  tick(seconds: number): void {
    if (!this.playing) return;
    this.time += seconds * this.speed;
    if (this.time >= this.end) {
      if (this.loop && this.end > this.start) {
        this.time = this.start + ((this.time - this.start) % (this.end - this.start));
      } else {
        this.time = this.end;
        this.playing = false;
      }
    }
    this.tell();
  }
}
