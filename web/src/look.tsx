// The panel that says how the water is drawn.
import type { App } from "./app.ts";
import { colourMaps, gradient, type ColourMap } from "./colours.ts";
import { useChanges } from "./store.ts";
import { colourings, isOffered } from "./water/value.ts";

export function LookPanel({ app }: { app: App }) {
  useChanges(app.look, app.data);
  const look = app.look.now;
  const is3d = app.shown()[0]?.scene.dimension === 3;
  const box = (name: "labels" | "walls" | "profiles", word: string) => (
    <label>
      <input type="checkbox" checked={look[name]} onChange={(e) => app.look.change({ [name]: e.currentTarget.checked })} /> {word}
    </label>
  );
  return (
    <div class="look">
      <label class="row">
        Colour by
        <select value={look.colouring} onChange={(e) => app.look.change({ colouring: e.currentTarget.value as typeof look.colouring })}>
          {colourings.filter((c) => isOffered(app.shown()[0], c.name)).map((c) => (
            <option value={c.name}>{c.title}</option>
          ))}
        </select>
      </label>
      <label class="row">
        Colours
        <select value={look.map} onChange={(e) => app.look.change({ map: e.currentTarget.value as ColourMap })}>
          {Object.keys(colourMaps).map((name) => (
            <option value={name}>{name}</option>
          ))}
        </select>
      </label>
      <div class="swatch" style={{ background: gradient(look.map) }} aria-hidden="true" />
      <label class="row">
        Size of particles
        <input type="range" min="0.4" max="2" step="0.05" value={look.size} onInput={(e) => app.look.change({ size: Number(e.currentTarget.value) })} />
      </label>
      {is3d && <SectionControls app={app} />}
      <div class="boxes">
        {box("labels", "Names")}
        {box("walls", "Walls")}
        {!is3d && box("profiles", "Measured profiles")}
      </div>
    </div>
  );
}

function SectionControls({ app }: { app: App }) {
  const { section, water } = app.look.now;
  const base = section ?? { axis: 1, share: 0.5, flip: false, slice: false };
  return (
    <>
      <label class="row">
        Water as
        <select value={water} onChange={(e) => app.look.change({ water: e.currentTarget.value as typeof water })}>
          <option value="particles">spheres</option>
          <option value="surface">surface</option>
        </select>
      </label>
      <label class="row">
        Section
        <select value={section ? String(section.axis) : ""} onChange={(e) => app.look.change({ section: e.currentTarget.value === "" ? null : { ...base, axis: Number(e.currentTarget.value) } })}>
          <option value="">none</option>
          <option value="0">across x</option>
          <option value="1">across y</option>
          <option value="2">across z</option>
        </select>
      </label>
      {section && (
        <>
          <label class="row">
            at
            <input type="range" min="0" max="1" step="0.005" value={section.share} onInput={(e) => app.look.change({ section: { ...section, share: Number(e.currentTarget.value) } })} />
          </label>
          <div class="boxes">
            <label>
              <input type="checkbox" checked={section.flip} onChange={(e) => app.look.change({ section: { ...section, flip: e.currentTarget.checked } })} /> other side
            </label>
            <label>
              <input type="checkbox" checked={section.slice} onChange={(e) => app.look.change({ section: { ...section, slice: e.currentTarget.checked } })} /> thin slice
            </label>
          </div>
        </>
      )}
    </>
  );
}
