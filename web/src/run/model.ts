// A run as the page knows it: scene, frames, tables, status and messages; kept up to date by the server's events.
import type { Info, Scene } from "../contract.ts";
import { DecodeWorker, FrameWindow } from "../frames/window.ts";
import type { Source } from "../source.ts";
import { Table } from "../tables.ts";
import { whole, type Subject } from "./subject.ts";

/** How often a run that is not going is asked whether it goes on, ms. */
const idle = 5000;

/** A member of a sweep by what it has of its own: "spacing = P/8". */
function nameOf(run: { name: string; parameters?: Record<string, string> }): string {
  const own = Object.entries(run.parameters ?? {}).map(([key, value]) => `${key.split(".").at(-1)} = ${value}`);
  return own.join(", ") || run.name;
}

export class RunModel implements Subject {
  tables = new Map<string, Table>();
  info: Info | null = null;
  private maps = new Map<string, Table>();
  /** What went wrong with this run's data, "": nothing. */
  trouble = "";
  gone = false;
  connected = true;
  private reading = new Set<string>();
  /** How often the run was cut back: what was asked for before is of another run. */
  private cuts = 0;
  private stop: () => void = () => {};

  private constructor(
    readonly id: string,
    readonly name: string,
    readonly parameters: Record<string, string>,
    readonly scene: Scene,
    readonly frames: FrameWindow,
    private source: Source,
    private changed: () => void,
  ) {}

  static async open(
    source: Source,
    worker: DecodeWorker,
    run: { id: string; name: string; parameters?: Record<string, string> },
    changed: () => void,
  ): Promise<RunModel> {
    const scene = whole(await source.scene(run.id));
    const frames = new FrameWindow(run.id, source, worker, changed);
    const model = new RunModel(run.id, nameOf(run), run.parameters ?? {}, scene, frames, source, changed);
    await model.catchUp();
    model.watch();
    return model;
  }

  /** Listens while the run goes on; asks now and then whether one that stands still has begun again. */
  private watch(): void {
    this.stop();
    if (!this.source.live) return;
    if (this.isLive) {
      this.stop = this.listen();
      return;
    }
    const timer = setInterval(() => void this.ask(), idle);
    this.stop = () => clearInterval(timer);
  }

  private async ask(): Promise<void> {
    try {
      const info = await this.source.info(this.id);
      const changed = JSON.stringify(info) !== JSON.stringify(this.info) || !this.connected;
      this.info = info;
      if (changed) await this.catchUp();
      if (this.isLive) this.watch();
    } catch {
      if (this.connected) {
        this.connected = false;
        this.changed();
      }
    }
  }

  private listen(): () => void {
    return this.source.listen(this.id, (this.frames.list.at(-1)?.index ?? -1) + 1, {
      frame: (entry) => this.frames.add([entry]),
      table: (path) => void this.read(path),
      info: (info) => {
        this.info = info;
        if (!this.isLive) void this.catchUp().then(() => this.watch());
        this.changed();
      },
      cut: (time) => {
        this.frames.cut(time);
        this.tables.clear();
        this.reading.clear();
        ++this.cuts;
        void this.catchUp();
      },
      gone: () => {
        this.gone = true;
        this.changed();
      },
      connected: (yes) => {
        const back = yes && !this.connected;
        this.connected = yes;
        if (back) void this.catchUp();
        this.changed();
      },
    });
  }

  /** Reads what there is: at the beginning, and when the server answers again. */
  private async catchUp(): Promise<void> {
    try {
      const last = this.frames.list.at(-1);
      const { frames } = await this.source.frames(this.id, last ? last.index + 1 : 0);
      if (frames.length > 0) this.frames.add(frames);
      this.info = await this.source.info(this.id);
      this.connected = true;
      await Promise.all(this.scene.probes.map((probe) => this.read(probe.file ?? `probes/${probe.name}.csv`)));
      if (this.scene.dimension === 2) await Promise.all(this.scene.probes.filter((p) => p.type === "level-map").map((p) => this.readMap(p.name)));
      this.trouble = "";
    } catch (error) {
      this.trouble = error instanceof Error ? error.message : String(error);
    }
    this.changed();
  }

  /** Reads the tail of a table. */
  async read(path: string): Promise<void> {
    if (this.reading.has(path)) return;
    this.reading.add(path);
    const { cuts } = this;
    try {
      const known = this.tables.get(path) ?? new Table();
      const { text, isWhole } = await this.source.file(this.id, path, known.bytes);
      if (cuts !== this.cuts) return;
      const table = isWhole ? new Table() : known;
      table.append(text);
      if (table.columns.length > 0) this.tables.set(path, table);
    } catch {
      // the server does not answer; the run's events report that
    }
    this.reading.delete(path);
    this.changed();
  }

  /** A level map is written anew each time, so it is read whole. */
  private async readMap(probe: string): Promise<void> {
    const table = new Table();
    table.append((await this.source.file(this.id, `probes/${probe}.map.csv`, 0)).text);
    if (table.rows > 0) this.maps.set(probe, table);
  }

  map(probe: string): Table | undefined {
    return this.maps.get(probe);
  }

  table(probe: string): Table | undefined {
    return this.tables.get(this.scene.probes.find((p) => p.name === probe)?.file ?? `probes/${probe}.csv`);
  }

  get end(): number {
    return this.frames.list.at(-1)?.time ?? 0;
  }

  get isLive(): boolean {
    return this.info?.state === "running" || this.info?.state === "waiting";
  }

  async control(what: string): Promise<string> {
    const word = await this.source.control(this.id, what);
    if (!this.isLive) await this.ask(); // it goes on by now
    return word;
  }

  close(): void {
    this.stop();
  }
}
