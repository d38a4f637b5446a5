// The picture as it is seen, with legend, scale and time, drawn into a canvas: for a still or as a frame of a film.
import type { App } from "../app.ts";
import { table } from "../colours.ts";
import { colours } from "../theme.ts";
import { length, niceBelow, number, timeDecimals } from "../units.ts";
import { colourings, quantity } from "../water/value.ts";
import { saveText } from "./save.ts";

export function compose(app: App, canvas: HTMLCanvasElement): void {
  const view = app.view!;
  const source = view.canvas;
  const theme = colours();
  const c = canvas.getContext("2d")!;
  const ratio = source.width / Math.max(1, source.clientWidth);
  canvas.width = source.width - (source.width % 2); // films want even sizes
  canvas.height = source.height - (source.height % 2);
  c.drawImage(source, 0, 0);
  c.scale(ratio, ratio);
  const [w, h] = [canvas.width / ratio, canvas.height / ratio];
  c.fillStyle = theme.text;
  c.strokeStyle = theme.text;
  c.lineWidth = 1.5;
  c.font = "600 14px system-ui, sans-serif";
  c.textBaseline = "alphabetic";
  const runs = app.shown();
  c.fillText(runs[0]?.scene.title ?? "", 14, 24);
  c.textAlign = "right";
  c.fillText(`${app.player.time.toFixed(timeDecimals(app.player.range[1]))} s`, w - 14, 24);
  c.textAlign = "left";
  c.font = "12px system-ui, sans-serif";
  if (runs.length > 1) view.cells.forEach((cell, i) => c.fillText(runs[i]?.name ?? "", cell.x + 14, cell.y + 44));
  legend(app, c, h);
  const cell = view.cells[0];
  if (view.eye && cell) {
    const metres = niceBelow((view.eye.span / cell.height) * Math.min(180, cell.width * 0.3));
    const wide = (metres / view.eye.span) * cell.height;
    c.beginPath();
    c.moveTo(w - 18 - wide, h - 24);
    c.lineTo(w - 18 - wide, h - 16);
    c.lineTo(w - 18, h - 16);
    c.lineTo(w - 18, h - 24);
    c.stroke();
    c.textAlign = "center";
    c.fillText(length(metres), w - 18 - wide / 2, h - 22);
  }
  c.textAlign = "left";
}

function legend(app: App, c: CanvasRenderingContext2D, h: number): void {
  const look = app.look.now;
  const kind = colourings.find((k) => k.name === look.colouring)!;
  if (look.colouring === "plain" || look.colouring === "origin" || !app.limits) return;
  if (quantity(app.shown()[0]!, look.colouring) === "plain") return;
  const map = table(look.map);
  for (let i = 0; i < 200; ++i) {
    const k = 4 * Math.round((i * 255) / 199);
    c.fillStyle = `rgb(${map[k]} ${map[k + 1]} ${map[k + 2]})`;
    c.fillRect(14 + i, h - 34, 1.5, 10);
  }
  c.fillStyle = colours().text;
  c.fillText(kind.unit ? `${kind.title}, ${kind.unit}` : kind.title, 14, h - 40);
  const liquids = look.colouring === "liquid" ? (app.shown()[0]?.scene.liquids ?? []) : [];
  c.fillText(liquids[0] ?? number(app.limits[0], 3), 14, h - 10);
  c.textAlign = "right";
  c.fillText(liquids.at(-1) ?? number(app.limits[1], 3), 214, h - 10);
  c.textAlign = "left";
}

export async function savePicture(app: App): Promise<void> {
  const canvas = document.createElement("canvas");
  compose(app, canvas);
  const blob = await new Promise<Blob | null>((resolve) => canvas.toBlob(resolve, "image/png"));
  if (blob) saveText(`${app.shown()[0]?.name ?? "tailwater"}_${app.player.time.toFixed(3)}s.png`, "image/png", blob);
}
