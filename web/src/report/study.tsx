// What `tailwater study` found: each number of each probe with its interval, over the spacings, and the way to the water.
import type { App } from "../app.ts";
import type { Panel, SpacingStudy, StudyRow } from "../contract.ts";
import { number, printed } from "../units.ts";
import { Figures } from "./figures.tsx";
import { Paper } from "./paper.tsx";
import { Table } from "./tables.tsx";

/** The columns of study.csv, with their digits. */
const numbers = [["value", 4], ["uncertainty", 2], ["low", 4], ["high", 4], ["limit", 4], ["order", 2], ["discretisation", 2], ["chance", 2], ["averaging", 2], ["step", 2]] as const;

/** Values by spacing, and their limit at 0 with its interval. */
function panel({ spacings_m: x }: SpacingStudy, row: StudyRow): Panel {
  const level = (label: string, y: number | null, kind: "exact" | "aside" = "aside") => ({ label, kind, x: [0, Math.max(...x)], y: [y, y] });
  return {
    title: `${row.probe}, ${row.quantity}`, x: "spacing dx (m)", y: printed(row.unit), logarithmic: false, limits: null,
    curves: [{ label: "computed", kind: "spacings", x: x.toReversed(), y: row.values.toReversed() }, level("limit", row.limit, "exact"), level("interval", row.low), level("interval", row.high)],
  };
}

export function StudyPage({ app, study, away }: { app: App; study: SpacingStudy; away: boolean }) {
  const runs = app.state!.runs, spacings = study.spacings_m.map((dx) => `${number(dx)} m`);
  const words = runs.length === spacings.length ? spacings : runs.map(({ name }) => name);
  const ways = runs.map(({ id, name }, i) => <button title={name} onClick={() => void app.watch(id, 0)}>{words[i]}</button>);
  return (
    <Paper away={away} label="Runs" ways={<p class="see">{ways}</p>}>
      <p class="faint">
        A value is that of the finest of {spacings.length} spacings, {spacings[0]}. Its limit is between low and high with a probability of 95 %. Uncertainty is half of this interval; its parts are discretisation, chance and, for a mean, the finite averaging time. Step is the change by half of the time step.
      </p>
      <Table head={[["probe"], ["quantity"], ["unit"], ...numbers.map(([word]): [string, boolean] => [word, true])]}>
        {study.results.map((row) => (
          <>
            <tr>
              <td>{row.probe}</td>
              <td>{row.quantity}</td>
              <td>{printed(row.unit)}</td>
              {numbers.map(([word, digits]) => <td class="number">{row[word] === null ? "–" : number(row[word], digits)}</td>)}
            </tr>
            {row.notes && (
              <tr>
                <td class="faint" colSpan={3 + numbers.length}><span class="note">{row.notes}</span></td>
              </tr>
            )}
          </>
        ))}
      </Table>
      <Figures app={app} name="study" figures={[{ caption: "Values by spacing, with their limit and interval.", panels: study.results.map((row) => panel(study, row)) }]} />
    </Paper>
  );
}
