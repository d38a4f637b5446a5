// The figures of a study: panels of curves.
import type { App } from "../app.ts";
import { series } from "../colours.ts";
import type { Figure, Panel } from "../contract.ts";
import { Plot, type Line } from "../gauges/plot.tsx";
import { useChanges } from "../store.ts";
import { colours } from "../theme.ts";

/** Dashes tell runs apart where colours do not. */
const dashes = [[], [7, 3], [2, 2], [9, 3, 2, 3]];

function lines(panel: Panel, palette: string[]): Line[] {
  const c = colours();
  const asides = [...new Set(panel.curves.filter(({ kind }) => kind === "aside").map(({ label }) => label))];
  let [run, measured] = [0, 0];
  return panel.curves.map(({ label, kind, x, y }): Line => {
    const line = { name: label, x, y: y as number[] };
    if (kind === "measured") return { ...line, colour: measured++ === 0 ? c.text : c.faint, points: true };
    if (kind === "exact") return { ...line, colour: c.text, dash: [3, 3], width: 1.2 };
    if (kind === "aside") return { ...line, colour: c.faint, width: 1, ...(asides.indexOf(label) % 2 ? { dash: [2, 2] } : {}) };
    const colour = palette[run % palette.length]!;
    const dash = dashes[run++ % dashes.length]!;
    if (kind === "particles") return { ...line, colour, points: true };
    return kind === "spacings" ? { ...line, colour, points: true, joined: true } : { ...line, colour, dash };
  });
}

/** What each line is, lines of one name once; one alone has the name of its panel. */
function Key({ lines }: { lines: Line[] }) {
  const named = lines.length > 1 ? lines.filter((line, i) => lines.findIndex((other) => other.name === line.name) === i) : [];
  return (
    <ul class="run-key">
      {named.map(({ name, colour, points, joined, dash }) => (
        <li>
          <svg width="22" height="8" aria-hidden="true" stroke={colour} fill="none">
            {(!points || joined) && <path d="M0 4h22" stroke-width="2" stroke-dasharray={dash?.join(" ")} />}
            {points && <circle cx="11" cy="4" r="2.5" />}
          </svg>{" "}
          {name}
        </li>
      ))}
    </ul>
  );
}

function OnePanel({ panel, palette, name }: { panel: Panel; palette: string[]; name: string }) {
  const drawn = lines(panel, palette);
  return (
    <div class="one-panel">
      <h3>{panel.title || panel.y}</h3>
      <div class="read" aria-live="off" />
      <Plot lines={drawn} xLabel={panel.x} yLabel={panel.title ? panel.y : ""} height={230} player={null} logarithmic={panel.logarithmic} limits={panel.limits} stamp="" sync={name} />
      <Key lines={drawn} />
    </div>
  );
}

export function Figures({ app, name, figures }: { app: App; name: string; figures: Figure[] }) {
  useChanges(app.look);
  const palette = series[app.look.now.theme];
  return (
    <>
      {figures.map(({ caption, panels, missing }, i) => (
        <figure key={caption}>
          {panels && (
            <div class="panels">
              {panels.map((panel, k) => (
                <OnePanel key={k} panel={panel} palette={palette} name={`${name}.${i}`} />
              ))}
            </div>
          )}
          <figcaption>{missing ? `Not drawn (${missing}): ${caption}` : caption}</figcaption>
        </figure>
      ))}
    </>
  );
}
