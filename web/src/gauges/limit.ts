// Limit of a reading at dx = 0, and its uncertainty, by the method of scripts/extrapolate.py. The limit is that of a
// straight line over dx. Its uncertainty is the larger of two values: twice its standard error, from those of the
// means, and the largest distance of the limits of all but one of the runs.

/** Equal parts of the time, whose means give the standard error. */
const parts = 10;

export interface Mean {
  spacing: number;
  mean: number;
  error: number;
}

/** Mean of the readings from `from` to `to` and its standard error; null: fewer than ten readings. */
export function meanOf(spacing: number, time: ArrayLike<number>, value: ArrayLike<number>, from: number, to: number): Mean | null {
  const inside: number[] = [];
  for (let i = 0; i < time.length; ++i) if (time[i]! >= from && time[i]! <= to && Number.isFinite(value[i]!)) inside.push(value[i]!);
  if (inside.length < parts) return null;
  const average = (list: number[]) => list.reduce((a, b) => a + b, 0) / list.length;
  const cut = (k: number) => Math.floor(k * Math.floor(inside.length / parts) + Math.min(k, inside.length % parts));
  const means = Array.from({ length: parts }, (_, k) => average(inside.slice(cut(k), cut(k + 1))));
  const middle = average(means);
  const variance = means.reduce((sum, m) => sum + (m - middle) ** 2, 0) / (parts - 1);
  return { spacing, mean: average(inside), error: Math.sqrt(variance / parts) };
}

/** At dx = 0, of the straight line that fits best. */
function atZero(x: number[], y: number[]): number {
  const n = x.length;
  const [mx, my] = [x, y].map((list) => list.reduce((a, b) => a + b, 0) / n) as [number, number];
  const slope = x.reduce((sum, xi, i) => sum + (xi - mx) * (y[i]! - my), 0) / x.reduce((sum, xi) => sum + (xi - mx) ** 2, 0);
  return my - slope * mx;
}

/** Null where there are fewer than three different spacings. */
export function limit(means: Mean[]): { value: number; uncertainty: number } | null {
  const x = means.map((m) => m.spacing);
  if (new Set(x).size < 3 || new Set(x).size < means.length) return null;
  const y = means.map((m) => m.mean);
  const value = atZero(x, y);
  const weights = x.map((_, k) => atZero(x, x.map((__, i) => (i === k ? 1 : 0))));
  const noise = 2 * Math.hypot(...weights.map((w, k) => w * means[k]!.error));
  const without = x.map((_, k) => Math.abs(atZero(x.filter((__, i) => i !== k), y.filter((__, i) => i !== k)) - value));
  return { value, uncertainty: Math.max(noise, ...without) };
}
