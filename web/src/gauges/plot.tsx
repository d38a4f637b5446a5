// One plot: curves of all runs over the same axis, laboratory points, and a line at the moment that is shown. A press
// on the plot sets the moment; a drag zooms, a double click shows all again.
import uPlot from "uplot";
import { useEffect, useRef } from "preact/hooks";
import type { Player } from "../time/player.ts";
import { colours } from "../theme.ts";
import { number } from "../units.ts";

export interface Line {
  name: string;
  x: ArrayLike<number>;
  y: ArrayLike<number>;
  colour: string;
  points?: boolean;
  /** Points with a line through them. */
  joined?: boolean;
  width?: number;
  dash?: number[];
}

export interface PlotProps {
  lines: Line[];
  xLabel: string;
  yLabel: string;
  height: number;
  /** Whose time the plot is over; null: not over time. */
  player: Player | null;
  logarithmic?: boolean;
  /** Of y, that are shown to begin with. */
  limits?: [number, number] | null;
  /** A stamp that changes when the data have. */
  stamp: string;
  sync: string;
  onMake?: (plot: uPlot) => void;
}

export function Plot(props: PlotProps) {
  const holder = useRef<HTMLDivElement>(null);
  const plot = useRef<uPlot | null>(null);
  const latest = useRef(props);
  latest.current = props;

  const shape = [props.lines.map((l) => l.name + l.colour + String(l.points)).join("|"), props.xLabel, props.yLabel, document.documentElement.dataset["theme"]].join("#");
  useEffect(() => {
    const made = make(holder.current!, latest.current);
    plot.current = made;
    latest.current.onMake?.(made);
    const resize = new ResizeObserver(([entry]) => made.setSize({ width: entry!.contentRect.width, height: latest.current.height }));
    resize.observe(holder.current!);
    return () => {
      resize.disconnect();
      made.destroy();
      plot.current = null;
    };
  }, [shape, props.height]);

  useEffect(() => {
    const u = plot.current;
    if (!u) return;
    const { min, max } = u.scales["x"]!;
    const [first, last] = [u.data[0][0], u.data[0].at(-1)];
    const zoomed = min != null && max != null && first !== undefined && last !== undefined && (min > first || max < last);
    u.setData(joined(props.lines), !zoomed);
    if (zoomed) u.redraw();
  }, [props.stamp]);

  useEffect(() => {
    const { player } = props;
    if (!player) return;
    const line = document.createElement("div");
    line.className = "now";
    const move = () => {
      const u = plot.current;
      if (!u) return;
      if (line.parentElement !== u.over) u.over.append(line);
      const x = u.valToPos(player.time, "x");
      line.style.transform = `translateX(${x}px)`;
      line.hidden = !(x >= 0 && x <= u.bbox.width / uPlot.pxRatio); // to ask the element would cost a layout
    };
    move();
    const u = plot.current;
    u?.hooks.draw?.push(move);
    const stop = player.on(move);
    return () => {
      stop();
      line.remove();
    };
  }, [props.player, shape, props.height]);

  return <div class="plot" ref={holder} />;
}

function joined(lines: Line[]): uPlot.AlignedData {
  if (lines.length === 0) return [[]];
  const tables = lines.map((l) => [Array.from(l.x), Array.from(l.y)] as uPlot.AlignedData);
  return tables.length === 1 ? tables[0]! : uPlot.join(tables, tables.map(() => [2]));
}

/** As uPlot chooses it, but values that are all 0 are not shown in a range to 100. */
export const linear = (_: uPlot | null, low: number | null, high: number | null): uPlot.Range.MinMax =>
  low === null || high === null ? [null, null] : low === 0 && high === 0 ? [0, 1] : uPlot.rangeNum(low, high, 0.1, true);

function make(holder: HTMLElement, props: PlotProps): uPlot {
  const c = colours();
  const distr = props.logarithmic ? 3 : 1;
  const font = "11px system-ui, sans-serif";
  const axis = (label: string, size: number, side: number): uPlot.Axis => ({
    side, stroke: c.faint, font, labelFont: font, grid: { stroke: c.grid, width: 1 }, ticks: { stroke: c.grid, width: 1, size: 4 }, size, gap: 4,
    label, labelSize: 15, labelGap: 0, values: (_, values) => values.map((v: number | null) => (v === null ? "" : number(v, 4))),
  });
  const options: uPlot.Options = {
    width: holder.clientWidth || 320,
    height: props.height,
    padding: [8, 20, 0, 0], // room for half of the last label
    legend: { show: false },
    cursor: {
      sync: { key: props.sync, setSeries: false },
      drag: { x: true, y: false, setScale: true },
      points: { size: 6 },
      bind: {
        click: (u: uPlot) => (event: MouseEvent) => {
          if (props.player && u.select.width < 2) props.player.seek(u.posToVal(event.offsetX, "x"));
          return null;
        },
      } as never,
    },
    scales: { x: { time: false, distr, ...(props.logarithmic ? { range: around } : {}) }, y: { distr, ...(props.logarithmic ? { range: around } : { range: props.limits ?? linear }) } },
    axes: [
      { ...axis(props.xLabel, 30, 2), ...(props.logarithmic ? { splits: (u: uPlot) => u.data[0] as number[], filter: all } : {}) },
      { ...axis(props.yLabel, 52, 3), ...(props.logarithmic ? { splits: decades, filter: all } : {}) },
    ],
    series: [
      {},
      ...props.lines.map(
        (line): uPlot.Series => ({
          label: line.name, stroke: line.colour, width: line.points && !line.joined ? 0 : (line.width ?? 1.6), spanGaps: true, ...(line.dash ? { dash: line.dash } : {}),
          points: line.points ? { show: true, size: line.x.length > 60 ? 3.5 : 5, fill: c.paper, stroke: line.colour, width: 1.4 } : { show: false },
        }),
      ),
    ],
    hooks: { draw: [], setCursor: [(u) => tell(u, props.lines, holder)] },
  };
  return new uPlot(options, joined(props.lines), holder);
}

const all = (_: uPlot, splits: number[]) => splits;

/** Powers of ten; over few of them 2 and 5 times these, too. */
function decades(_: uPlot, __: number, low: number, high: number): number[] {
  const exponents = Array.from({ length: Math.ceil(Math.log10(high / low)) + 2 }, (___, i) => Math.floor(Math.log10(low)) + i);
  return exponents.flatMap((e) => (high / low < 60 ? [1, 2, 5] : [1]).map((f) => f * 10 ** e)).filter((x) => x >= low && x <= high);
}

/** With room at both ends of a logarithmic axis. */
const around = (_: uPlot, low: number, high: number): [number, number] => [low / 1.1, high * 1.1];

/** What the cursor reads, in a line under the plot's name. */
function tell(u: uPlot, lines: Line[], holder: HTMLElement): void {
  const out = holder.parentElement?.querySelector<HTMLElement>(".read");
  if (!out) return;
  const at = u.cursor.idx;
  if (at === null || at === undefined || (u.cursor.left ?? -1) < 0) {
    out.textContent = "";
    return;
  }
  const parts = lines.map((line, s) => {
    const column = u.data[s + 1]!;
    let i = at;
    for (let k = 1; k < 400 && (column[i] === null || column[i] === undefined); ++k) i = at + (k % 2 ? (k + 1) / 2 : -k / 2);
    const value = column[i];
    return value === null || value === undefined ? "" : `${lines.length > 1 ? `${line.name} ` : ""}${number(value, 4)}`;
  });
  out.textContent = `${number(u.data[0][at]!, 4)}: ${parts.filter((p) => p !== "").join("  ·  ")}`;
}
