// Content of a probe's plot: curves over time of one column, of every run, and the laboratory's points.
import type { Measurement, Probe } from "../contract.ts";
import type { Subject } from "../run/subject.ts";
import { printed } from "../units.ts";

export interface Curve {
  run: Subject;
  x: number[];
  y: number[];
}

/** Probes whose tables hold many places at each time. */
export const isProfile = (probe: Probe) => probe.type === "profile" || probe.type === "velocity-profile";

/** The column along which a profile is drawn. */
export const alongOf = (probe: Probe) => (probe.type === "velocity-profile" ? "height_m" : "x_m");

/** The columns of a probe that can be plotted over time, as its table has them. */
export function choices(run: Subject, probe: Probe): string[] {
  const columns = run.table(probe.name)?.columns ?? probe.columns;
  return columns.filter((name) => name !== "time_s" && name !== alongOf(probe) && !/^[xyz]_m$/.test(name));
}

/** The one that was measured, else the one that is asked for most often. */
export function favourite(run: Subject, probe: Probe, columns: string[]): string {
  const measured = run.scene.measurements.find((m) => m.probe === probe.name && columns.includes(m.column));
  if (measured) return measured.column;
  if (probe.type === "force") return largest(run, probe, columns.filter((name) => name.startsWith("force_"))) ?? columns[0] ?? "";
  const liked: Record<string, string[]> = {
    depth: ["connected_m"], front: ["front_m"], energy: ["total_J"], volume: ["density_error_rms"], profile: ["connected_m"],
    "velocity-profile": ["u_m_s"], "run-up": ["connected_m"], motion: ["displacement_y_m", "displacement_z_m"], "level-map": ["highest_m"],
  };
  return liked[probe.type]?.find((name) => columns.includes(name)) ?? columns[0] ?? "";
}

/** The column that is largest over the run: of a weir's force that along the flow, of a ship's that which carries it. */
function largest(run: Subject, probe: Probe, columns: string[]): string | undefined {
  const table = run.table(probe.name);
  const sums = columns.map((name) => (table?.column(name) ?? []).reduce((sum, value) => sum + Math.abs(value), 0));
  return columns[sums.indexOf(Math.max(...sums))];
}

export function curves(runs: Subject[], probe: string, column: string): Curve[] {
  return runs.flatMap((run) => {
    const table = run.table(probe);
    const x = table?.values[0];
    const y = table?.column(column);
    return x && y ? [{ run, x, y }] : [];
  });
}

/** What was measured of a column, and what the run says of it; of a case that has not run the name of its file. */
export function laboratory(run: Subject, probe: string, column: string): (Measurement & { words: string })[] {
  const all = run.scene.measurements.map((m, i) => ({ ...m, words: run.info?.measurements[i]?.words ?? m.file }));
  return all.filter((m) => m.probe === probe && m.column === column);
}

/** Of what was measured along a profile, (x, value) by x: that with which the profile of `time` is compared, which is the
 * first at or after its own time; the one before is of `before`. */
export function measuredFor({ time: times, x = [], value }: Measurement, before: number, time: number): [number, number][] {
  const digits = 1e-6 * Math.abs(time); // times are written with seven
  const now = times.flatMap((own, k): [number, number][] => (own > before + digits && own <= time + digits ? [[x[k]!, value[k]!]] : []));
  return now.sort(([a], [b]) => a - b);
}

export const unitOf = (probe: Probe, column: string) => printed(probe.units?.[probe.columns.indexOf(column)] ?? "");

export function axisLabel(probe: Probe, column: string): string {
  const name = (probe.names?.[probe.columns.indexOf(column)] ?? column).replaceAll("_", " ");
  const unit = unitOf(probe, column);
  return unit ? `${name}, ${unit}` : name;
}
