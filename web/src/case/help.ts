// Completion and hover from the program's own description of the case file.
import type { Spec, SpecKey } from "../contract.ts";
import type { Place } from "./toml.ts";

export interface Offer {
  label: string;
  detail: string;
  info: string;
  insert: string;
}

const find = (spec: Spec, table: string) => spec.tables.find((t) => t.name === table);

export function keyOf(spec: Spec, table: string, key: string): SpecKey | undefined {
  return find(spec, table)?.keys.find((k) => k.name === key);
}

/** What may stand at a place. */
export function offers(spec: Spec, place: Place): Offer[] {
  if (place.part === "comment") return [];
  if (place.part === "table") {
    return spec.tables.map((t) => ({ label: t.name, detail: t.is_list ? "any number of times" : "once", info: t.documentation, insert: t.is_list ? `[[${t.name}]]` : `[${t.name}]` }));
  }
  if (place.part === "key") {
    const keys = find(spec, place.table)?.keys ?? [];
    return keys
      .filter((k) => !place.present.includes(k.name))
      .map((k) => ({ label: k.name, detail: [k.type, k.unit].filter(Boolean).join(", "), info: describe(k), insert: `${k.name} = ` }));
  }
  const key = keyOf(spec, place.table, place.key);
  if (!key) return [];
  const plain = (word: string) => ({ label: word, detail: "", info: "", insert: word });
  if (key.choices && key.choices.length > 0) return key.choices.map((c) => plain(`"${c.replace(/^"|"$/g, "")}"`));
  if (/bool|true|yes/i.test(key.type)) return ["true", "false"].map(plain);
  return [];
}

/** A key in words: what it is, its type, unit, range and default. */
export function describe(key: SpecKey): string {
  const has = (x: unknown) => x !== undefined && x !== null && x !== "";
  const facts = [
    key.type + (key.unit ? `, ${key.unit}` : ""),
    has(key.minimum) && `${key.minimum_is_excluded ? "above" : "at least"} ${key.minimum}`,
    has(key.maximum) && `${key.maximum_is_excluded ? "below" : "at most"} ${key.maximum}`,
    key.choices && key.choices.length > 0 && `one of ${key.choices.join(", ")}`,
    key.required ? "required" : has(key.default) && `default ${String(key.default)}`,
    key.goes_with && `goes with ${key.goes_with.key} = ${key.goes_with.choices.join(", ")}`,
  ].filter(Boolean);
  return `${key.documentation}\n${facts.join("; ")}`;
}

/** What is told of the word under the pointer; null: nothing. */
export function hover(spec: Spec, place: Place): { title: string; text: string } | null {
  if (place.part === "comment") return null;
  if (place.part === "table" || place.key === "") {
    const table = find(spec, place.table);
    return table && place.part === "table" ? { title: table.is_list ? `[[${table.name}]]` : `[${table.name}]`, text: table.documentation } : null;
  }
  const key = keyOf(spec, place.table, place.key);
  return key ? { title: key.name, text: describe(key) } : null;
}
