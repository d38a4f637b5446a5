// CSV of a run as columns, read once and then by its tail: a file that grows is never read twice.

export class Table {
  columns: string[] = [];
  /** Values by column. */
  values: number[][] = [];
  /** Bytes that were taken; the next tail begins here. */
  bytes = 0;
  private rest = "";

  get rows(): number {
    return this.values[0]?.length ?? 0;
  }

  column(name: string): number[] | undefined {
    const at = this.columns.indexOf(name);
    return at < 0 ? undefined : this.values[at];
  }

  /** Whole lines are taken; half a line waits for its end. Tables of this program are ASCII: a character is a byte. */
  append(text: string): void {
    this.bytes += text.length;
    const lines = (this.rest + text).split("\n");
    this.rest = lines.pop()!;
    for (const line of lines) this.line(line.trim());
  }

  private line(line: string): void {
    if (line === "" || line.startsWith("#")) return;
    const cells = line.split(",");
    if (this.columns.length === 0) {
      this.columns = cells.map((name) => name.trim());
      this.values = cells.map(() => []);
    } else if (cells.length === this.columns.length) {
      cells.forEach((cell, c) => this.values[c]!.push(cell === "" ? NaN : Number(cell)));
    }
  }
}

/** As it came: comma, a header with units in its names, a line per row. */
export function toCsv(columns: string[], values: ArrayLike<number>[]): string {
  const rows = Array.from({ length: values[0]?.length ?? 0 }, (_, i) => values.map((column) => String(column[i])).join(","));
  return [columns.join(","), ...rows].join("\n") + "\n";
}

/** Rows of `table` that share the time at or before `time` in its first column: first and end. */
export function block(times: number[], time: number): [number, number] {
  if (times.length === 0) return [0, 0];
  let low = 0;
  let high = times.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle]! <= time) low = middle;
    else high = middle - 1;
  }
  const at = times[low]!;
  let first = low;
  while (first > 0 && times[first - 1] === at) --first;
  let end = low + 1;
  while (end < times.length && times[end] === at) ++end;
  return [first, end];
}

/** The value at `time`, straight between two readings; NaN outside. */
export function valueAt(times: ArrayLike<number>, values: ArrayLike<number>, time: number): number {
  const n = times.length;
  if (n === 0 || time < times[0]! || time > times[n - 1]!) return NaN;
  let low = 0;
  let high = n - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle]! <= time) low = middle;
    else high = middle;
  }
  const span = times[high]! - times[low]!;
  if (span <= 0) return values[high]!;
  return values[low]! + ((time - times[low]!) / span) * (values[high]! - values[low]!);
}
