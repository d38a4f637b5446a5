// The gauges: a plot per probe, linked with the clock and with each other.
import type uPlot from "uplot";
import { useEffect, useRef, useState } from "preact/hooks";
import type { App } from "../app.ts";
import { series } from "../colours.ts";
import type { Probe } from "../contract.ts";
import type { Subject } from "../run/subject.ts";
import { useChanges } from "../store.ts";
import { block, toCsv, valueAt } from "../tables.ts";
import { colours } from "../theme.ts";
import { number, withUncertainty } from "../units.ts";
import { alongOf, axisLabel, choices, curves, favourite, isProfile, laboratory, measuredFor, unitOf } from "./curves.ts";
import { limit, meanOf, type Mean } from "./limit.ts";
import { Plot, type Line } from "./plot.tsx";
import { saveText } from "../picture/save.ts";
import { toSvg } from "../picture/svg.ts";

export function Gauges({ app }: { app: App }) {
  useChanges(app.look, app.data);
  const runs = app.shown();
  const probes = new Map<string, Probe>();
  for (const run of runs) for (const probe of run.scene.probes) probes.set(probe.name, probes.get(probe.name) ?? probe);
  if (probes.size === 0) return <p class="hint">This case has no probes. A [[probe]] in the case file measures levels, pressures, forces and more.</p>;
  return (
    <div class="gauges">
      {runs.length > 1 && <RunKey app={app} runs={runs} />}
      {[...probes.values()].map((probe) => (
        <Gauge key={probe.name} app={app} runs={runs} probe={probe} />
      ))}
    </div>
  );
}

export function RunKey({ app, runs }: { app: App; runs: Subject[] }) {
  const palette = series[app.look.now.theme];
  return (
    <ul class="run-key">
      {runs.map((run, i) => (
        <li key={run.id}>
          <i style={{ background: palette[i % 6] }} /> {run.name}
        </li>
      ))}
    </ul>
  );
}

function Gauge({ app, runs, probe }: { app: App; runs: Subject[]; probe: Probe }) {
  useChanges(...(isProfile(probe) ? [app.player] : []));
  const owner = runs.find((run) => run.table(probe.name)) ?? runs[0]!;
  const columns = choices(owner, probe);
  const [chosen, choose] = useState("");
  const column = columns.includes(chosen) ? chosen : favourite(owner, probe, columns);
  const lit = app.look.now.probe === probe.name;
  const card = useRef<HTMLElement>(null);
  const plot = useRef<uPlot | null>(null);
  useEffect(() => {
    if (lit) card.current?.scrollIntoView({ block: "nearest", behavior: "smooth" });
  }, [lit]);

  const profile = isProfile(probe);
  const lines = profile ? profileCurves(app, runs, probe, column) : overTime(app, runs, probe, column);
  const rows = runs.map((run) => run.table(probe.name)?.rows ?? 0).join(" ");
  const stamp = owner.id + rows + column + (profile ? `@${blockStamp(owner, probe, app.player.time)}` : "");
  const measured = runs.flatMap((run) => laboratory(run, probe.name, column).map((m) => ({ ...m, run })));
  const unit = unitOf(probe, column);
  const xLabel = profile ? axisLabel(probe, alongOf(probe)) : "time, s";
  const save = (how: string) => {
    if (how === "csv") saveText(`${probe.name}.csv`, "text/csv", csv(owner, probe.name));
    else if (how === "svg") saveText(`${probe.name}.svg`, "image/svg+xml", toSvg(lines, xLabel, axisLabel(probe, column), colours(), probe.name));
    else if (how === "png") plot.current?.ctx.canvas.toBlob((blob) => blob && saveText(`${probe.name}.png`, "image/png", blob));
  };
  return (
    <section class={`gauge${lit ? " lit" : ""}`} ref={card} data-probe={probe.name}>
      <header>
        <button class="gauge-name" title={probe.name} aria-pressed={lit} onClick={() => app.select(probe.name)}>
          {probe.name}
        </button>
        {columns.length > 1 ? (
          <select aria-label={`Column of ${probe.name}`} value={column} onChange={(e) => choose(e.currentTarget.value)}>
            {columns.map((name) => (
              <option value={name}>{axisLabel(probe, name)}</option>
            ))}
          </select>
        ) : (
          <span class="column">{axisLabel(probe, column)}</span>
        )}
        {!profile && <Now app={app} run={owner} probe={probe.name} column={column} unit={unit} />}
        <select class="save" aria-label={`Save ${probe.name}`} title={`Save ${probe.name} as a table or a picture`} value="" onChange={(e) => { save(e.currentTarget.value); e.currentTarget.value = ""; }}>
          <option value="">⤓</option>
          <option value="csv">CSV</option>
          <option value="svg">SVG</option>
          <option value="png">PNG</option>
        </select>
      </header>
      <div class="read" aria-live="off" />
      {owner.table(probe.name) || (measured.length > 0 && !profile) ? (
        <Plot lines={lines} xLabel={xLabel} yLabel={axisLabel(probe, column)} height={lit ? 250 : 150} player={profile ? null : app.player} stamp={stamp} sync={profile ? `profile-${probe.name}` : "time"} onMake={(u) => (plot.current = u)} />
      ) : (
        <p class="hint">No reading yet.</p>
      )}
      {!profile && runs.length >= 3 && <Limit runs={runs} probe={probe.name} column={column} unit={unit} plot={plot} />}
      {measured.map((m) => (
        <p class="score">
          <i /> {runs.length > 1 ? `${m.run.name}: ` : ""}
          {m.words}
        </p>
      ))}
    </section>
  );
}

