/** The place in an ascending list of times at or before `time`, and the share of the way to the next one, 0 to 1. */
export function bracket(list: readonly { time: number }[], time: number): { place: number; share: number } {
  let low = 0;
  let high = list.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (list[middle]!.time <= time) low = middle;
    else high = middle - 1;
  }
  const next = list[low + 1];
  const here = list[low]!.time;
  if (!next || time <= here) return { place: low, share: 0 };
  return { place: low, share: Math.min(1, (time - here) / (next.time - here)) };
}
