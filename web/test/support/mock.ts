// A server that answers as the program's does, with flows made of formulas; a run can be going: frames come one by one.
import { readFileSync } from "node:fs";
import { createServer, type IncomingMessage, type ServerResponse } from "node:http";
import type { AddressInfo } from "node:net";
import { join } from "node:path";
import type { Check, Info, Scene, Spec, State } from "../../src/contract.ts";
import { readHeader } from "../../src/frames/format.ts";
import { Encoder } from "./encode.ts";
import type { Flow } from "./flows.ts";

/** The page as it is built. */
export const page = readFileSync(join(process.env["TAILWATER_WEB"]!, "dist/view.html"), "utf8");

export interface MockFrame {
  index: number;
  time: number;
  key: boolean;
  bytes: Uint8Array;
}

export interface MockRun {
  id: string;
  name: string;
  scene: Scene;
  frames: MockFrame[];
  files: Record<string, string>;
  info: Info;
}

/** `frames` moments of a flow over its whole time. */
export function run(id: string, name: string, flow: Flow, frames: number, upTo = frames): MockRun {
  const encoder = new Encoder();
  const made: MockFrame[] = [];
  const files: Record<string, string> = {};
  for (const probe of flow.scene.probes) files[`probes/${probe.name}.csv`] = `time_s,${probe.columns.join(",")}\n`;
  const it: MockRun = { id, name, scene: flow.scene, frames: made, files, info: info(0, flow.scene.end) };
  for (let i = 0; i < upTo; ++i) grow(it, flow, encoder, frames);
  return Object.assign(it, { grow: () => grow(it, flow, encoder, frames) });
}

function grow(run: MockRun, flow: Flow, encoder: Encoder, frames: number): void {
  const index = run.frames.length;
  const time = (index / (frames - 1)) * flow.scene.end;
  const bytes = encoder.encode(flow.moment(time));
  run.frames.push({ index, time, key: readHeader(bytes).order === 0, bytes });
  for (const probe of flow.scene.probes) {
    for (let k = index === 0 ? 10 : 1; k <= 10; ++k) {
      const t = ((index - 1 + k / 10) / (frames - 1)) * flow.scene.end;
      run.files[`probes/${probe.name}.csv`] += `${[t, ...flow.reading(probe.name, t)].join(",")}\n`;
    }
  }
  run.info = info(time, flow.scene.end);
}

function info(time: number, end: number): Info {
  const done = time >= end;
  return {
    state: done ? "done" : "running", time, end, progress: time / end, time_left: done ? null : 12,
    lines: [
      { label: "particles", text: "2500 fluid, 458 wall, spacing 0.02 m" },
      { label: "water", text: "1000 kg at the start, 0 in, 1000 inside, 0 outside, 0 out" },
      { label: "energy", text: "1000 J at the start, 998 J now" },
      { label: "cost", text: "12 s, 3 CPU s per simulated s, 80 MB on 1 rank" },
    ],
    warnings: [], measurements: [], controls: done ? [] : ["stop", "checkpoint"],
  };
}

export interface MockOptions {
  page: string;
  runs: MockRun[];
  mode?: State["mode"];
  caseText?: string;
  check?: (text: string) => Check;
  spec?: Spec;
}

export class Mock {
  readonly token = "t0ken";
  readonly posts: string[] = [];
  private listeners = new Map<string, Set<ServerResponse>>();
  private server = createServer((request, response) => void this.answer(request, response));

  constructor(private options: MockOptions) {}

  async listen(): Promise<string> {
    await new Promise<void>((resolve) => this.server.listen(0, "127.0.0.1", resolve));
    return `http://127.0.0.1:${(this.server.address() as AddressInfo).port}/${this.token}/`;
  }

  close(): void {
    this.server.closeAllConnections();
    this.server.close();
  }

  /** The run takes one frame more, and whoever listens is told. */
  grow(id: string): void {
    const run = this.find(id) as MockRun & { grow(): void };
    run.grow();
    const { bytes, ...entry } = run.frames.at(-1)!;
    this.tell(id, "frame", { ...entry, bytes: bytes.length });
    for (const [path, text] of Object.entries(run.files)) this.tell(id, "table", { path, bytes: text.length });
    this.tell(id, "info", run.info);
  }

