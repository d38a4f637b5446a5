// What is read, over the picture: ways to its parts at the left, and the text.
import type { ComponentChildren } from "preact";
import { useEffect, useRef } from "preact/hooks";

export function Paper({ away, label, ways, children }: { away: boolean; label: string; ways: ComponentChildren; children: ComponentChildren }) {
  const all = useRef<HTMLDivElement>(null);
  useEffect(() => {
    if (!away) all.current!.focus({ preventScroll: true }); // keys scroll it
  }, [away]);
  return (
    <div class="report" ref={all} inert={away} tabIndex={0}>
      <nav aria-label={label}>{ways}</nav>
      <article>{children}</article>
    </div>
  );
}
