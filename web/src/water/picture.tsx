// The picture and what lies over it: names, legend, scale, what the pointer reads.
import { useEffect, useRef } from "preact/hooks";
import type { App } from "../app.ts";
import { useChanges } from "../store.ts";
import { attach } from "./hands.ts";
import { Labels } from "./labels.ts";
import { Legend } from "./legend.tsx";
import { Loop } from "./loop.ts";
import { Painter } from "./painter.ts";
import { wallNear } from "./pick.ts";
import { read } from "./reading.ts";
import { Staging } from "./staging.ts";
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
    const loop = new Loop(app, view, new Painter(app, view, staging, labels, scale.current!));
    app.view = view;

    const resize = new ResizeObserver(([entry]) => {
      const { width, height } = entry!.contentRect;
      view.resize(width, height, Math.min(2, devicePixelRatio));
      loop.touch();
    });
    resize.observe(box.current!);

    const release = attach(view, canvas.current!, {
      moved: () => {
        view.untouched = false;
        loop.moved();
      },
      click: (x, y) => {
        const probe = labels.probeNear(x, y);
        const wall = probe ?? wallNear(view, staging, x, y);
        if (wall) app.pick(wall, probe !== null);
      },
      hover: (x, y) => read(view, staging, reading.current!, x, y),
      leave: () => (reading.current!.hidden = true),
    });
    return () => {
      loop.dispose();
      resize.disconnect();
      release();
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