  tell(id: string, event: string, data: unknown): void {
    for (const response of this.listeners.get(id) ?? []) response.write(`event: ${event}\ndata: ${JSON.stringify(data)}\n\n`);
  }

  private find(id: string): MockRun {
    return this.options.runs.find((r) => r.id === id)!;
  }

  private async answer(request: IncomingMessage, response: ServerResponse): Promise<void> {
    const url = new URL(request.url!, "http://x");
    const parts = url.pathname.split("/").slice(1).map(decodeURIComponent);
    const send = (body: unknown, type = "application/json") => {
      response.setHeader("Content-Type", type);
      response.end(typeof body === "string" || body instanceof Uint8Array ? body : JSON.stringify(body));
    };
    const missing = () => {
      response.statusCode = 404;
      send({ error: `there is no ${url.pathname}` });
    };
    const nothing = () => {
      response.statusCode = 204;
      response.end();
    };
    if (parts[0] !== this.token) return missing();
    if (parts[1] === "") return send(this.options.page, "text/html; charset=utf-8");
    const { runs } = this.options;
    if (request.method === "POST") {
      let body = "";
      for await (const chunk of request) body += String(chunk);
      this.posts.push(parts.slice(2).join("/"));
      if (parts[2] === "check" || parts[2] === "estimate") return send(this.options.check?.(body) ?? { findings: [], drawing: null, summary: [] });
      if (parts[2] === "start") return send({ run: runs[0]!.id });
      return send({ ok: true });
    }
    if (parts[2] === "state") {
      return send({
        mode: this.options.mode ?? (runs.length > 1 ? "sweep" : "run"), runs: runs.map(({ id, name }) => ({ id, name, path: name })),
        case: this.options.caseText === undefined ? null : { path: "my.toml" }, version: "mock", ranks_most: 2, out: "my_run",
      } satisfies State);
    }
    if (parts[2] === "spec") return send(this.options.spec ?? { tables: [] });
    if (parts[2] === "case") return send(this.options.caseText ?? "", "text/plain");
    if (parts[2] === "sweeps") return send([{ name: "sweep", members: runs.length, done: runs.length, is_at_work: false }]);
    if (parts[2] === "templates") return send([{ name: "dam-break", title: "A column collapses in a tank" }]);
    if (parts[2] === "template") return send(`# ${parts[3]}\n[case]\ntitle = "Template"\n`, "text/plain");
    const run = runs.find((r) => r.id === parts[3]);
    if (parts[2] !== "run" || !run) return missing();
    if (parts[4] === "scene") return send(run.scene);
    if (parts[4] === "info") return send(run.info);
    if (parts[4] === "frames") {
      const from = Number(url.searchParams.get("from") ?? 0);
      return send({ frames: run.frames.filter((f) => f.index >= from).map(({ bytes, ...rest }) => ({ ...rest, bytes: bytes.length })), done: run.info.state === "done" });
    }
    if (parts[4] === "frame") {
      const frame = run.frames.find((f) => f.index === Number(parts[5]));
      return frame ? send(frame.bytes, "application/octet-stream") : nothing();
    }
    if (parts[4] === "file") {
      const text = run.files[parts.slice(5).join("/")];
      if (text === undefined) return nothing();
      const range = /^bytes=(\d+)-$/.exec(request.headers.range ?? "");
      if (!range) return send(text, "text/plain");
      const isThere = Number(range[1]) < text.length;
      response.statusCode = isThere ? 206 : 200;
      return send(isThere ? text.slice(Number(range[1])) : text, "text/plain");
    }
    if (parts[4] === "events") {
      response.writeHead(200, { "Content-Type": "text/event-stream", "Cache-Control": "no-store" });
      response.write(":\n\n");
      const set = this.listeners.get(run.id) ?? new Set();
      this.listeners.set(run.id, set.add(response));
      request.on("close", () => set.delete(response));
      return;
    }
    missing();
  }
}
