// The page: a picture of the water, plots of its gauges, what the run tells, and the case.
import { render } from "preact";
import { useMemo, useState } from "preact/hooks";
import workerCode from "worker:frames/worker.ts";
import { App } from "./app.ts";
import { CasePanel } from "./case/panel.tsx";
import { Gauges } from "./gauges/panel.tsx";
import { Icon } from "./icons.tsx";
import { KeysDialog, listen } from "./keys.tsx";
import { LookPanel } from "./look.tsx";
import { FilmDialog } from "./picture/filmdialog.tsx";
import { savePicture } from "./picture/still.ts";
import { ReportPage } from "./report/page.tsx";
import { StudyPage } from "./report/study.tsx";
import { RunPanel } from "./run/panel.tsx";
import { Embedded, Server } from "./source.ts";
import { useChanges, type Look } from "./store.ts";
import { TimeBar } from "./time/bar.tsx";
import { Picture } from "./water/picture.tsx";

function Page({ app }: { app: App }) {
  useChanges(app.look, app.data);
  const [lookOpen, openLook] = useState(false);
  const look = app.look.now;
  const run = app.shown()[0];
  const report = app.state?.report;
  const reading = look.reading && !!report;
  // Every frame that is decoded draws this page anew, but not the report.
  const paper = useMemo(() => report && ("studies" in report ? <ReportPage app={app} report={report} away={!reading} /> : <StudyPage app={app} study={report} away={!reading} />), [report, reading]);
  const tab = (name: Look["tab"], word: string) => (
    <button role="tab" id={`tab-${name}`} aria-selected={look.tab === name} aria-controls="panel" onClick={() => app.look.change({ tab: name, side: true })}>
      {word}
    </button>
  );
  return (
    <div class={`page${look.side ? "" : " wide"}${look.tab === "case" ? " case" : ""}`}>
      <header class="top">
        <svg class="mark" viewBox="0 0 32 32" width="22" height="22" aria-hidden="true"><path d="M3 6v20h26V16c-5 0-6 4-10 4S12 9 3 6z" fill="currentColor" /></svg>
        {paper && !reading && <button onClick={() => app.look.change({ reading: true })}>{"studies" in report! ? "Report" : "Study"}</button>}
        <h1>{reading ? app.paper : run?.scene.title || run?.name || "Tailwater"}</h1>
        {!reading && run?.info && <span class={`chip ${run.info.state}`}>{run.info.state}</span>}
        <span class="gap" />
        {!reading && (
          <>
            <button class="icon" title="How the water is drawn" aria-label="How the water is drawn" aria-expanded={lookOpen} onClick={() => openLook(!lookOpen)}><Icon name="look" /></button>
            <button class="icon" title="Show all (f)" aria-label="Show all" onClick={() => { app.view?.fit(); app.touch(); }}><Icon name="fit" /></button>
            <button class="icon" title="Save a picture (p)" aria-label="Save a picture" onClick={() => void savePicture(app)}><Icon name="camera" /></button>
            <button class="icon" title="Save a film (m)" aria-label="Save a film" disabled={!(app.player.range[1] > app.player.range[0])} onClick={() => app.look.change({ dialog: "film" })}><Icon name="film" /></button>
          </>
        )}
        <button class="icon" title="Light or dark (t)" aria-label="Light or dark page" onClick={() => app.setTheme(look.theme === "dark" ? "light" : "dark")}><Icon name={look.theme === "dark" ? "sun" : "moon"} /></button>
        <button class="icon" title="Keys (?)" aria-label="Keys" onClick={() => app.look.change({ dialog: "keys" })}><Icon name="keys" /></button>
        {!reading && <button class="icon" title="Panel beside the picture" aria-label="Panel beside the picture" aria-pressed={look.side} onClick={() => app.look.change({ side: !look.side })}><Icon name="side" /></button>}
      </header>
      {paper}
      <main inert={reading}>
        <Picture app={app} />
        {lookOpen && <LookPanel app={app} />}
      </main>
      {!reading && look.side && (
        <aside>
          <div class="tabs" role="tablist" aria-label="Beside the picture">
            {(app.runs.length > 0 || run) && tab("gauges", "Gauges")}
            {app.runs.length > 0 && tab("run", "Run")}
            {app.server && app.state?.case && tab("case", "Case")}
          </div>
          <div class="panel" id="panel" role="tabpanel" aria-labelledby={`tab-${look.tab}`} tabIndex={-1}>
            {look.tab === "gauges" && <Gauges app={app} />}
            {look.tab === "run" && <RunPanel app={app} />}
            {look.tab === "case" && app.server && app.state?.case && <CasePanel app={app} />}
          </div>
        </aside>
      )}
      {!reading && <TimeBar app={app} />}
      {look.dialog === "film" && <FilmDialog app={app} />}
      {look.dialog === "keys" && <KeysDialog app={app} />}
    </div>
  );
}

const data = document.getElementById("tailwater-data")?.textContent;
const server = data ? null : new Server();
const app = new App(data ? new Embedded(data) : server!, server, workerCode);
Object.assign(globalThis, { tailwater: app }); // for the tests, and for whoever opens the console
listen(app);
render(<Page app={app} />, document.getElementById("page")!);
void app.begin();