/** How long a value stays while it plays, ms: nobody reads faster, and each costs a layout of the page. */
const readable = 100;

/** The value at the moment shown. */
function Now({ app, run, probe, column, unit }: { app: App; run: Subject; probe: string; column: string; unit: string }) {
  const out = useRef<HTMLSpanElement>(null);
  useEffect(() => {
    let told = 0;
    const tell = () => {
      const now = performance.now();
      if (app.player.playing && now - told < readable) return;
      told = now;
      const table = run.table(probe);
      const value = table ? valueAt(table.values[0] ?? [], table.column(column) ?? [], app.player.time) : NaN;
      if (out.current) out.current.textContent = Number.isNaN(value) ? "" : `${number(value, 4)} ${unit}`;
    };
    tell();
    return app.player.on(tell);
  });
  return <span class="value" ref={out} />;
}

/** Means over the times that the plot shows, and what they come to at dx = 0, where there are three spacings. */
function Limit({ runs, probe, column, unit, plot }: { runs: Subject[]; probe: string; column: string; unit: string; plot: { current: uPlot | null } }) {
  const [span, show] = useState<[number, number] | null>(null);
  useEffect(() => {
    const u = plot.current;
    if (!u) return;
    const tell = (of: uPlot) => {
      const { min, max } = of.scales["x"]!;
      if (min != null && max != null) show((was) => (was && was[0] === min && was[1] === max ? was : [min, max]));
    };
    tell(u);
    (u.hooks.setScale ??= []).push(tell);
  });
  if (!span || new Set(runs.map((run) => run.scene.spacing)).size < 3) return null;
  const means = curves(runs, probe, column).map(({ run, x, y }) => meanOf(run.scene.spacing, x, y, ...span));
  if (means.some((m) => m === null) || means.length < 3) return null;
  const end = limit(means as Mean[]);
  if (!end) return null;
  return (
    <p class="score" title="A straight line through the means over the times shown; zoom to where the flow is steady">
      means over {number(span[0], 3)} to {number(span[1], 3)} s: {means.map((m) => number(m!.mean, 4)).join(", ")}; <span class="whole">at dx = 0: <strong>{withUncertainty(end.value, end.uncertainty)} {unit}</strong></span>
    </p>
  );
}

function overTime(app: App, runs: Subject[], probe: Probe, column: string): Line[] {
  const palette = series[app.look.now.theme];
  const lines: Line[] = curves(runs, probe.name, column).map(({ run, x, y }) => ({
    name: run.name, x, y, colour: palette[runs.indexOf(run) % 6]!,
  }));
  const ofOne = runs.map((run) => laboratory(run, probe.name, column)).find((all) => all.length > 0) ?? [];
  for (const m of ofOne) lines.push({ name: m.file, x: m.time, y: m.value, colour: colours().text, points: true });
  return lines;
}

/** The profiles at the moment shown, and what was measured at their time. */
function profileCurves(app: App, runs: Subject[], probe: Probe, column: string): Line[] {
  const palette = series[app.look.now.theme];
  return runs.flatMap((run, i) => {
    const table = run.table(probe.name);
    const along = table?.column(alongOf(probe)) ?? table?.values[1];
    const y = table?.column(column);
    if (!table || !along || !y) return [];
    const times = table.values[0]!;
    const [first, end] = block(times, app.player.time);
    const measured = i > 0 ? [] : laboratory(run, probe.name, column).map((m) => {
      const now = measuredFor(m, times[first - 1] ?? -Infinity, times[first]!);
      return { name: m.file, x: now.map(([x]) => x), y: now.map(([, value]) => value), colour: colours().text, points: true };
    });
    return [{ name: run.name, x: along.slice(first, end), y: y.slice(first, end), colour: palette[i % 6]! }, ...measured];
  });
}

function blockStamp(run: Subject, probe: Probe, time: number): number {
  const times = run.table(probe.name)?.values[0];
  return times ? block(times, time)[0] : -1;
}

function csv(run: Subject, probe: string): string {
  const table = run.table(probe);
  return table ? toCsv(table.columns, table.values) : "";
}
