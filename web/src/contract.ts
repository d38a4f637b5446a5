// Data that the program's server sends, as described in docs/reference/view.md. Lengths in m, times in s.

export type Point = number[];
/** First and last line of the case file, from 1; only in the drawing of a case. */
export type Lines = [number, number];

export interface State {
  mode: "run" | "sweep" | "case" | "report" | "study";
  runs: { id: string; name: string; path: string; parameters?: Record<string, string> }[];
  case: { path: string } | null;
  /** Of a validation or of a study. */
  report?: Report | SpacingStudy | null;
  version: string;
  ranks_most?: number;
  out?: string;
}

/** What `tailwater validate` found. */
export interface Report {
  version: string;
  commit: string;
  level: string;
  scheme: string;
  ranks: number;
  date: string;
  machine: { processor: string; cores: number };
  cpu_s: number;
  studies: Study[];
}

/** "not resolved": the interval of the value reaches over a bound of the target; "shown": there is no target. */
export type Result = "met" | "missed" | "not resolved" | "shown";

export interface Study {
  name: string;
  title: string;
  kind: string;
  about: string;
  uncertainty: string;
  metrics: Metric[];
  runs: Cost[];
  /** Name of the run whose water is shown. */
  shown: string | null;
  moments: { time: number; label: string }[];
  figures: Figure[];
}

export interface Figure {
  caption: string;
  panels?: Panel[];
  missing?: string;
}

export interface Metric {
  name: string;
  what: string;
  value: number | null;
  unit: string;
  low: number | null;
  high: number | null;
  paper: number | null;
  peers: { name: string; range: [number, number] }[];
  /** Of the value alone. */
  verdict: Result;
  /** With the interval of the value; earlier reports have none. */
  result?: Result;
  reference: string;
  shifted_value: number | null;
  shift: number | null;
  shift_unit: string;
  order: number | null;
  /** Either way, of an error at three spacings or more; reports of before have none. */
  uncertainty?: number | null;
  note: string;
  /** In a comparison: what is compared; else "". */
  variant: string;
}

/** What a run was and cost; only `message`, why it failed, if it did. */
export interface Cost {
  name: string;
  message: string;
  spacing_m?: number;
  particles?: number;
  steps?: number;
  dt_mean_s?: number;
  iterations_per_solve?: number;
  cpu_s?: number;
  cpu_s_per_simulated_s?: number;
  energy_end_over_start?: number | null;
  energy_rise_over_start?: number | null;
  density_error_mean?: number;
  density_error_rms?: number;
}

export interface Panel {
  title: string;
  x: string;
  y: string;
  logarithmic: boolean;
  /** Of y, that are shown. */
  limits: [number, number] | null;
  curves: { label: string; kind: "run" | "exact" | "measured" | "aside" | "spacings" | "particles"; x: number[]; y: (number | null)[] }[];
}

/** What `tailwater study` found. */
export interface SpacingStudy {
  /** The finest first, as `values`. */
  spacings_m: number[];
  results: StudyRow[];
}

export interface StudyRow {
  probe: string;
  quantity: string;
  unit: string;
  /** Of the finest run; `uncertainty` is half the width of the interval of the limit, `low` to `high`. */
  value: number;
  low: number;
  high: number;
  uncertainty: number;
  limit: number | null;
  order: number | null;
  discretisation: number | null;
  chance: number | null;
  averaging: number | null;
  step: number | null;
  notes: string;
  values: number[];
}

export interface Wall {
  name: string;
  kind: "wall" | "gate" | "wave_maker" | "body" | "plate";
  /** Which of a frame's poses moves it; null: at rest. */
  moving: number | null;
  polylines?: Point[][];
  triangles?: { positions: number[]; indices: number[] };
  plate?: boolean;
  lines?: Lines;
}

export interface OpenEnd {
  name: string;
  from?: Point;
  to?: Point;
  corners?: Point[];
  direction?: Point;
  lines?: Lines;
}

/** A place in air: a vent, as wide as a slit in 2D and a round hole in 3D; or a space that starts at another pressure. */
export interface AirPlace {
  name: string;
  at: Point;
  width?: number;
  lines?: Lines;
}

export interface Probe {
  name: string;
  type: string;
  /** One point, a line, or an outline; empty: it has no place. */
  points: Point[];
  /** Its table in the run's folder; probes/NAME.csv where it is not said. */
  file?: string;
  columns: string[];
  /** Of the columns: their names without units, and their units as "m^3/s per m"; absent in runs of older programs. */
  names?: string[];
  units?: string[];
  lines?: Lines;
}

export interface Measurement {
  probe: string;
  /** As the probe's table has it. */
  column: string;
  file: string;
  time: number[];
  value: number[];
  /** Of a profile: where along it. */
  x?: number[];
}

export interface Scene {
  format: number;
  title: string;
  dimension: 2 | 3;
  spacing: number;
  gravity: number[];
  end: number;
  /** Around all that is drawn; the program may leave it out (null), whole() fills it in. */
  box: { min: Point; max: Point };
  walls: Wall[];
  bodies: { name: string; pose: number | null; lines?: Lines }[];
  inlets: OpenEnd[];
  outlets: OpenEnd[];
  pockets: AirPlace[];
  vents: AirPlace[];
  probes: Probe[];
  scalars: { name: string; unit: string }[];
  /** Names of several liquids, by their number. */
  liquids: string[];
  measurements: Measurement[];
}

export interface Drawing extends Scene {
  fluid?: { name: string; lines?: Lines }[];
  particles?: { count: number; shown: number; positions: string; fluid?: string };
}

export interface Info {
  state: "waiting" | "running" | "done" | "stopped" | "failed";
  time: number;
  end: number;
  progress: number;
  time_left: number | null;
  particles?: number;
  lines: { label: string; text: string }[];
  warnings: string[];
  /** What the run says of each measurement of its scene, in their order; empty where it does not yet. */
  measurements: { words: string }[];
  controls?: string[];
}

export interface SpecKey {
  name: string;
  type: string;
  unit?: string;
  required?: boolean;
  default?: unknown;
  choices?: string[];
  minimum?: number;
  maximum?: number;
  minimum_is_excluded?: boolean;
  maximum_is_excluded?: boolean;
  documentation: string;
  /** With which choices of another key it goes. */
  goes_with?: { key: string; choices: string[] };
}

export interface Spec {
  tables: { name: string; is_list: boolean; documentation: string; keys: SpecKey[] }[];
}

export interface Finding {
  severity: "error" | "warning" | "note";
  id?: string;
  line: number;
  column: number;
  end_column?: number;
  table?: string;
  index?: number;
  key?: string;
  places?: number[][];
  value?: number;
  unit?: string;
  message: string;
  remedy?: string;
}

export interface Check {
  findings: Finding[];
  drawing: Drawing | null;
  summary: string[];
}

export interface SweepInfo {
  name: string;
  members: number;
  done: number;
  is_at_work: boolean;
}
