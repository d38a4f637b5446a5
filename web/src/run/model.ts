// A run as the page knows it: scene, frames, tables, what it tells of itself; kept up to date by the server's events.
import type { Info, Scene } from "../contract.ts";
import { DecodeWorker, FrameWindow } from "../frames/window.ts";
import type { Source } from "../source.ts";
import { Table } from "../tables.ts";
import { upward } from "../water/eye.ts";

export class RunModel {
  tables = new Map<string, Table>();
  info: Info | null = null;
  /** What went wrong with this run's data, "": nothing. */
  trouble = "";
  gone = false;
  connected = true;
  private reading = new Set<string>();
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
    const scene = await source.scene(run.id);
    const { axis, sign } = upward(scene.gravity, scene.dimension);
    const frames = new FrameWindow(run.id, source, worker, { up: axis, sign, width: 2 * scene.spacing }, changed);
    const model = new RunModel(run.id, run.name, run.parameters ?? {}, scene, frames, source, changed);
    await model.catchUp();
    model.stop = source.listen(run.id, {
      frame: (entry) => frames.add([entry]),
      table: (path) => void model.read(path),
      info: (info) => {
        model.info = info;
        changed();
      },
      cut: (time) => {
        frames.cut(time);
        model.tables.clear();
        void model.catchUp();
      },
      gone: () => {
        model.gone = true;
        changed();
      },
      connected: (yes) => {
        const back = yes && !model.connected;
        model.connected = yes;
        if (back) void model.catchUp();
        changed();
      },
    });
    return model;
  }

  /** Reads what there is: at the beginning, and when the server answers again. */
  private async catchUp(): Promise<void> {
    try {
      const last = this.frames.list.at(-1);
      const { frames } = await this.source.frames(this.id, last ? last.index + 1 : 0);
      this.frames.add(frames);
      this.info = await this.source.info(this.id);
      await Promise.all(this.scene.probes.map((probe) => this.read(`probes/${probe.name}.csv`)));
    } catch (error) {
      this.trouble = error instanceof Error ? error.message : String(error);
    }
    this.changed();
  }

  /** Reads the tail of a table. */
  async read(path: string): Promise<void> {
    if (this.reading.has(path)) return;
    this.reading.add(path);
    try {
      const table = this.tables.get(path) ?? new Table();
      const text = await this.source.file(this.id, path, table.bytes);
      table.append(text);
      if (table.columns.length > 0) this.tables.set(path, table);
    } catch {
      // not there yet: a probe's table begins with its first reading
    }
    this.reading.delete(path);
    this.changed();
  }

  table(probe: string): Table | undefined {
    return this.tables.get(`probes/${probe}.csv`);
  }

  get end(): number {
    return this.frames.list.at(-1)?.time ?? 0;
  }

  get isLive(): boolean {
    return this.info?.state === "running" || this.info?.state === "waiting";
  }

  control(what: string): Promise<string> {
    return this.source.control(this.id, what);
  }

  close(): void {
    this.stop();
  }
}
