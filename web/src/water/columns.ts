/** In how many columns `n` pictures of shape `shape` are largest on a page of shape `page` (width over height). */
export function bestColumns(n: number, page: number, shape: number): number {
  let best = 1;
  let largest = 0;
  for (let columns = 1; columns <= n; ++columns) {
    const scale = Math.min(page / columns / shape, 1 / Math.ceil(n / columns));
    if (scale > largest * 1.0001) {
      largest = scale;
      best = columns;
    }
  }
  return best;
}
