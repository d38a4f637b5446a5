// Pointer, wheel and touch on the picture: drag turns (3D) or moves (2D), with shift or the right button always moves,
// the wheel and two fingers zoom. A press without a move is a click.
import type { WaterView } from "./view.ts";

export interface Hands {
  moved(): void;
  click(x: number, y: number): void;
  hover(x: number, y: number): void;
  leave(): void;
}

export function attach(view: WaterView, element: HTMLElement, hands: Hands): () => void {
  const down = new Map<number, { x: number; y: number }>();
  let travelled = 0;
  const at = (event: PointerEvent | WheelEvent) => {
    const box = element.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  };
  const cellAt = (x: number, y: number) =>
    view.cells.find((c) => x >= c.x && x < c.x + c.width && y >= c.y && y < c.y + c.height) ?? view.cells[0];
  const ndc = (x: number, y: number) => {
    const cell = cellAt(x, y)!;
    return { x: (2 * (x - cell.x)) / cell.width - 1, y: 1 - (2 * (y - cell.y)) / cell.height };
  };
  const listeners: [string, (event: never) => void][] = [];
  const on = <E extends Event>(name: string, handler: (event: E) => void) => {
    element.addEventListener(name, handler as EventListener, { passive: false });
    listeners.push([name, handler as (event: never) => void]);
  };

  on<PointerEvent>("pointerdown", (event) => {
    element.setPointerCapture(event.pointerId);
    down.set(event.pointerId, at(event));
    if (down.size === 1) travelled = 0;
  });
  on<PointerEvent>("pointermove", (event) => {
    const now = at(event);
    const before = down.get(event.pointerId);
    if (!before || !view.eye || view.cells.length === 0) {
      hands.hover(now.x, now.y);
      return;
    }
    const dx = now.x - before.x;
    const dy = now.y - before.y;
    travelled += Math.abs(dx) + Math.abs(dy);
    const cell = view.cells[0]!;
    if (down.size === 2) {
      const other = [...down].find(([id]) => id !== event.pointerId)![1];
      const was = Math.hypot(before.x - other.x, before.y - other.y);
      const is = Math.hypot(now.x - other.x, now.y - other.y);
      const middle = ndc((now.x + other.x) / 2, (now.y + other.y) / 2);
      if (is > 1) view.eye.zoom(was / is, middle.x, middle.y, view.aspect);
      view.eye.pan(dx / 2, dy / 2, cell.height);
    } else if (view.eye.dim === 2 || event.shiftKey || (event.buttons & 6) !== 0) {
      view.eye.pan(dx, dy, cell.height);
    } else {
      view.eye.turn((dx / cell.height) * 4, (dy / cell.height) * 3);
    }
    down.set(event.pointerId, now);
    hands.moved();
  });
  const release = (event: PointerEvent) => {
    const was = down.delete(event.pointerId);
    if (was && event.type === "pointerup" && travelled < 4) {
      const { x, y } = at(event);
      hands.click(x, y);
    }
  };
  on<PointerEvent>("pointerup", release);
  on<PointerEvent>("pointercancel", release);
  on<PointerEvent>("pointerleave", () => hands.leave());
  on<Event>("contextmenu", (event) => event.preventDefault());
  on<WheelEvent>("wheel", (event) => {
    event.preventDefault();
    if (!view.eye || view.cells.length === 0) return;
    const { x, y } = at(event);
    const point = ndc(x, y);
    const lines = event.deltaMode === 1 ? 30 : 1;
    view.eye.zoom(Math.exp(Math.max(-1, Math.min(1, event.deltaY * lines * 0.0016))), point.x, point.y, view.aspect);
    hands.moved();
  });
  return () => {
    for (const [name, handler] of listeners) element.removeEventListener(name, handler as unknown as EventListener);
  };
}
