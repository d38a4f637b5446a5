// A window of decoded frames around the time that is shown. A caller that asks for a missing frame gets the
// nearest decoded one at once, never nothing, and is notified when the right one has come.
import type { Source, FrameEntry } from "../source.ts";
import type { Frame } from "./format.ts";
import type { Order, Reply } from "./worker.ts";
import { bracket } from "./bracket.ts";

/** Bytes of decoded frames that are kept, of a run. */
const budget = 384e6;

export class FrameWindow {
  readonly list: FrameEntry[] = [];
  private decoded = new Map<number, Frame>();
  private ids: Float64Array | null = null;
  private reached = -1; // place in `list` that the decoder reached
  private sent = -1; // place that was sent last
  private wanted = 0;
  private busy = false;
  private generation = 0;
  /** A frame was gone when it was asked for: nothing is asked until there is news of the run. */
  private halted = false;
  error = "";
  /** How long the worker took for each of the last frames, ms. */
  readonly milliseconds: number[] = [];

  constructor(
    private run: string,
    private source: Source,
    private worker: DecodeWorker,
    private changed: () => void,
  ) {}

  get times(): number[] {
    return this.list.map((entry) => entry.time);
  }

  add(entries: FrameEntry[]): void {
    for (const entry of entries) {
      const last = this.list.at(-1);
      if (!last || entry.index > last.index) this.list.push(entry);
    }
    this.halted = false;
    this.pump();
    this.changed();
  }

  /** The run was resumed from `time`: what is later is no longer true. */
  cut(time: number): void {
    this.halted = false;
    const keep = this.list.findIndex((entry) => entry.time > time);
    if (keep < 0) return;
    this.list.length = keep;
    for (const place of [...this.decoded.keys()]) if (place >= keep) this.decoded.delete(place);
    if (this.sent >= keep) this.restart();
    this.changed();
  }

  private restart(): void {
    this.reached = this.sent = -1;
    ++this.generation;
    this.busy = false;
  }

  /** The two frames around `time`, as far as they are decoded, and the share of the second; null: none yet. */
  at(time: number): { a: Frame; b: Frame; share: number; exact: boolean } | null {
    if (this.list.length === 0) return null;
    const { place, share } = bracket(this.list, time);
    this.wanted = place;
    this.pump();
    const a = this.decoded.get(place);
    const b = share > 0 ? this.decoded.get(place + 1) : a;
    if (a && b) return { a, b, share, exact: true };
    const nearest = a ?? b ?? this.nearest(place);
    return nearest ? { a: nearest, b: nearest, share: 0, exact: false } : null;
  }

  frame(place: number): Frame | undefined {
    return this.decoded.get(place);
  }

  isDecoded(place: number): boolean {
    return this.decoded.has(place);
  }

  private nearest(place: number): Frame | undefined {
    let best: Frame | undefined;
    let distance = Infinity;
    for (const [at, frame] of this.decoded) {
      if (Math.abs(at - place) < distance) {
        distance = Math.abs(at - place);
        best = frame;
      }
    }
    return best;
  }

  /** How many frames the budget holds. */
  private capacity(): number {
    const one = this.decoded.values().next().value;
    return one ? Math.max(24, Math.floor(budget / (one.data.byteLength + 1))) : 24;
  }

  /** Asks for the next frame that is missing: the one shown, what follows, then what is before. */
  private next(): number {
    const ahead = this.capacity() - 12;
    for (let i = this.wanted; i < Math.min(this.list.length, this.wanted + ahead); ++i) if (!this.decoded.has(i)) return i;
    for (let i = this.wanted; i >= Math.max(0, this.wanted + ahead - this.capacity() + 1); --i) if (!this.decoded.has(i)) return i;
    if (this.decoded.size < this.capacity() - 12) for (let i = this.wanted; i >= 0; --i) if (!this.decoded.has(i)) return i;
    return -1;
  }

  private pump(): void {
    if (this.busy || this.halted || this.error) return;
    const place = this.next();
    if (place < 0) return;
    let from = place;
    if (this.reached !== place - 1) {
      while (from > 0 && !this.list[from]!.key) --from;
      if (this.reached >= from && this.reached < place) from = this.reached + 1;
    }
    this.busy = true;
    this.sent = from;
    const generation = this.generation;
    void this.decode(from, generation);
  }

  private async decode(place: number, generation: number): Promise<void> {
    try {
      const bytes = await this.source.frame(this.run, this.list[place]!.index);
      if (generation !== this.generation) return;
      if (!bytes) {
        this.busy = false;
        this.halted = true;
        return;
      }
      const reply = await this.worker.decode({ run: this.run, bytes });
      if (generation !== this.generation) return;
      if ("error" in reply) throw new Error(reply.error);
      this.milliseconds.push(reply.milliseconds);
      if (this.milliseconds.length > 100) this.milliseconds.shift();
      if (reply.ids) this.ids = reply.ids;
      this.decoded.set(place, { ...reply.frame, ids: this.ids! });
      this.reached = place;
      this.forget();
    } catch (error) {
      if (generation !== this.generation) return;
      this.error = error instanceof Error ? error.message : String(error);
    }
    this.busy = false;
    this.changed();
    this.pump();
  }

  /** Keeps what is nearest to the frame that is shown. */
  private forget(): void {
    while (this.decoded.size > this.capacity()) {
      let farthest = -1;
      for (const place of this.decoded.keys()) {
        const late = place - this.wanted;
        const distance = late < 0 ? -4 * late : late; // frames before the shown one are dropped first
        if (farthest < 0 || distance > Math.abs(farthest - this.wanted) * (farthest < this.wanted ? 4 : 1)) farthest = place;
      }
      this.decoded.delete(farthest);
    }
  }
}

/** A worker that several windows share; replies come in the order of the orders. */
export class DecodeWorker {
  private worker: Worker;
  private waiting: ((reply: Reply) => void)[] = [];

  constructor(code: string) {
    const address = URL.createObjectURL(new Blob([code], { type: "text/javascript" }));
    this.worker = new Worker(address);
    this.worker.onmessage = (event: MessageEvent<Reply>) => this.waiting.shift()?.(event.data);
    this.worker.onerror = (event) => this.waiting.shift()?.({ run: "", error: event.message || "the decoder failed" });
  }

  decode(order: Order): Promise<Reply> {
    return new Promise((resolve) => {
      this.waiting.push(resolve);
      this.worker.postMessage(order, [order.bytes.buffer as ArrayBuffer]);
    });
  }
}
