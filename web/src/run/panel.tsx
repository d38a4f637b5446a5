// What the run tells of itself, in words: progress, time left, cost, water, energy, warnings; and the buttons.
import { useEffect, useState } from "preact/hooks";
import type { App } from "../app.ts";
import type { SweepInfo } from "../contract.ts";
import { useChanges } from "../store.ts";
import { duration, number } from "../units.ts";
import type { RunModel } from "./model.ts";

const stateWords = { waiting: "waiting to begin", running: "running", done: "done", stopped: "stopped", failed: "failed" };
const buttons: Record<string, { word: string; title: string; done: string }> = {
  stop: { word: "Stop", title: "Ends the run after the present step; it can go on later", done: "The run stops after its present step." },
  checkpoint: { word: "Checkpoint", title: "Writes a checkpoint now and goes on", done: "A checkpoint will be written." },
  resume: { word: "Go on", title: "Goes on from the newest checkpoint", done: "The run goes on from its newest checkpoint." },
};

export function RunPanel({ app }: { app: App }) {
  useChanges(app.look, app.data);
  const runs = app.shownRuns();
  return (
    <div class="run-panel">
      {app.state?.mode === "sweep" && app.server && <Sweeps app={app} />}
      {app.state && app.state.runs.length > 1 && <Choice app={app} />}
      {runs.map((run) => (
        <OneRun key={run.id} app={app} run={run} />
      ))}
    </div>
  );
}

/** How far the sweeps are whose members are shown, and the button to go on with them. */
function Sweeps({ app }: { app: App }) {
  const [sweeps, list] = useState<SweepInfo[]>([]);
  const [word, tell] = useState("");
  const server = app.server!;
  const ask = async () => {
    try {
      list(await server.sweeps());
    } catch {
      // the runs tell that nobody answers
    }
  };
  useEffect(() => {
    void ask();
    const timer = setInterval(() => void ask(), 3000);
    return () => clearInterval(timer);
  }, []);
  const press = async (k: number, what: string) => {
    try {
      await server.askSweep(k, what);
      tell(what === "stop" ? "The members that run stop after their present step." : "The sweep goes on with what is not done.");
    } catch (error) {
      tell(error instanceof Error ? error.message : String(error));
    }
    await ask();
  };
  return (
    <>
      {sweeps.map((sweep, k) => (
        <section class="sweep" key={sweep.name}>
          <h2>{sweep.name}</h2>
          <p>
            {sweep.done} of {sweep.members} runs are done{sweep.is_at_work ? "; it is at work" : ""}
          </p>
          {sweep.is_at_work ? (
            <button title="Stops the members that run; the sweep can go on later" onClick={() => void press(k, "stop")}>Stop the sweep</button>
          ) : (
            sweep.done < sweep.members && <button title="Runs the members that are not done, from their checkpoints" onClick={() => void press(k, "resume")}>Go on with the sweep</button>
          )}
        </section>
      ))}
      {word && <p class="hint" role="status">{word}</p>}
    </>
  );
}

/** Which runs are shown, and whether side by side or one over the other. */
function Choice({ app }: { app: App }) {
  const look = app.look.now;
  const all = app.state!.runs;
  const toggle = (id: string, on: boolean) => {
    if (on) void app.open(id);
    else if (look.shown.length > 1) app.look.change({ shown: look.shown.filter((s) => s !== id) });
  };
  return (
    <fieldset class="choice">
      <legend>Runs</legend>
      {all.map((run) => (
        <label key={run.id}>
          <input type="checkbox" checked={look.shown.includes(run.id)} onChange={(e) => toggle(run.id, e.currentTarget.checked)} /> {run.name}
        </label>
      ))}
      <div class="segmented" role="group" aria-label="How runs are compared">
        <button aria-pressed={look.layout === "side"} onClick={() => app.look.change({ layout: "side" })}>
          Side by side
        </button>
        <button aria-pressed={look.layout === "over"} onClick={() => app.look.change({ layout: "over" })}>
          One over the other
        </button>
      </div>
    </fieldset>
  );
}

/** Lines of `tailwater info` that the panel tells in its own way, above. */
const above = ["message", "warnings"];

function OneRun({ app, run }: { app: App; run: RunModel }) {
  const [word, tell] = useState("");
  const info = run.info;
  const message = info?.lines.find(({ label }) => label === "message")?.text;
  const press = async (what: string) => {
    try {
      tell((await run.control(what)) || buttons[what]!.done);
    } catch (error) {
      tell(error instanceof Error ? error.message : String(error));
    }
  };
  return (
    <section class="one-run">
      <h2>{run.scene.title || run.name}</h2>
      {run.gone && <p class="warning">The folder of this run is gone. What was read is still shown.</p>}
      {!run.connected && <p class="warning">The program does not answer. What was read is still shown.</p>}
      {run.trouble && <p class="warning">{run.trouble}</p>}
      {run.frames.error && <p class="warning">A frame cannot be shown: {run.frames.error}</p>}
      {info && (
        <>
          <p class={`status ${info.state}`}>
            <strong>{stateWords[info.state] ?? info.state}</strong>
            {info.state === "running" && info.time_left !== null && `, ${duration(info.time_left)} left`}
          </p>
          {message && <p class={info.state === "failed" ? "reason" : "hint"}>{message}</p>}
          <div class="progress" role="progressbar" aria-valuemin={0} aria-valuemax={100} aria-valuenow={Math.round(100 * info.progress)} aria-label="Progress of the run">
            <div style={{ width: `${100 * Math.min(1, info.progress)}%` }} />
          </div>
          <p class="progress-words">
            {number(info.time, 4)} of {number(info.end, 4)} s
          </p>
          {app.source.live && (info.controls ?? []).length > 0 && (
            <div class="controls">
              {info.controls!.filter((what) => what in buttons).map((what) => (
                <button key={what} title={buttons[what]!.title} onClick={() => void press(what)}>
                  {buttons[what]!.word}
                </button>
              ))}
            </div>
          )}
          {word && <p class="hint" role="status">{word}</p>}
          {info.warnings.length > 0 && (
            <ul class="warnings">
              {info.warnings.map((warning) => (
                <li>{warning}</li>
              ))}
            </ul>
          )}
          <dl>
            {info.lines.filter(({ label, text }) => !above.includes(label) && text !== info.state).map(({ label, text }) => (
              <>
                <dt>{label}</dt>
                <dd>{text}</dd>
              </>
            ))}
          </dl>
        </>
      )}
    </section>
  );
}
