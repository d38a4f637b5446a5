// The editor: CodeMirror with colours, completion, hover and errors, and lines that the drawing marks.
import { autocompletion, completionKeymap, type CompletionContext, type CompletionResult } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap } from "@codemirror/commands";
import { HighlightStyle, syntaxHighlighting } from "@codemirror/language";
import { lintGutter, lintKeymap, setDiagnostics, type Diagnostic } from "@codemirror/lint";
import { EditorState, StateEffect, StateField, type Extension, type Text } from "@codemirror/state";
import {
  Decoration, drawSelection, EditorView, highlightActiveLine, highlightActiveLineGutter, hoverTooltip, keymap, lineNumbers, type DecorationSet,
} from "@codemirror/view";
import { tags } from "@lezer/highlight";
import type { Finding, Lines, Spec } from "../contract.ts";
import { hover, offers } from "./help.ts";
import { placeAt, toml } from "./toml.ts";

export interface EditorEvents {
  changed(text: string): void;
  /** The line that the cursor is in, from 1. */
  line(line: number): void;
  save(): void;
  run(): void;
}

const setMark = StateEffect.define<Lines | null>();
const mark = Decoration.line({ class: "cm-marked" });
const marks = StateField.define<DecorationSet>({
  create: () => Decoration.none,
  update(set, transaction) {
    let next = transaction.docChanged ? Decoration.none : set;
    for (const effect of transaction.effects) if (effect.is(setMark)) next = effect.value === null ? Decoration.none : marked(transaction.state.doc, effect.value);
    return next;
  },
  provide: (field) => EditorView.decorations.from(field),
});

function marked(doc: Text, lines: Lines): DecorationSet {
  const [first, last] = lines.map((n) => Math.min(doc.lines, Math.max(1, n))) as Lines;
  return Decoration.set(Array.from({ length: last - first + 1 }, (_, i) => mark.range(doc.line(first + i).from)));
}

const look = HighlightStyle.define([
  { tag: tags.comment, color: "var(--code-comment)" },
  { tag: tags.heading, color: "var(--code-table)", fontWeight: "600" },
  { tag: tags.propertyName, color: "var(--text)" },
  { tag: tags.string, color: "var(--code-string)" },
  { tag: [tags.number, tags.atom], color: "var(--code-number)" },
]);

const place = (doc: Text, position: number) => {
  const line = doc.lineAt(position);
  return placeAt(doc.toJSON(), line.number - 1, position - line.from);
};

export class CaseEditor {
  readonly view: EditorView;
  private spec: Spec = { tables: [] };

  constructor(holder: HTMLElement, text: string, events: EditorEvents) {
    const state = EditorState.create({
      doc: text,
      extensions: [
        lineNumbers(), highlightActiveLine(), highlightActiveLineGutter(), history(), drawSelection(), toml, syntaxHighlighting(look), lintGutter(), marks, this.help(),
        keymap.of([
          { key: "Mod-s", preventDefault: true, run: () => (events.save(), true) },
          { key: "Mod-Enter", preventDefault: true, run: () => (events.run(), true) },
          ...completionKeymap, ...lintKeymap, ...historyKeymap, ...defaultKeymap,
        ]),
        EditorView.contentAttributes.of({ "aria-label": "The case file" }),
        EditorView.updateListener.of((update) => {
          if (update.docChanged) events.changed(update.state.doc.toString());
          if (update.selectionSet || update.docChanged) events.line(update.state.doc.lineAt(update.state.selection.main.head).number);
        }),
      ],
    });
    this.view = new EditorView({ state, parent: holder });
  }

  /** Completion and hover. */
  private help(): Extension {
    const complete = (context: CompletionContext): CompletionResult | null => {
      const here = place(context.state.doc, context.pos);
      const word = context.matchBefore(here.part === "table" ? /\[\[?[\w.-]*/ : here.part === "value" ? /"?[\w.-]*/ : /[\w-]*/);
      if (!word || (word.from === word.to && !context.explicit)) return null;
      const options = offers(this.spec, here).map((o) => ({
        label: here.part === "table" ? o.insert : o.label, displayLabel: o.label, detail: o.detail, apply: o.insert, ...(o.info ? { info: o.info } : {}),
      }));
      return options.length > 0 ? { from: word.from, options, validFor: /^["[\w.-]*$/ } : null;
    };
    const tell = hoverTooltip((view, position) => {
      const found = hover(this.spec, place(view.state.doc, position));
      if (!found) return null;
      const dom = document.createElement("div");
      dom.className = "cm-help";
      const title = document.createElement("strong");
      title.textContent = found.title;
      dom.append(title, ...found.text.split("\n").map((line) => Object.assign(document.createElement("p"), { textContent: line })));
      return { pos: view.state.doc.lineAt(position).from, above: true, create: () => ({ dom }) };
    });
    return [autocompletion({ override: [complete], icons: false }), tell];
  }

  know(spec: Spec): void {
    this.spec = spec;
  }

  get text(): string {
    return this.view.state.doc.toString();
  }

  replace(text: string): void {
    this.view.dispatch({ changes: { from: 0, to: this.view.state.doc.length, insert: text }, selection: { anchor: 0 } });
  }

  /** Underlines what the program has found. */
  find(findings: Finding[]): void {
    const { doc } = this.view.state;
    const diagnostics = findings
      .filter((f) => f.line >= 1 && f.line <= doc.lines)
      .map((f): Diagnostic => {
        const line = doc.line(f.line);
        const from = Math.min(line.to, line.from + Math.max(0, f.column - 1));
        const to = f.end_column ? Math.min(line.to, line.from + f.end_column - 1) : line.to;
        return { from: Math.min(from, to), to, severity: f.severity === "note" ? "info" : f.severity, message: f.message };
      })
      .sort((a, b) => a.from - b.from);
    this.view.dispatch(setDiagnostics(this.view.state, diagnostics));
  }

  /** Marks lines and brings them into view; null: none. */
  mark(lines: Lines | null): void {
    const effects: StateEffect<unknown>[] = [setMark.of(lines)];
    if (lines) effects.push(EditorView.scrollIntoView(this.start(lines[0]), { y: "start", yMargin: 60 }));
    this.view.dispatch({ effects });
  }

  go(line: number): void {
    this.view.dispatch({ selection: { anchor: this.start(line) }, effects: EditorView.scrollIntoView(this.start(line), { y: "center" }) });
    this.view.focus();
  }

  private start(line: number): number {
    return this.view.state.doc.line(Math.min(this.view.state.doc.lines, Math.max(1, line))).from;
  }

  destroy(): void {
    this.view.destroy();
  }
}
