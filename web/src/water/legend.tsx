// The colours' meaning: quantity, unit, limits of the run, of the moment, or fixed by the reader.
import { useRef } from "preact/hooks";
import type { App } from "../app.ts";
import { gradient } from "../colours.ts";
import type { Subject } from "../run/subject.ts";
import { number } from "../units.ts";
import { colourings, quantity } from "./value.ts";

export function Legend({ app, run }: { app: App; run: Subject }) {
  const look = app.look.now;
  const bar = useRef<HTMLDivElement>(null);
  if (look.layout === "over" && app.shown().length > 1) return null;
  const kind = colourings.find((c) => c.name === look.colouring)!;
  if (look.colouring === "plain" || quantity(run, look.colouring) === "plain") return null;
  const fixed = look.limits[look.colouring];
  const [low, high] = app.limits ?? [0, 1];
  const change = (at: 0 | 1, text: string) => {
    const value = Number(text.replace("−", "-").replace(",", "."));
    if (text.trim() === "" || !Number.isFinite(value)) return;
    const next: [number, number] = [low, high];
    next[at] = value;
    if (next[1] > next[0]) app.look.change({ limits: { ...look.limits, [look.colouring]: next } });
  };
  const free = () => {
    const limits = { ...look.limits };
    delete limits[look.colouring];
    app.look.change({ limits, momentary: fixed ? false : !look.momentary });
  };
  if (look.colouring === "origin") {
    const ages = run.scene.inlets.length > 0;
    return (
      <div class="legend">
        <div class="legend-title">{ages ? "Age of the water" : "Where the water started"}</div>
        <div class="legend-bar" style={{ background: gradient(look.map) }} />
        <div class="legend-ends">
          <span>{ages ? "oldest" : "left"}</span>
          <span>{ages ? "newest" : "right"}</span>
        </div>
      </div>
    );
  }
  if (look.colouring === "liquid") {
    const names = run.scene.liquids;
    return (
      <div class="legend">
        <div class="legend-title">Liquid</div>
        <div class="legend-bar" style={{ background: gradient(look.map) }} />
        <div class="legend-ends">
          <span>{names[0]}</span>
          <span>{names.at(-1)}</span>
        </div>
      </div>
    );
  }
  return (
    <div class="legend">
      <div class="legend-title">
        {kind.title} <span class="unit">{kind.unit}</span>
      </div>
      <div class="legend-bar" ref={bar} style={{ background: gradient(look.map) }} />
      <div class="legend-ends">
        <input aria-label={`Lowest ${kind.title}, ${kind.unit}`} value={number(low, 3)} onChange={(e) => change(0, e.currentTarget.value)} />
        <button class="link" title="Limits of the run, as far as it was read, of the moment, or fixed by the two fields" onClick={free}>
          {fixed ? "fixed" : look.momentary ? "of the moment" : "of the run"}
        </button>
        <input aria-label={`Highest ${kind.title}, ${kind.unit}`} value={number(high, 3)} onChange={(e) => change(1, e.currentTarget.value)} />
      </div>
    </div>
  );
}
