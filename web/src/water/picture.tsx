// The picture and what lies over it: names, legend, scale, what the pointer reads. Drawn again only when something
// has changed.
import { useEffect, useRef } from "preact/hooks";
import type { App } from "../app.ts";
import { colours } from "../theme.ts";
import { profileLines } from "../gauges/profiles.ts";
import { useChanges } from "../store.ts";
import { length, niceBelow, number } from "../units.ts";
import { attach } from "./hands.ts";
import { Labels } from "./labels.ts";
import { Legend } from "./legend.tsx";
import { Pace } from "./pace.ts";
import { nearest, wallNear } from "./pick.ts";
import { Staging } from "./staging.ts";
import { colourings, valueOf } from "./value.ts";
import { WaterView } from "./view.ts";

export function Picture({ app }: { app: App }) {
  useChanges(app.look, app.data);
  const box = useRef<HTMLDivElement>(null);
  const canvas = useRef<HTMLCanvasElement>(null);
  const names = useRef<HTMLDivElement>(null);
  const scale = useRef<HTMLDivElement>(null);
  const reading = useRef<HTMLDivElement>(null);

  useEffect(() => {
    const view = new WaterView(canvas.current!);
    const staging = new Staging(view);
    const labels = new Labels(names.current!, (name, isProbe) => app.pick(name, isProbe));
    app.view = view;
    let dirty = true;
    let moving = false; // the camera, by a hand
    let whole = false; // what was drawn last is of its own moment
    let ids = ""; // of what was drawn last
    let later = 0;
    const touch = () => (dirty = true);
    // New data are drawn at once where they are waited for, else now and then: a frame for later changes nothing here.
    const news = () => {
      if (!whole || app.shown().map((s) => s.id).join() !== ids) dirty = true;
      else if (!later) later = window.setTimeout(() => ((later = 0), (dirty = true)), 500);
    };
    const stops = [app.look.on(touch), app.data.on(news), app.player.on(touch), () => clearTimeout(later)];
    app.touch = touch;

    const resize = new ResizeObserver(([entry]) => {
      const { width, height } = entry!.contentRect;
      view.resize(width, height, Math.min(2, devicePixelRatio));
      dirty = true;
    });
    resize.observe(box.current!);

    const hands = attach(view, canvas.current!, {
      moved: () => {
        view.untouched = false;
        dirty = moving = true;
      },
      click: (x, y) => {
        const probe = labels.probeNear(x, y);
        const wall = probe ?? wallNear(view, staging, x, y);
        if (wall) app.pick(wall, probe !== null);
      },
      hover: (x, y) => read(x, y),
      leave: () => (reading.current!.hidden = true),
    });

    function read(x: number, y: number): void {
      const at = nearest(view, staging, x, y);
      const out = reading.current!;
      out.hidden = at === null;
      if (!at) return;
      const axes = ["x", "y", "z"];
      const parts = at.place.map((c, d) => `${axes[d]} ${number(c, 4)}`).join("  ") + " m";
      const values = at.run
        ? colourings
            .filter((c) => c.name === "speed" || c.name === "pressure")
            .map((c) => [c, valueOf(at.run!, at.frame!, c.name, at.i)] as const)
            .filter(([, v]) => !Number.isNaN(v))
            .map(([c, v]) => `${c.title.toLowerCase()} ${number(v, 3)} ${c.unit}`)
        : [];
      out.textContent = [parts, ...values].join("\n");
      out.style.transform = `translate(${Math.min(x + 14, view.canvas.clientWidth - 190)}px, ${Math.min(y + 14, view.canvas.clientHeight - 70)}px)`;
    }

    const pace = new Pace();
    let moved = 0; // when something moved last
    let drawnAt = 0;
    let before = performance.now();
    let handle = 0;
    const frame = (now: number) => {
      handle = requestAnimationFrame(frame);
      const seconds = Math.min(0.1, (now - before) / 1000);
      before = now;
      app.player.tick(seconds);
      if (app.player.playing || moving) moved = now;
      moving = false;
      if (now - moved > 300 && pace.rest()) dirty = true;
      if (!dirty) return;
      dirty = false;
      if (now - moved < 300 && now - drawnAt < 1500) pace.moved(now - drawnAt);
      drawnAt = now;
      view.oneIn = app.recording ? 1 : pace.oneIn;
      draw();
    };
    function draw(): void {
      const look = app.look.now;
      const theme = colours();
      view.paper(theme.paper);
      staging.sync(app.shown(), look, theme);
      let exact = true;
      for (const { run, stage } of staging.shown) {
        const at = run.frames.at(app.player.time);
        stage.particles.points.visible = at !== null;
        stage.select(look.probe);
        stage.walls.mark(look.marked);
        exact &&= at !== null;
        if (!at) continue;
        exact &&= at.exact;
        stage.show(at, view.oneIn);
        const limits = staging.colour(run, stage, at, look);
        if (run === staging.shown[0]!.run) app.setLimits(limits);
        stage.overlay(look.profiles ? profileLines(run, app.player.time) : []);
      }
      staging.section(look.section);
      view.time = app.player.time;
      view.draw();
      labels.sync(view, staging, look);
      const cell = view.cells[0];
      if (view.eye && cell) {
        const metres = niceBelow((view.eye.span / cell.height) * Math.min(180, cell.width * 0.3));
        const bar = scale.current!;
        bar.style.width = `${(metres / view.eye.span) * cell.height}px`;
        bar.textContent = length(metres);
      }
      whole = exact;
      ids = staging.shown.map(({ run }) => run.id).join();
      app.frameDrawn(exact);
    }
    handle = requestAnimationFrame(frame);
    return () => {
      cancelAnimationFrame(handle);
      stops.forEach((stop) => stop());
      resize.disconnect();
      hands();
      staging.dispose();
      view.dispose();
    };
  }, []);

  const run = app.shown()[0];
  return (
    <div class="picture" ref={box}>
      <canvas ref={canvas} tabIndex={0} aria-label="The water. Arrow keys move the camera, plus and minus zoom, f shows all." />
      <div class="names" ref={names} />
      {run && <Legend app={app} run={run} />}
      <div class="scale" ref={scale} aria-hidden="true" />
      <div class="reading" ref={reading} hidden />
      {app.shown().length === 0 && <p class="empty">{app.emptyWord()}</p>}
    </div>
  );
}
