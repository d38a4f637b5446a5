// The keyboard: keys as in any player. Keys typed into fields and the editor stay there.
import type { App } from "./app.ts";
import { Dialog } from "./dialog.tsx";
import { savePicture } from "./picture/still.ts";
import { colourings, isOffered } from "./water/value.ts";

export const keyList: [string, string][] = [
  ["space, k", "play or pause"],
  [", and .", "one frame back, on"],
  ["← →", "one frame back, on; with shift ten"],
  ["↑ ↓", "faster, slower"],
  ["Home, End", "to the start, to the end (live: follow)"],
  ["l", "again and again"],
  ["1 … 7", "colour by speed, pressure, depth, origin, none; by spacing or liquid where there are several"],
  ["c", "the next colours"],
  ["f", "show all"],
  ["w a s d", "turn (3D) or move the camera; with shift always move"],
  ["+ −", "nearer, farther"],
  ["x y z", "section across x, y, z (3D)"],
  ["n", "names on or off"],
  ["g, r, e", "gauges, run, case"],
  ["p", "save a picture"],
  ["m", "save a film"],
  ["t", "light or dark page"],
  ["?", "these keys"],
];

/** What a key may do while the report is read. */
const whileReading = ["t", "?", "Escape"];

export function listen(app: App): () => void {
  const down = (event: KeyboardEvent) => {
    const target = event.target as HTMLElement;
    if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
    const tag = target.tagName;
    const typing = tag === "TEXTAREA" || tag === "SELECT" || target.isContentEditable || (tag === "INPUT" && (target as HTMLInputElement).type !== "range" && (target as HTMLInputElement).type !== "checkbox");
    if (typing && event.key !== "Escape") return;
    if (tag === "BUTTON" && (event.key === " " || event.key === "Enter")) return;
    if (tag === "INPUT" && (target as HTMLInputElement).type === "range" && !target.closest(".time") && event.key.startsWith("Arrow")) return;
    if (tag === "INPUT" && (target as HTMLInputElement).type === "checkbox" && event.key === " ") return;
    if (app.look.now.reading && !whileReading.includes(event.key)) return;
    if (act(app, event.key, event.shiftKey)) event.preventDefault();
  };
  addEventListener("keydown", down);
  return () => removeEventListener("keydown", down);
}

function act(app: App, key: string, shift: boolean): boolean {
  const { player } = app;
  const look = app.look.now;
  const times = app.shown()[0]?.frames.times ?? [];
  const eye = app.view?.eye;
  const moved = () => {
    app.view!.untouched = false;
    app.touch();
  };
  const move = (right: number, up: number) => {
    if (!eye) return;
    if (eye.dim === 3 && !shift) eye.turn(right * 0.12, up * 0.1);
    else eye.pan(-right * 40, up * 40, app.view!.cells[0]!.height);
    moved();
  };
  const zoom = (factor: number) => {
    eye?.zoom(factor, 0, 0, app.view!.aspect);
    moved();
  };
  const section = (axis: number) => {
    if (eye?.dim !== 3) return;
    const same = look.section?.axis === axis;
    app.look.change({ section: same ? null : { axis, share: look.section?.share ?? 0.5, flip: false, slice: look.section?.slice ?? false } });
  };
  const byKey: Record<string, () => void> = {
    " ": () => player.toggle(),
    k: () => player.toggle(),
    ",": () => player.step(times, -1),
    ".": () => player.step(times, 1),
    ArrowLeft: () => player.step(times, shift ? -10 : -1),
    ArrowRight: () => player.step(times, shift ? 10 : 1),
    ArrowUp: () => player.shift(1),
    ArrowDown: () => player.shift(-1),
    Home: () => player.seek(player.range[0]),
    End: () => (app.shown().some((run) => run.isLive) ? player.follow() : player.seek(player.range[1])),
    l: () => player.setLoop(!player.loop),
    c: () => app.look.change({ map: next(["water", "viridis", "cividis", "inferno"] as const, look.map) }),
    f: () => {
      app.view?.fit();
      app.touch();
    },
    w: () => move(0, 1), s: () => move(0, -1), a: () => move(-1, 0), d: () => move(1, 0),
    "+": () => zoom(0.85), "=": () => zoom(0.85), "-": () => zoom(1 / 0.85),
    x: () => section(0), y: () => section(1), z: () => section(2),
    n: () => app.look.change({ labels: !look.labels }),
    g: () => app.look.change({ tab: "gauges", side: true }),
    r: () => app.look.change({ tab: "run", side: true }),
    e: () => app.server && app.look.change({ tab: "case", side: true }),
    p: () => void savePicture(app),
    m: () => app.look.change({ dialog: "film" }),
    t: () => app.setTheme(look.theme === "dark" ? "light" : "dark"),
    "?": () => app.look.change({ dialog: look.dialog === "keys" ? "" : "keys" }),
    Escape: () => app.look.change({ dialog: "" }),
  };
  const colouring = colourings.find((c) => c.key === key);
  if (colouring && isOffered(app.shown()[0], colouring.name)) app.look.change({ colouring: colouring.name });
  else if (byKey[key]) byKey[key]!();
  else if (byKey[key.toLowerCase()] && key.length === 1) byKey[key.toLowerCase()]!();
  else return false;
  return true;
}

function next<T>(list: readonly T[], now: T): T {
  return list[(list.indexOf(now) + 1) % list.length]!;
}

export function KeysDialog({ app }: { app: App }) {
  return (
    <Dialog title="Keys" close={() => app.look.change({ dialog: "" })}>
      <dl>
        {keyList.map(([key, word]) => (
          <>
            <dt><kbd>{key}</kbd></dt>
            <dd>{word}</dd>
          </>
        ))}
      </dl>
    </Dialog>
  );
}
