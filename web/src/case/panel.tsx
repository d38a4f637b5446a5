// The case: its text in an editor, what the program finds in it, and the buttons that save and run it. The drawing beside
// it is the page's picture.
import { useEffect, useRef, useState } from "preact/hooks";
import type { App } from "../app.ts";
import type { Check, Finding } from "../contract.ts";
import { drawn } from "../run/subject.ts";
import { useChanges } from "../store.ts";
import { CaseEditor } from "./editor.ts";

/** How long the page waits for the next key before it asks the program, and before it asks how long the run takes, ms. */
const pause = 120;
const rest = 1000;

/** How many drawings there have been: each is another one for the picture and the plots. */
let drawings = 0;

export function CasePanel({ app }: { app: App }) {
  useChanges(app.data);
  const server = app.server!;
  const holder = useRef<HTMLDivElement>(null);
  const editor = useRef<CaseEditor | null>(null);
  const [check, show] = useState<Check | null>(null);
  const [word, tell] = useState("");
  const [templates, list] = useState<{ name: string; title: string }[]>([]);
  const [form, fill] = useState({ out: app.state?.out ?? "my_run", ranks: 1 });

  useEffect(() => {
    let timer = 0;
    let later = 0;
    let asked: AbortController | null = null;
    const ask = async (text: string) => {
      clearTimeout(later);
      asked?.abort();
      asked = new AbortController();
      const { signal } = asked;
      try {
        const answer = await server.check(text, signal);
        show(answer);
        made.find(answer.findings);
        app.caseWord = "Nothing can be drawn before the errors are mended.";
        if (answer.drawing) app.draw(drawn(answer.drawing, app.state?.case?.path ?? "case", `case-${++drawings}`), answer.drawing);
        else app.data.tell();
        tell("");
        if (!hasError(answer)) later = window.setTimeout(() => void estimate(text, signal), rest);
      } catch (error) {
        if (!(error instanceof DOMException && error.name === "AbortError")) tell(error instanceof Error ? error.message : String(error));
      }
    };
    /** Trial steps of the run: what they find is told with the rest. */
    const estimate = async (text: string, signal: AbortSignal) => {
      try {
        const answer = await server.estimate(text, signal);
        show(answer);
        made.find(answer.findings);
      } catch {
        // the time is not known; the case is checked all the same
      }
    };
    const made = new CaseEditor(holder.current!, app.caseText ?? "", {
      changed(text) {
        app.caseText = text;
        clearTimeout(timer);
        clearTimeout(later);
        timer = window.setTimeout(() => void ask(text), pause);
      },
      line: (line) => app.lightAt(line),
      save: () => void save(),
      run: () => void start(),
    });
    editor.current = made;
    app.markLines = (lines) => made.mark(lines);
    void (async () => {
      try {
        if (app.caseText === null) made.replace(await server.caseText());
        else await ask(app.caseText);
        made.know(await server.spec());
        list(await server.templates());
      } catch (error) {
        tell(error instanceof Error ? error.message : String(error));
      }
    })();
    return () => {
      clearTimeout(timer);
      clearTimeout(later);
      asked?.abort();
      app.markLines = null;
      made.destroy();
    };
  }, []);

  const attempt = async (work: () => Promise<string>) => {
    try {
      tell(await work());
    } catch (error) {
      tell(error instanceof Error ? error.message : String(error));
    }
  };
  const save = () =>
    attempt(async () => {
      await server.save(editor.current!.text);
      return "Saved.";
    });
  const start = () =>
    attempt(async () => {
      const id = await server.start(editor.current!.text, form.out, form.ranks);
      app.state = await server.state();
      await app.open(id);
      app.look.change({ shown: [id], tab: "run" });
      app.player.follow();
      return "";
    });
  return (
    <div class="case-panel">
      <div class="case-bar">
        <select aria-label="Begin from a template" value="" onChange={(e) => {
          const name = e.currentTarget.value;
          e.currentTarget.value = "";
          if (name) void attempt(async () => (editor.current!.replace(await server.template(name)), ""));
        }}>
          <option value="">Templates</option>
          {templates.map((t) => (
            <option value={t.name}>{t.title || t.name}</option>
          ))}
        </select>
        <button title="Save the case file (Ctrl+S)" onClick={() => void save()}>Save</button>
        <span class="gap" />
        <label>
          into <input value={form.out} size={12} aria-label="Folder of the run" onInput={(e) => fill({ ...form, out: e.currentTarget.value })} />
        </label>
        {(app.state?.ranks_most ?? 1) > 1 && (
          <label>
            on <input type="number" min={1} max={app.state!.ranks_most} value={form.ranks} aria-label="Ranks" onInput={(e) => fill({ ...form, ranks: Number(e.currentTarget.value) || 1 })} /> ranks
          </label>
        )}
        <button class="primary" disabled={check === null || hasError(check)} title="Run this case (Ctrl+Enter)" onClick={() => void start()}>Run</button>
      </div>
      <div class="editor" ref={holder} />
      <Found check={check} word={word} go={(line) => editor.current?.go(line)} />
    </div>
  );
}

const hasError = (check: Check) => check.findings.some((f) => f.severity === "error");

function Found({ check, word, go }: { check: Check | null; word: string; go: (line: number) => void }) {
  const worst: Record<Finding["severity"], number> = { error: 0, warning: 1, note: 2 };
  const findings = [...(check?.findings ?? [])].sort((a, b) => worst[a.severity] - worst[b.severity] || a.line - b.line);
  return (
    <div class="found" role="status">
      {word && <p class="hint">{word}</p>}
      <ul>
        {findings.map((f) => (
          <li class={f.severity}>
            <button disabled={f.line < 1} onClick={() => go(f.line)}>
              <strong>{f.severity}</strong>
              {f.line >= 1 ? `, line ${f.line}` : ""}: {f.message}
              {f.id ? ` [${f.id}]` : ""}
            </button>
          </li>
        ))}
      </ul>
      {check?.summary.map((sentence) => <p class="summary">{sentence}</p>)}
    </div>
  );
}
