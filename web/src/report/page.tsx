// The report of `tailwater validate`: every number with its target, plots of what was compared, and the way to the water.
import type { App } from "../app.ts";
import type { Report, Result, Study } from "../contract.ts";
import { duration } from "../units.ts";
import { Figures } from "./figures.tsx";
import { Paper } from "./paper.tsx";
import { className, Costs, Matrix, Metrics, Peers, resultOf } from "./tables.tsx";

const count = (studies: Study[], result: Result) => studies.flatMap((study) => study.metrics).filter((m) => resultOf(m) === result).length;
const results = ["met", "missed", "not resolved"] as const;

export function ReportPage({ app, report, away }: { app: App; report: Report; away: boolean }) {
  const kinds = [...new Set(report.studies.map((study) => study.kind))];
  const tile = (value: string | number, words: string, kind = "") => (
    <div class={`tile ${kind}`}>
      <b>{value}</b>
      {words}
    </div>
  );
  const ways = kinds.map((kind) => (
    <>
      <h2>{kind}</h2>
      {report.studies.filter((study) => study.kind === kind).map((study) => (
        <a href={`#${study.name}`}>
          <span>{study.title}</span>
          {results.map((result) => count([study], result) > 0 && <i class={className(result)} title={`targets ${result}`}>{count([study], result)}</i>)}
        </a>
      ))}
    </>
  ));
  return (
    <Paper away={away} label="Studies" ways={ways}>
      <p class="faint">
        {report.scheme && `Scheme ${report.scheme} · `}Tailwater {report.version}, commit {report.commit} · {report.date.slice(0, 10)} · {report.machine.processor}, {report.machine.cores} cores, {report.ranks} {report.ranks > 1 ? "ranks" : "rank"} per run
      </p>
      <div class="tiles">
        {results.map((result) => tile(count(report.studies, result), `targets ${result}`, className(result)))}
        {tile(count(report.studies, "shown"), "numbers without a target")}
        {tile(duration(report.cpu_s), "CPU time of all runs")}
      </div>
      <p class="faint">
        “Not resolved”: the interval of the number reaches over its target. “Paper” is the result of the code of the case's paper, “other codes” are results that we measured or found published.
      </p>
      {report.studies.map((study) => (
        <One key={study.name} app={app} study={study} />
      ))}
    </Paper>
  );
}

function One({ app, study }: { app: App; study: Study }) {
  const shown = app.state!.runs.find((run) => run.name === study.shown);
  const see = (time: number, label: string) => (
    <button onClick={() => void app.watch(shown!.id, time)}>{label}</button>
  );
  return (
    <section id={study.name}>
      <h2>{study.title}</h2>
      <p>{study.about}</p>
      <p class="faint">
        <b>How well this is known.</b> {study.uncertainty}
      </p>
      {shown && (
        <p class="see">
          {see(0, "See the water")}
          {study.moments.map(({ time, label }) => see(time, label))}
        </p>
      )}
      <Metrics metrics={study.metrics.filter((m) => m.variant === "")} />
      <Matrix metrics={study.metrics.filter((m) => m.variant !== "")} />
      <Peers metrics={study.metrics.filter((m) => m.peers.length > 0 && m.value !== null)} />
      <Figures app={app} name={study.name} figures={study.figures} />
      <Costs runs={study.runs.filter((run) => run.message || run.particles !== undefined)} />
    </section>
  );
}
