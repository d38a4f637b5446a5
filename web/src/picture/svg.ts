// A plot as an SVG drawing, for reports.
import { niceBelow, number } from "../units.ts";

interface Curve {
  name: string;
  x: ArrayLike<number>;
  y: ArrayLike<number>;
  colour: string;
  points?: boolean;
}

const escape = (text: string) => text.replace(/[&<>"]/g, (c) => `&#${c.charCodeAt(0)};`);

export function ticks(low: number, high: number, about: number): number[] {
  if (!(high > low)) return [low];
  const coarse = (high - low) / about;
  const step = niceBelow(coarse) * (coarse / niceBelow(coarse) > 1.5 ? 2 : 1);
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  return Array.from({ length: last - first + 1 }, (_, i) => (first + i) * step);
}

export function toSvg(lines: Curve[], xLabel: string, yLabel: string, theme: { paper: string; text: string; grid: string }, title: string): string {
  const [width, height, left, right, top, bottom] = [640, 360, 64, 16, 34, 46];
  let [x0, x1, y0, y1] = [Infinity, -Infinity, Infinity, -Infinity];
  for (const line of lines) {
    for (let i = 0; i < line.x.length; ++i) {
      const [x, y] = [line.x[i]!, line.y[i]!];
      if (!Number.isFinite(x) || !Number.isFinite(y)) continue;
      [x0, x1, y0, y1] = [Math.min(x0, x), Math.max(x1, x), Math.min(y0, y), Math.max(y1, y)];
    }
  }
  if (!(x1 > x0)) [x0, x1] = [x0 - 1, x0 + 1];
  if (!(y1 > y0)) [y0, y1] = [y0 - 1, y0 + 1];
  const px = (x: number) => left + ((x - x0) / (x1 - x0)) * (width - left - right);
  const py = (y: number) => height - bottom - ((y - y0) / (y1 - y0)) * (height - top - bottom);
  const f = (v: number) => v.toFixed(2);
  const parts: string[] = [];
  for (const x of ticks(x0, x1, 6)) {
    parts.push(`<path d="M${f(px(x))} ${top}V${height - bottom}" stroke="${theme.grid}"/>`);
    parts.push(`<text x="${f(px(x))}" y="${height - bottom + 16}" text-anchor="middle">${number(x, 4)}</text>`);
  }
  for (const y of ticks(y0, y1, 5)) {
    parts.push(`<path d="M${left} ${f(py(y))}H${width - right}" stroke="${theme.grid}"/>`);
    parts.push(`<text x="${left - 6}" y="${f(py(y) + 4)}" text-anchor="end">${number(y, 4)}</text>`);
  }
  for (const line of lines) {
    if (line.points) {
      for (let i = 0; i < line.x.length; ++i) parts.push(`<circle cx="${f(px(line.x[i]!))}" cy="${f(py(line.y[i]!))}" r="2.6" fill="none" stroke="${line.colour}"/>`);
      continue;
    }
    let path = "";
    for (let i = 0; i < line.x.length; ++i) {
      if (!Number.isFinite(line.y[i]!)) continue;
      path += `${path === "" ? "M" : "L"}${f(px(line.x[i]!))} ${f(py(line.y[i]!))}`;
    }
    parts.push(`<path d="${path}" fill="none" stroke="${line.colour}" stroke-width="1.6" stroke-linejoin="round"/>`);
  }
  lines.forEach((line, i) => parts.push(`<text x="${left + 8 + 150 * i}" y="${top + 14}" style="fill:${line.colour}">${escape(line.name)}</text>`));
  return `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}" font-family="sans-serif" font-size="12" fill="${theme.text}">
<rect width="100%" height="100%" fill="${theme.paper}"/>
<text x="${left}" y="22" font-size="14" font-weight="600">${escape(title)}</text>
${parts.join("\n")}
<text x="${(left + width - right) / 2}" y="${height - 8}" text-anchor="middle">${escape(xLabel)}</text>
<text transform="translate(16 ${(top + height - bottom) / 2}) rotate(-90)" text-anchor="middle">${escape(yLabel)}</text>
</svg>
`;
}
