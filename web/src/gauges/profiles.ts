// Levels that are drawn over the water: profiles at the time shown, and the largest level of a level map.
import type { Subject } from "../run/subject.ts";
import { block, type Table } from "../tables.ts";

/** Lines in space, one or more per profile probe; in 2D only, since a profile in 3D is a line in plan as well. */
export function profileLines(run: Subject, time: number): number[][][] {
  if (run.scene.dimension !== 2) return [];
  return run.scene.probes.flatMap((probe) => {
    if (probe.type === "level-map") return wetLines(run.map(probe.name), "largest_m");
    if (probe.type !== "profile") return [];
    const table = run.table(probe.name);
    if (!table) return [];
    const [first, end] = block(table.values[0]!, time);
    const near = Math.abs((table.values[0]![first] ?? Infinity) - time);
    return first === end || near > 0.05 * run.scene.end ? [] : wetLines(table, "connected_m", first, end); // else of another moment
  });
}

/** Lines through the levels of the places that are wet; a map has levels, a profile depths over the bed. */
export function wetLines(table: Table | undefined, column: "largest_m" | "connected_m", first = 0, end = table?.rows ?? 0): number[][][] {
  const x = table?.column("x_m");
  const height = table?.column(column);
  const bed = table?.column("bed_m");
  if (!x || !height || !bed) return [];
  const lines: number[][][] = [[]];
  for (let i = first; i < end; ++i) {
    const level = height[i]! + (column === "connected_m" ? bed[i]! : 0);
    if (Number.isFinite(level) && level > bed[i]!) lines.at(-1)!.push([x[i]!, level]);
    else if (lines.at(-1)!.length > 0) lines.push([]);
  }
  return lines;
}
