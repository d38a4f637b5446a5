// Reading under the pointer: its place, and speed and pressure of the water there.
import { decimals, number } from "../units.ts";
import { nearest } from "./pick.ts";
import type { Staging } from "./staging.ts";
import { colourings, valueOf } from "./value.ts";
import type { WaterView } from "./view.ts";

/** Tells it in `out`, which hides where there is nothing; x, y: of the pointer in the picture, px. */
export function read(view: WaterView, staging: Staging, out: HTMLElement, x: number, y: number): void {
  const at = nearest(view, staging, x, y);
  out.hidden = at === null;
  if (!at) return;
  const pixel = (view.eye?.span ?? 1) / (view.cells[0]?.height ?? 1);
  const place = at.place.map((c, d) => `${"xyz"[d]} ${decimals(c, Math.ceil(-Math.log10(pixel)))}`).join("  ") + " m";
  const { run, frame, i } = at;
  const values = colourings
    .filter((c) => run && frame && ["speed", "pressure", "size"].includes(c.name))
    .map((c) => [c, valueOf(run!, frame!, c.name, i)] as const)
    .filter(([, v]) => !Number.isNaN(v))
    .map(([c, v]) => `${c.title.toLowerCase()} ${number(v, 3)} ${c.unit}`);
  out.textContent = [place, ...values].join("\n");
  const { clientWidth, clientHeight } = view.canvas;
  out.style.transform = `translate(${Math.min(x + 14, clientWidth - 190)}px, ${Math.min(y + 14, clientHeight - 70)}px)`;
}
