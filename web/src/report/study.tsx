// What `tailwater study` found: each number of each probe with its interval, over the spacings, and the way to the water.
import { useEffect, useRef } from "preact/hooks";
import type { App } from "../app.ts";
import type { Panel, SpacingStudy, StudyRow } from "../contract.ts";
import { number } from "../units.ts";
import { Figures } from "./figures.tsx";
import { Table } from "./tables.tsx";

const four = (x: number | null) => (x === null ? "–" : number(x, 4));

/** Values by spacing, their limit at 0, and the interval of the finest. */
function panel(study: SpacingStudy, row: StudyRow): Panel {
  const across = [0, Math.max(...study.spacings_m)];
  const level = (label: string, y: number | null, kind: "exact" | "aside") => (y === null ? [] : [{ label, kind, x: across, y: [y, y] }]);
  return {
    title: `${row.probe}, ${row.quantity}`, x: "spacing dx (m)", y: row.unit, logarithmic: false, limits: null,
    curves: [
      { label: "computed", kind: "spacings", x: study.spacings_m.toReversed(), y: row.values.toReversed() },
      ...level("limit", row.limit, "exact"), ...level("interval", row.low, "aside"), ...level("interval", row.high, "aside"),
    ],
  };
}

export function StudyPage({ app, study, away }: { app: App; study: SpacingStudy; away: boolean }) {
  const all = useRef<HTMLDivElement>(null);
  useEffect(() => {
    if (!away) all.current!.focus({ preventScroll: true }); // keys scroll it
  }, [away]);
  const words = ["value", "±", "from", "to", "limit", "order", "discretisation", "chance", "time step"];
  return (
    <div class="report" ref={all} inert={away} tabIndex={0}>
      <nav aria-label="Runs">
        <h2>Runs</h2>
        <p class="see">
          {app.state!.runs.map(({ id, name }) => (
            <button onClick={() => void app.watch(id, 0)}>{name}</button>
          ))}
        </p>
      </nav>
      <article>
        <p class="faint">
          Spacings of {study.spacings_m.map((dx) => number(dx, 4)).join(", ")} m. A value is that of the finest; the interval, from … to, holds what is discretisation, chance and the time step together.
        </p>
        <Table head={[["probe"], ["quantity"], ["unit"], ...words.map((word): [string, boolean] => [word, true]), ["notes"]]}>
          {study.results.map((row) => (
            <tr key={`${row.probe} ${row.quantity}`}>
              <td>{row.probe}</td>
              <td>{row.quantity}</td>
              <td>{row.unit}</td>
              <td class="number value">{four(row.value)}</td>
              {[row.uncertainty, row.low, row.high, row.limit, row.order, row.discretisation, row.chance, row.step].map((x) => <td class="number">{four(x)}</td>)}
              <td class="faint">{row.notes}</td>
            </tr>
          ))}
        </Table>
        <Figures app={app} name="study" figures={[{ caption: "Values by spacing, with their limit and interval.", panels: study.results.map((row) => panel(study, row)) }]} />
      </article>
    </div>
  );
}
