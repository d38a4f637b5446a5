// TOML for the editor: its colours, and where in a case file a place is.
import { StreamLanguage, type StringStream } from "@codemirror/language";

interface State {
  /** After the sign `=` of a line, or inside of a list that goes over lines. */
  value: boolean;
  depth: number;
  quote: string;
}

export const toml = StreamLanguage.define<State>({
  name: "toml",
  startState: () => ({ value: false, depth: 0, quote: "" }),
  token(stream: StringStream, state: State): string | null {
    if (state.quote) {
      while (!stream.eol()) {
        if (stream.match(state.quote)) {
          state.quote = "";
          break;
        }
        stream.next();
      }
      return "string";
    }
    if (stream.sol() && state.depth === 0) state.value = false;
    if (stream.eatSpace()) return null;
    if (stream.peek() === "#") {
      stream.skipToEnd();
      return "comment";
    }
    if (stream.match('"""') || stream.match("'''")) {
      state.quote = stream.current();
      return "string";
    }
    if (stream.match(/^"(\\.|[^"\\])*"?/) || stream.match(/^'[^']*'?/)) return state.value ? "string" : "propertyName";
    return state.value ? value(stream, state) : key(stream, state);
  },
  languageData: { commentTokens: { line: "#" } },
});

function key(stream: StringStream, state: State): string | null {
  if (stream.match(/^\[\[?[^\]]*\]?\]?/)) return "heading";
  if (stream.eat("=")) {
    state.value = true;
    return "operator";
  }
  if (stream.match(/^[\w.-]+/)) return "propertyName";
  stream.next();
  return null;
}

function value(stream: StringStream, state: State): string | null {
  if (stream.match(/^[[{]/)) {
    ++state.depth;
    return "bracket";
  }
  if (stream.match(/^[\]}]/)) {
    state.depth = Math.max(0, state.depth - 1);
    return "bracket";
  }
  if (stream.match(/^(true|false)\b/)) return "atom";
  if (stream.match(/^[+-]?(\d[\d_]*)?\.?\d[\d_]*(e[+-]?\d+)?/i) || stream.match(/^[+-]?(inf|nan)\b/)) return "number";
  stream.next();
  return null;
}

export interface Place {
  /** The table that a line is in, "" before the first. */
  table: string;
  part: "table" | "key" | "value" | "comment";
  /** The key of the line. */
  key: string;
  /** Keys that this table has already. */
  present: string[];
}

const header = /^\s*\[\[?\s*([A-Za-z_][\w.-]*)\s*\]?\]?\s*(#.*)?$/;

/** Where column `column` of line `line` (from 0) of a case file is. */
export function placeAt(lines: string[], line: number, column: number): Place {
  const text = lines[line] ?? "";
  let first = line;
  while (first >= 0 && !header.test(lines[first]!)) --first;
  const table = first >= 0 ? header.exec(lines[first]!)![1]! : "";
  const present: string[] = [];
  for (let i = first + 1; i < lines.length && !header.test(lines[i]!); ++i) {
    const name = /^\s*([\w-]+)\s*=/.exec(lines[i]!)?.[1];
    if (name && i !== line) present.push(name);
  }
  const key = /^\s*([\w-]+)\s*=/.exec(text)?.[1] ?? "";
  const before = text.slice(0, column);
  const open = before.replace(/"[^"]*"/g, ""); // without whole strings
  if (/^[^"]*#/.test(open)) return { table, part: "comment", key, present };
  if (/^\s*\[\[?[\w.-]*$/.test(before) || (header.test(text) && !text.includes("="))) return { table, part: "table", key: "", present };
  return { table, part: before.includes("=") ? "value" : "key", key, present };
}
