// Content and look of the page: one object, changed by change(), which notifies all listeners.
import { useLayoutEffect, useReducer } from "preact/hooks";
import type { ColourMap } from "./colours.ts";

export type Colouring = "speed" | "pressure" | "depth" | "origin" | "plain" | "size" | "liquid";

export interface Look {
  theme: "light" | "dark";
  colouring: Colouring;
  map: ColourMap;
  /** Fixed limits by colouring; absent: of the run so far. */
  limits: Partial<Record<Colouring, [number, number]>>;
  momentary: boolean;
  water: "particles" | "surface";
  size: number;
  section: { axis: number; share: number; flip: boolean; slice: boolean } | null;
  labels: boolean;
  walls: boolean;
  profiles: boolean;
  layout: "side" | "over";
  /** Ids of the runs that are shown. */
  shown: string[];
  probe: string | null;
  /** What of the case's drawing is marked, by its name. */
  marked: string | null;
  tab: "gauges" | "run" | "case";
  side: boolean;
  /** The report is over the picture. */
  reading: boolean;
  dialog: "" | "keys" | "film";
}

export class Store<T extends object> {
  private listeners = new Set<() => void>();
  constructor(public now: T) {}

  change(patch: Partial<T>): void {
    this.now = { ...this.now, ...patch };
    this.tell();
  }

  tell(): void {
    for (const listener of [...this.listeners]) listener();
  }

  on(listener: () => void): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }
}

/** Draws a component anew when `what` changes. */
export function useChanges(...what: { on(listener: () => void): () => void }[]): void {
  const [, redraw] = useReducer<number, void>((n) => n + 1, 0);
  useLayoutEffect(() => { // no change between drawing and listening is missed
    const stops = what.map((w) => w.on(() => redraw()));
    return () => stops.forEach((stop) => stop());
  }, what);
}
