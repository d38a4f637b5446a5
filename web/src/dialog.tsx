// A dialog over the page: the browser keeps the focus in it; afterwards it is where it was.
import type { ComponentChildren } from "preact";
import { useEffect, useRef } from "preact/hooks";

export function Dialog({ title, kind = "", close, children }: { title: string; kind?: string; close: () => void; children: ComponentChildren }) {
  const box = useRef<HTMLDialogElement>(null);
  useEffect(() => {
    const dialog = box.current!;
    const before = document.activeElement as HTMLElement;
    dialog.showModal();
    return () => {
      dialog.close();
      before.focus(); // the dialog may be out of the page by now, and gives nothing back then
    };
  }, []);
  return (
    <dialog class={`dialog ${kind}`} aria-label={title} ref={box} onCancel={close}>
      <header>
        <h2>{title}</h2>
        <button autofocus onClick={close}>Close</button>
      </header>
      {children}
    </dialog>
  );
}
