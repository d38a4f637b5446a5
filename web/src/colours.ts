// Colour maps whose lightness rises evenly, so that they are read in grey and by the colour-blind alike.
export type Rgb = [number, number, number];

const polynomial = (rows: Rgb[]) => (t: number): Rgb =>
  [0, 1, 2].map((c) => rows.reduceRight((sum, row) => sum * t + row[c]!, 0)) as Rgb;

const stops = (hex: string) => {
  const list = hex.split(" ").map((h) => [0, 2, 4].map((i) => parseInt(h.slice(i, i + 2), 16) / 255) as Rgb);
  return (t: number): Rgb => {
    const x = t * (list.length - 1);
    const i = Math.min(list.length - 2, Math.floor(x));
    return [0, 1, 2].map((c) => list[i]![c]! + (x - i) * (list[i + 1]![c]! - list[i]![c]!)) as Rgb;
  };
};

/** viridis and inferno: polynomials through matplotlib's maps (van der Walt and Smith, public domain); cividis: Nuñez,
 * Anderton and Renslow (2018); water: from deep to foam. */
export const colourMaps = {
  water: stops("0a2463 0d3b8c 1257ab 1f78c1 3595cd 58b1d8 82cade aadfe4 cdeee6"),
  viridis: polynomial([
    [0.2777273, 0.0054073, 0.3340998], [0.105093, 1.4046135, 1.3845902], [-0.3308618, 0.2148476, 0.0950952],
    [-4.6342305, -5.799101, -19.332441], [6.2282699, 14.1799334, 56.6905526], [4.7763850, -13.7451454, -65.3530326],
    [-5.4354559, 4.6458526, 26.3124352],
  ]),
  cividis: polynomial([
    [-0.0178, 0.1274, 0.3186], [-0.1386, 0.6695, 1.7347], [9.3401, 0.2071, -9.7342], [-25.1086, -0.5155, 24.1852],
    [27.5479, 0.6925, -25.9409], [-10.6297, -0.2642, 9.7085],
  ]),
  inferno: polynomial([
    [0.0002189, 0.001651, -0.0194809], [0.1065134, 0.5639564, 3.9327124], [11.6024931, -3.972854, -15.9423941],
    [-41.7039961, 17.4363989, 44.3541452], [77.1629357, -33.4023589, -81.8073093], [-71.3194282, 32.6260643, 73.2095199],
    [25.1311262, -12.242669, -23.070325],
  ]),
};

export type ColourMap = keyof typeof colourMaps;

/** 256 colours as RGBA bytes. */
export function table(name: ColourMap): Uint8Array {
  const bytes = new Uint8Array(256 * 4);
  for (let i = 0; i < 256; ++i) {
    colourMaps[name](i / 255).forEach((c, k) => (bytes[4 * i + k] = Math.round(255 * Math.min(1, Math.max(0, c)))));
    bytes[4 * i + 3] = 255;
  }
  return bytes;
}

/** The map as a CSS gradient, from left to right. */
export function gradient(name: ColourMap): string {
  const bytes = table(name);
  const at = Array.from({ length: 17 }, (_, i) => Math.round((i * 255) / 16));
  return `linear-gradient(to right, ${at.map((i) => `rgb(${bytes[4 * i]} ${bytes[4 * i + 1]} ${bytes[4 * i + 2]})`).join(", ")})`;
}

/** Colours of runs and of curves, apart for the colour-blind (Okabe and Ito), for a light and a dark page. */
export const series = {
  light: ["#0067a5", "#c44e00", "#007a57", "#a34282", "#7a6000", "#2f7fb8"],
  dark: ["#56b4e9", "#f0a03c", "#2fc49a", "#e28bc2", "#e8d44d", "#9ad1f5"],
};
