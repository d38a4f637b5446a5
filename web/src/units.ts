// Numbers as people read them, and units in print.

/** `digits` significant digits, without an exponent between 1e-4 and 1e6. */
export function number(x: number, digits = 4): string {
  if (!Number.isFinite(x)) return Number.isNaN(x) ? "none" : x > 0 ? "∞" : "−∞";
  if (x === 0) return "0";
  const size = Math.abs(x);
  if (size >= 1e6 || size < 1e-4) {
    const [mantissa, exponent] = x.toExponential(Math.max(0, digits - 1)).split("e") as [string, string];
    const shown = mantissa.includes(".") ? mantissa.replace(/\.?0+$/, "") : mantissa;
    return `${shown}·10${superscript(Number(exponent))}`.replace("-", "−");
  }
  const places = Math.max(0, digits - 1 - Math.floor(Math.log10(size)));
  const text = x.toFixed(Math.min(12, places));
  return (text.includes(".") ? text.replace(/\.?0+$/, "") : text).replace("-", "−");
}

/** With so many decimals, 0 to 12; no minus before what is rounded to 0. */
export function decimals(x: number, places: number): string {
  const text = x.toFixed(Math.max(0, Math.min(12, places)));
  return (Number(text) === 0 ? text.replace("-", "") : text).replace("-", "−");
}

/** "0.3907 ± 0.0046": two digits of the uncertainty, and the value to the same place. */
export function withUncertainty(value: number, uncertainty: number): string {
  if (!(uncertainty >= 1e-8 && uncertainty < 1e6 && Math.abs(value) < 1e6)) return `${number(value, 4)} ± ${number(uncertainty, 2)}`;
  const places = 1 - Math.floor(Math.log10(uncertainty));
  return `${decimals(value, places)} ± ${decimals(uncertainty, places)}`;
}

function superscript(n: number): string {
  return String(n).replace(/./g, (c) => (c === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[Number(c)]!));
}

/** A unit as the program writes it, "m^3/s per m", with the signs of print. */
export const printed = (unit: string) => unit.replace(/\^(\d)/g, (_, n: string) => superscript(Number(n)));

/** 1, 2 or 5 times a power of ten, at most `x`. */
export function niceBelow(x: number): number {
  const power = 10 ** Math.floor(Math.log10(x));
  return [5, 2, 1].map((f) => f * power).find((f) => f <= x * (1 + 1e-9)) ?? power;
}

/** A length of a scale bar: "5 cm", "2 m", "1 km". */
export function length(metres: number): string {
  if (metres >= 1000) return `${number(metres / 1000, 3)} km`;
  if (metres >= 1) return `${number(metres, 3)} m`;
  if (metres >= 0.01) return `${number(metres * 100, 3)} cm`;
  return `${number(metres * 1000, 3)} mm`;
}

/** "42 s", "3 min 20 s", "2 h 5 min" */
export function duration(seconds: number): string {
  if (seconds < 1) return "under 1 s";
  const s = Math.round(seconds);
  if (s < 60) return `${s} s`;
  if (s < 3600) return `${Math.floor(s / 60)} min ${s % 60} s`;
  if (s < 86400) return `${Math.floor(s / 3600)} h ${Math.floor((s % 3600) / 60)} min`;
  return `${Math.floor(s / 86400)} d ${Math.floor((s % 86400) / 3600)} h`;
}

/** How many decimals tell the frames of a run apart. */
export function timeDecimals(end: number): number {
  return end <= 0 ? 2 : Math.min(5, Math.max(1, 3 - Math.floor(Math.log10(end))));
}
