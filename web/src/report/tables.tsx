// The numbers of a report as tables.
import type { ComponentChildren } from "preact";
import type { Cost, Metric, Result } from "../contract.ts";
import { number } from "../units.ts";

const marks: Record<Result, string> = { met: "✓ met", missed: "✗ missed", "not resolved": "? not resolved", shown: "no target" };

export const resultOf = (m: Metric): Result => m.result ?? m.verdict;
/** As the name of a class of the style sheet. */
export const className = (result: Result) => result.replace(" ", "-");

const three = (x: number | null | undefined, none = "–") => (x === null || x === undefined ? none : number(x, 3));

export function Table({ head, children }: { head: [string, boolean?][]; children: ComponentChildren }) {
  return (
    <div class="scroll">
      <table>
        <thead>
          <tr>{head.map(([word, isNumber]) => <th class={isNumber ? "number" : ""}>{word}</th>)}</tr>
        </thead>
        <tbody>{children}</tbody>
      </table>
    </div>
  );
}

function target({ low, high }: Metric): string {
  if (low !== null && high !== null) return low === high ? number(low) : `${number(low)} … ${number(high)}`;
  return high !== null ? `≤ ${number(high)}` : low !== null ? `≥ ${number(low)}` : "";
}

/** What the value is compared with, its best shift, or why there is none. */
function remark(m: Metric): string {
  const parts = [m.note || m.reference];
  if (m.order !== null) parts.push(`observed order ${m.order.toFixed(2)}`);
  if (m.shifted_value !== null && m.shift !== null) {
    const unit = m.shift_unit === "T" ? "" : ` ${m.shift_unit}`;
    parts.push(`${three(m.shifted_value)} with the data ${three(Math.abs(m.shift))}${unit} ${m.shift > 0 ? "later" : "earlier"}`);
  }
  return parts.filter(Boolean).join("; ");
}

function others({ peers }: Metric): string {
  if (peers.length === 0) return "";
  const ends = peers.flatMap((peer) => peer.range);
  return `${three(Math.min(...ends))} … ${three(Math.max(...ends))}`;
}

export function Metrics({ metrics }: { metrics: Metric[] }) {
  if (metrics.length === 0) return null;
  const papers = metrics.some((m) => m.paper !== null);
  const peers = metrics.some((m) => m.peers.length > 0);
  return (
    <Table head={[["quantity"], ["value", true], ["unit"], ["target", true], ...(papers ? [["paper", true] as [string, boolean]] : []), ...(peers ? [["other codes", true] as [string, boolean]] : []), ["result"], ["compared with"]]}>
      {metrics.map((m) => (
        <tr key={m.name} class={className(resultOf(m))}>
          <td>{m.what}</td>
          <td class="number value">{three(m.value)}{m.uncertainty != null && ` ± ${number(m.uncertainty, 2)}`}</td>
          <td>{m.unit}</td>
          <td class="number">{target(m)}</td>
          {papers && <td class="number">{three(m.paper, "")}</td>}
          {peers && <td class="number">{others(m)}</td>}
          <td><span class={`result ${className(resultOf(m))}`}>{marks[resultOf(m)]}</span></td>
          <td class="faint">{remark(m)}</td>
        </tr>
      ))}
    </Table>
  );
}

/** The numbers of a comparison: a row for each quantity, a column for each variant, with a bar of its size. */
export function Matrix({ metrics }: { metrics: Metric[] }) {
  if (metrics.length === 0) return null;
  const variants = [...new Set(metrics.map((m) => m.variant))];
  return (
    <Table head={[["quantity"], ["unit"], ...variants.map((name): [string, boolean] => [name, true])]}>
      {[...new Set(metrics.map((m) => m.what))].map((what) => {
        const row = variants.map((variant) => metrics.find((m) => m.what === what && m.variant === variant));
        const most = Math.max(...row.map((m) => Math.abs(m?.value ?? 0)));
        return (
          <tr key={what}>
            <td>{what}</td>
            <td>{row.find((m) => m)?.unit}</td>
            {row.map((m) => (
              <td class="number bar" title={m?.note}>
                <i style={{ width: `${most > 0 ? (90 * Math.abs(m?.value ?? 0)) / most : 0}%` }} />
                {three(m?.value)}
              </td>
            ))}
          </tr>
        );
      })}
    </Table>
  );
}

/** Our numbers beside those of other codes, the least first, and the target as a line; logarithmic. */
export function Peers({ metrics }: { metrics: Metric[] }) {
  return (
    <div class="panels">
      {metrics.map((m) => {
        const rows = [...m.peers, { name: "Tailwater", range: [m.value!, m.value!] }].sort((a, b) => a.range[0]! - b.range[0]!);
        const bars = [m.low, m.high].filter((x) => x !== null && x > 0) as number[];
        const ends = [...rows.flatMap((row) => row.range), ...bars].filter((x) => x > 0);
        const [low, high] = [Math.log(Math.min(...ends) / 1.15), Math.log(Math.max(...ends) * 1.15)];
        const place = (x: number) => `${(100 * (Math.log(Math.max(x, Math.exp(low))) - low)) / (high - low)}%`;
        return (
          <figure class="peers" key={m.name}>
            <h3>{m.what}{m.unit && ` (${m.unit})`}</h3>
            {rows.map(({ name, range }) => (
              <div class={name === "Tailwater" ? "ours" : ""}>
                <span>{name}</span>
                <span class="strip">
                  {bars.map((x) => <u style={{ left: place(x) }} title="target" />)}
                  <i style={{ left: place(range[0]!), width: `calc(${place(range[1]!)} - ${place(range[0]!)} + 9px)` }} />
                </span>
                <span>{range[0] === range[1] ? three(range[0]) : `${three(range[0])} … ${three(range[1])}`}</span>
              </div>
            ))}
          </figure>
        );
      })}
    </div>
  );
}

/** What runs of cases were and cost, and why others failed. */
export function Costs({ runs }: { runs: Cost[] }) {
  if (runs.length === 0) return null;
  const words = ["dx (mm)", "water particles", "steps", "dt (ms)", "iterations per solve", "CPU (s)", "CPU (s) per simulated s", "energy at the end, of the start", "largest rise", "density error mean, rms (%)"];
  const times = (factor: number, x: number | null | undefined) => three(x == null ? null : factor * x);
  return (
    <details>
      <summary>Cost and soundness of {runs.length === 1 ? "the run" : `the ${runs.length} runs`}</summary>
      <Table head={[["run"], ...words.map((word): [string, boolean] => [word, true])]}>
        {runs.map((run) =>
          run.message ? (
            <tr class="missed" key={run.name}>
              <td>{run.name}</td>
              <td colSpan={words.length}>{run.message}</td>
            </tr>
          ) : (
            <tr key={run.name}>
              <td>{run.name}</td>
              {[
                times(1000, run.spacing_m), run.particles, run.steps, times(1000, run.dt_mean_s), three(run.iterations_per_solve), three(run.cpu_s), three(run.cpu_s_per_simulated_s),
                run.energy_end_over_start == null ? "–" : number(run.energy_end_over_start, 4), three(run.energy_rise_over_start), `${times(100, run.density_error_mean)}, ${times(100, run.density_error_rms)}`,
              ].map((cell) => <td class="number">{cell}</td>)}
            </tr>
          ),
        )}
      </Table>
    </details>
  );
}
