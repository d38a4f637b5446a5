// The time bar: play, step, speed, and a slider that shows which frames are at hand.
import { useEffect, useRef } from "preact/hooks";
import type { App } from "../app.ts";
import { Icon } from "../icons.tsx";
import { useChanges } from "../store.ts";
import { number, timeDecimals } from "../units.ts";
import { speeds } from "./player.ts";

export function TimeBar({ app }: { app: App }) {
  useChanges(app.data, app.look, playing(app));
  const { player } = app;
  const slider = useRef<HTMLInputElement>(null);
  const clock = useRef<HTMLOutputElement>(null);
  const loaded = useRef<HTMLCanvasElement>(null);
  const runs = app.shown();
  const [start, end] = player.range;
  const times = runs[0]?.frames.times ?? [];

  useEffect(() => {
    const show = () => {
      const [low, high] = player.range;
      const input = slider.current!;
      const ends = [String(low), String(high)] as const;
      if (input.min !== ends[0] || input.max !== ends[1]) [input.min, input.max] = ends; // either costs a layout
      input.value = String(player.time);
      input.style.setProperty("--share", String(high > low ? (player.time - low) / (high - low) : 0));
      clock.current!.value = player.time.toFixed(timeDecimals(high)) + " s";
    };
    show();
    return player.on(show);
  }, []);

  useEffect(() => {
    const canvas = loaded.current!;
    const context = canvas.getContext("2d")!;
    const frames = runs[0]?.frames;
    canvas.width = Math.max(1, canvas.clientWidth);
    context.clearRect(0, 0, canvas.width, 2);
    if (!frames || !(end > start)) return;
    context.fillStyle = getComputedStyle(canvas).color;
    const x = (t: number) => ((t - start) / (end - start)) * canvas.width;
    frames.list.forEach((entry, i) => {
      if (frames.isDecoded(i)) context.fillRect(x(entry.time), 0, Math.max(1, x(frames.list[i + 1]?.time ?? end) - x(entry.time) + 0.5), 2);
    });
  });

  const live = runs.some((run) => run.isLive);
  const none = !(end > start);
  return (
    <footer class="time">
      <button class="icon" title="To the start (Home)" aria-label="To the start" disabled={none} onClick={() => player.seek(start)}><Icon name="start" /></button>
      <button class="icon" title="One frame back (left arrow or ,)" aria-label="One frame back" disabled={none} onClick={() => player.step(times, -1)}><Icon name="back" /></button>
      <button class="icon play" title={player.playing ? "Pause (space)" : "Play (space)"} aria-label={player.playing ? "Pause" : "Play"} disabled={none} onClick={() => player.toggle()}>
        <Icon name={player.playing ? "pause" : "play"} />
      </button>
      <button class="icon" title="One frame on (right arrow or .)" aria-label="One frame on" disabled={none} onClick={() => player.step(times, 1)}><Icon name="forward" /></button>
      <output class="clock" ref={clock} aria-label="Time shown" />
      <div class="track">
        <input ref={slider} type="range" step="any" aria-label="Time" disabled={none} onInput={(e) => player.seek(Number(e.currentTarget.value))} />
        <canvas ref={loaded} height={2} aria-hidden="true" />
      </div>
      <span class="end">{number(end, 4)} s</span>
      <select aria-label="Speed" title="Speed, simulated seconds per second (up and down arrows)" value={String(player.speed)} onChange={(e) => player.setSpeed(Number(e.currentTarget.value))}>
        {speeds.map((s) => (
          <option value={String(s)}>{s === 1 ? "real time" : s < 1 ? `1/${number(1 / s, 3)}` : `${s} ×`}</option>
        ))}
      </select>
      <button class="icon" aria-pressed={player.loop} title="Again and again (l)" aria-label="Loop" onClick={() => player.setLoop(!player.loop)}><Icon name="loop" /></button>
      {live && (
        <button class="follow" aria-pressed={player.following} title="Stay at the newest frame (end key)" onClick={() => player.follow()}>
          <i /> Live
        </button>
      )}
    </footer>
  );
}

/** Changes of the player but for its time. */
function playing(app: App): { on(listener: () => void): () => void } {
  return (app.playerShape ??= {
    on(listener) {
      const shape = () => [app.player.playing, app.player.speed, app.player.loop, app.player.following, ...app.player.range].join(" ");
      let was = shape();
      return app.player.on(() => {
        const is = shape();
        if (is !== was) {
          was = is;
          listener();
        }
      });
    },
  });
}
