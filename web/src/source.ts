// Where the page's data come from: the program's server, or the data inside of an exported page.
import { inflatedText } from "./frames/inflate.ts";
import type { Check, Info, Scene, Spec, State, SweepInfo } from "./contract.ts";

export interface FrameEntry {
  index: number;
  time: number;
  key: boolean;
  bytes: number;
}

export interface RunEvents {
  frame(entry: FrameEntry): void;
  table(path: string, bytes: number): void;
  info(info: Info): void;
  cut(time: number): void;
  gone(): void;
  /** The server does not answer (false), or answers again. */
  connected(yes: boolean): void;
}

export interface Source {
  readonly live: boolean;
  state(): Promise<State>;
  scene(run: string): Promise<Scene>;
  frames(run: string, from: number): Promise<{ frames: FrameEntry[]; done: boolean }>;
  /** null: it is gone, with the folder or because the run goes on from an earlier moment. */
  frame(run: string, index: number): Promise<Uint8Array | null>;
  /** Text of a file of the run's folder from byte `from` on, or all of it (`isWhole`); "" where there is none. */
  file(run: string, path: string, from: number): Promise<{ text: string; isWhole: boolean }>;
  info(run: string): Promise<Info>;
  /** Tells of frames from index `from` on. Returns what ends the listening. */
  listen(run: string, from: number, events: RunEvents): () => void;
  control(run: string, what: string): Promise<string>;
}

/** What only the server can do: work on a case. */
export interface Workshop {
  spec(): Promise<Spec>;
  templates(): Promise<{ name: string; title: string }[]>;
  template(name: string): Promise<string>;
  caseText(): Promise<string>;
  check(text: string, signal: AbortSignal): Promise<Check>;
  /** The same with the time that a run takes; takes a second or some. */
  estimate(text: string, signal: AbortSignal): Promise<Check>;
  save(text: string): Promise<void>;
  start(text: string, out: string, ranks: number): Promise<string>;
  sweeps(): Promise<SweepInfo[]>;
  askSweep(sweep: number, what: string): Promise<void>;
}

async function answer(path: string, options?: RequestInit): Promise<Response> {
  const response = await fetch(path, options);
  if (!response.ok) {
    const text = await response.text();
    let message = text;
    try {
      message = (JSON.parse(text) as { error?: string }).error ?? text;
    } catch {
      // not JSON: the text says it
    }
    throw new Error(message || `the program answers ${response.status} to ${path}`);
  }
  return response;
}

const json = async <T>(path: string, options?: RequestInit): Promise<T> => (await answer(path, options)).json() as Promise<T>;
const posted = (body?: string, type = "application/json"): RequestInit => ({
  method: "POST",
  headers: { "X-Tailwater": "page", "Content-Type": type },
  ...(body === undefined ? {} : { body }),
});

export class Server implements Source, Workshop {
  readonly live = true;
  state = () => json<State>("api/state");
  scene = (run: string) => json<Scene>(`api/run/${run}/scene`);
  frames = (run: string, from: number) => json<{ frames: FrameEntry[]; done: boolean }>(`api/run/${run}/frames?from=${from}`);
  info = (run: string) => json<Info>(`api/run/${run}/info`);
  spec = () => json<Spec>("api/spec");
  templates = () => json<{ name: string; title: string }[]>("api/templates");

  async frame(run: string, index: number): Promise<Uint8Array | null> {
    const response = await answer(`api/run/${run}/frame/${index}`);
    return response.status === 204 ? null : new Uint8Array(await response.arrayBuffer());
  }

  async file(run: string, path: string, from: number): Promise<{ text: string; isWhole: boolean }> {
    // From the last byte that is known, so that there is always something to answer.
    const response = await answer(`api/run/${run}/file/${path}`, from > 0 ? { headers: { Range: `bytes=${from - 1}-` } } : {});
    const text = await response.text();
    // A file that is shorter than that comes as a whole: it is another one.
    return response.status === 206 ? { text: text.slice(1), isWhole: false } : { text, isWhole: true };
  }

  listen(run: string, from: number, events: RunEvents): () => void {
    const stream = new EventSource(`api/run/${run}/events?from=${from}`);
    const on = <T>(name: string, take: (data: T) => void) =>
      stream.addEventListener(name, (event) => take(JSON.parse((event as MessageEvent<string>).data) as T));
    on<FrameEntry>("frame", events.frame);
    on<{ path: string; bytes: number }>("table", ({ path, bytes }) => events.table(path, bytes));
    on<Info>("info", events.info);
    on<{ time: number }>("cut", ({ time }) => events.cut(time));
    stream.addEventListener("gone", () => events.gone());
    stream.onopen = () => events.connected(true);
    stream.onerror = () => events.connected(false);
    return () => stream.close();
  }

  async control(run: string, what: string): Promise<string> {
    const reply = await json<{ ok?: unknown; error?: string }>(`api/run/${run}/${what}`, posted());
    return reply.error ?? "";
  }

  template = async (name: string) => (await answer(`api/template/${encodeURIComponent(name)}`)).text();
  caseText = async () => (await answer("api/case")).text();
  check = (text: string, signal: AbortSignal) => json<Check>("api/check", { ...posted(text, "application/toml"), signal });
  estimate = (text: string, signal: AbortSignal) => json<Check>("api/estimate", { ...posted(text, "application/toml"), signal });
  sweeps = () => json<SweepInfo[]>("api/sweeps");
  askSweep = async (sweep: number, what: string) => void (await answer(`api/sweep/${sweep}/${what}`, posted()));
  save = async (text: string) => void (await answer("api/save", posted(text, "application/toml")));

  async start(text: string, out: string, ranks: number): Promise<string> {
    return (await json<{ run: string }>("api/start", posted(JSON.stringify({ text, out, ranks })))).run;
  }
}

/** What `tailwater view --export` has put into the page. */
interface Bundle {
  state: State;
  runs: Record<
    string,
    /** `files`, as `data` of frames: zlib streams in base64. */
    { scene: Scene; info: Info; files: Record<string, string>; frames: (Omit<FrameEntry, "bytes"> & { data: string })[] }
  >;
}

export class Embedded implements Source {
  readonly live = false;
  private bundle: Bundle;

  constructor(text: string) {
    this.bundle = JSON.parse(text) as Bundle;
  }

  private run(id: string) {
    const run = this.bundle.runs[id];
    if (!run) throw new Error(`there is no run "${id}" in this file`);
    return run;
  }

  state = async () => this.bundle.state;
  scene = async (id: string) => this.run(id).scene;
  info = async (id: string) => this.run(id).info;
  file = async (id: string, path: string) => {
    const file = this.run(id).files[path];
    return { text: file === undefined ? "" : await inflatedText(fromBase64(file)), isWhole: true };
  };
  listen = () => () => {};
  control = async () => "an exported page cannot control a run";

  async frames(id: string, from: number) {
    const frames = this.run(id).frames.filter((f) => f.index >= from);
    return { frames: frames.map(({ index, time, key, data }) => ({ index, time, key, bytes: (data.length * 3) >> 2 })), done: true };
  }

  async frame(id: string, index: number): Promise<Uint8Array> {
    const frame = this.run(id).frames.find((f) => f.index === index);
    if (!frame) throw new Error(`frame ${index} is not in this file`);
    return fromBase64(frame.data);
  }
}

export function fromBase64(text: string): Uint8Array {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}
