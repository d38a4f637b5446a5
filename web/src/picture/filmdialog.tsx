import { useEffect, useRef, useState } from "preact/hooks";
import type { App } from "../app.ts";
import { Dialog } from "../dialog.tsx";
import { number } from "../units.ts";
import { isFilmPossible, pictures, record, saveFilm } from "./film.ts";

export function FilmDialog({ app }: { app: App }) {
  const [start, end] = app.player.range;
  const [from, setFrom] = useState(start);
  const [to, setTo] = useState(Math.floor(1000 * end) / 1000);
  const [share, setShare] = useState(-1);
  const [word, tell] = useState("");
  const stop = useRef(false);
  const plan = { from, to, speed: app.player.speed, rate: 30 };
  useEffect(() => () => void (stop.current = true), []);
  const make = async () => {
    stop.current = false;
    setShare(0);
    tell("");
    try {
      const film = await record(app, plan, (part) => {
        setShare(part);
        return !stop.current;
      });
      if (film) saveFilm(app, film);
      tell(film ? `Saved, ${number(film.size / 1e6, 2)} MB.` : "Stopped.");
    } catch (error) {
      tell(error instanceof Error ? error.message : String(error));
    }
    setShare(-1);
  };
  const { canvas, effort } = app.view ?? {};
  const size = canvas && effort && [canvas.width, canvas.height].map((n) => Math.floor(n / effort.sharpness));
  const field = (word: string, value: number, set: (x: number) => void) => (
    <label class="row">
      {word}
      <input type="number" step="any" min={start} max={end} value={value} onChange={(e) => set(Math.min(end, Math.max(start, Number(e.currentTarget.value))))} />
    </label>
  );
  return (
    <Dialog title="A film of this view" kind="film" close={() => app.look.change({ dialog: "" })}>
      {!isFilmPossible() ? (
        <p>This browser cannot encode films; remedy: Chromium, Chrome, Edge or Firefox of 2024 or later.</p>
      ) : (
        <>
          {field("From, s", from, setFrom)}
          {field("To, s", to, setTo)}
          <p class="hint">
            {number((to - from) / plan.speed, 3)} s of film at the speed of the player, {pictures(plan)} pictures{size && `, ${size[0]} × ${size[1]}`}.
          </p>
          {share >= 0 ? (
            <div class="progress" role="progressbar" aria-valuenow={Math.round(100 * share)} aria-label="Recording"><div style={{ width: `${100 * share}%` }} /></div>
          ) : (
            <button class="primary" disabled={!(to > from)} onClick={() => void make()}>Record and save</button>
          )}
          {share >= 0 && <button onClick={() => (stop.current = true)}>Stop</button>}
          {word && <p role="status">{word}</p>}
        </>
      )}
    </Dialog>
  );
}
