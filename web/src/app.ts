// State that all parts of the page share: runs, clock, look, and the source of the data.
import { linesOf, nameAt } from "./case/pointing.ts";
import type { Drawing, Lines, State } from "./contract.ts";
import { DecodeWorker } from "./frames/window.ts";
import { RunModel } from "./run/model.ts";
import type { Subject } from "./run/subject.ts";
import type { Server, Source } from "./source.ts";
import { Store, type Look } from "./store.ts";
import { Player } from "./time/player.ts";
import type { WaterView } from "./water/view.ts";

const remembered = "tailwater-theme";
/** Runs that are shown at once to begin with; others are chosen in the panel. */
const most = 4;

export class App {
  readonly player = new Player();
  readonly data = new Store({ revision: 0 });
  readonly look: Store<Look>;
  readonly runs: RunModel[] = [];
  state: State | null = null;
  /** Why there is nothing to see. */
  trouble = "";
  view: WaterView | null = null;
  /** Asks for a new picture. */
  touch: () => void = () => {};
  /** A film is being made: every picture is whole. */
  recording = false;
  /** Called after each picture; `exact`: it shows the frames of its own moment. */
  drawn: ((exact: boolean) => void) | null = null;
  limits: [number, number] | null = null;
  /** Text of the case in the editor; null: not read yet. */
  caseText: string | null = null;
  /** What there is instead of a drawing of the case. */
  caseWord = "Checking the case …";
  /** Marks lines in the editor; null: there is no editor. */
  markLines: ((lines: Lines | null) => void) | null = null;
  private sketch: { subject: Subject; drawing: Drawing } | null = null;
  /** Kept by the time bar. */
  playerShape: { on(listener: () => void): () => void } | null = null;
  private worker: DecodeWorker;
  private pending = false;

  constructor(
    readonly source: Source,
    readonly server: Server | null,
    workerCode: string,
  ) {
    this.worker = new DecodeWorker(workerCode);
    this.look = new Store<Look>({
      theme: theme(), colouring: "speed", map: "water", limits: {}, momentary: false, water: "particles", size: 1, section: null, labels: true,
      walls: true, profiles: true, layout: "side", shown: [], probe: null, marked: null, tab: "gauges", side: true, reading: false, dialog: "",
    });
    document.documentElement.dataset["theme"] = this.look.now.theme;
  }

  async begin(): Promise<void> {
    try {
      this.state = await this.source.state();
      document.title = `${this.paper || (this.state.runs[0]?.name ?? this.state.case?.path ?? "Tailwater")} · Tailwater`;
      if (this.state.mode === "case") this.look.change({ tab: "case" });
      if (this.paper) this.look.change({ reading: true });
      const first = this.paper ? [] : this.state.runs.slice(0, most);
      for (const run of first) await this.open(run.id);
      if (this.runs[0]?.info?.state === "failed") this.look.change({ tab: "run" }); // which says why
    } catch (error) {
      this.trouble = error instanceof Error ? error.message : String(error);
    }
    this.changed();
  }

  /** What there is to read: the title of a report or a study; else "". */
  get paper(): string {
    const report = this.state?.report;
    return !report ? "" : "studies" in report ? `Validation, level ${report.level}` : "How well the numbers are known";
  }

  /** Opens a run that the server knows, and shows it beside those that are shown. */
  async open(id: string): Promise<void> {
    const known = this.state?.runs.find((run) => run.id === id) ?? { id, name: id };
    if (!this.runs.some((run) => run.id === id)) {
      const run = await RunModel.open(this.source, this.worker, known, () => this.changed());
      this.runs.push(run);
      if (run.isLive && this.runs.length === 1) this.player.follow();
    }
    if (!this.look.now.shown.includes(id)) this.look.change({ shown: [...this.look.now.shown, id] });
    this.changed();
  }

  shownRuns(): RunModel[] {
    const { shown } = this.look.now;
    const runs = shown.map((id) => this.runs.find((run) => run.id === id)).filter((run) => run !== undefined);
    return runs.filter((run) => run.scene.dimension === runs[0]!.scene.dimension);
  }

  /** What the picture shows: the drawing of the case beside its editor, and where there is no run, else the runs. */
  shown(): Subject[] {
    const drawing = this.sketch ? [this.sketch.subject] : [];
    if (this.look.now.tab === "case" && this.server && this.look.now.side) return drawing;
    const runs = this.shownRuns();
    return runs.length > 0 ? runs : drawing;
  }

  /** A new drawing of the case. */
  draw(subject: Subject, drawing: Drawing): void {
    this.sketch = { subject, drawing };
    this.changed();
  }

  /** Something of the picture was pressed, by its name. */
  pick(name: string, isProbe: boolean): void {
    if (this.look.now.tab === "case" && this.sketch) {
      this.look.change({ marked: name });
      this.markLines?.(linesOf(this.sketch.drawing, name));
    } else if (isProbe) {
      this.select(name);
    }
  }

  /** Marks in the drawing what line `line` of the case describes. */
  lightAt(line: number): void {
    const name = this.sketch ? nameAt(this.sketch.drawing, line) : null;
    if (name !== this.look.now.marked) this.look.change({ marked: name });
  }

  /** Shows these runs only. */
  show(ids: string[]): void {
    this.look.change({ shown: ids });
    for (const id of ids) if (!this.runs.some((run) => run.id === id)) void this.open(id);
  }

  /** Goes from the report to a run, at a moment of it. */
  async watch(id: string, time: number): Promise<void> {
    if (this.view && this.look.now.shown[0] !== id) this.view.untouched = true;
    this.look.change({ reading: false, shown: [id] });
    await this.open(id);
    this.extend();
    this.player.seek(time);
  }

  select(probe: string | null): void {
    this.look.change({ probe: this.look.now.probe === probe ? null : probe, tab: "gauges", side: true });
  }

  setTheme(name: Look["theme"]): void {
    document.documentElement.dataset["theme"] = name;
    try {
      localStorage.setItem(remembered, name);
    } catch {
      // a page from disk may have no storage
    }
    this.look.change({ theme: name });
  }

  setLimits(limits: [number, number]): void {
    const was = this.limits;
    if (was && was[0] === limits[0] && was[1] === limits[1]) return;
    this.limits = limits;
    this.changed();
  }

  frameDrawn(exact: boolean): void {
    this.drawn?.(exact);
  }

  /** Something of the data has changed: once per picture, however much comes. */
  private changed(): void {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame(() => {
      this.pending = false;
      this.extend();
      this.data.change({ revision: this.data.now.revision + 1 });
    });
  }

  private extend(): void {
    const ends = this.shown().map((run) => run.end);
    const start = Math.min(...this.shown().map((run) => run.frames.list[0]?.time ?? 0), Infinity);
    this.player.extend(Number.isFinite(start) ? start : 0, Math.max(0, ...ends));
  }

  emptyWord(): string {
    if (this.trouble) return this.trouble;
    if (this.look.now.tab === "case") return this.caseWord;
    return "Reading the run …";
  }
}

function theme(): Look["theme"] {
  try {
    const known = localStorage.getItem(remembered);
    if (known === "light" || known === "dark") return known;
  } catch {
    // no storage: as the system has it
  }
  return matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
}
