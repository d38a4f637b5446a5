// Levels that are drawn over the water: profiles at the time shown, and the largest level of a level map.
import type { Subject } from "../run/subject.ts";
import { block } from "../tables.ts";

/** Lines in space, one or more per profile probe; in 2D only, since a profile in 3D is a line in plan as well. */
export function profileLines(run: Subject, time: number): number[][][] {
  if (run.scene.dimension !== 2) return [];
  return run.scene.probes.flatMap((probe) => {
    if (probe.type !== "profile") return [];
    const table = run.table(probe.name);
    const x = table?.column("x_m");
    const level = table?.column("connected_m");
    const bed = table?.column("bed_m");
    if (!table || !x || !level) return [];
    const [first, end] = block(table.values[0]!, time);
    const near = Math.abs((table.values[0]![first] ?? Infinity) - time);
    if (first === end || near > 0.05 * run.scene.end) return []; // of another moment
    const lines: number[][][] = [[]];
    for (let i = first; i < end; ++i) {
      const wet = Number.isFinite(level[i]!) && level[i]! > (bed?.[i] ?? -Infinity);
      if (wet) lines.at(-1)!.push([x[i]!, level[i]!]);
      else if (lines.at(-1)!.length > 0) lines.push([]);
    }
    return lines;
  });
}
