// The worker: bytes of a frame in, particles out. Ids are posted only when they have changed.
import { inflate } from "./inflate.ts";
import { Decoder } from "./decode.ts";
import { readHeader, type Frame } from "./format.ts";

export interface Order {
  run: string;
  bytes: Uint8Array;
}

export type Reply =
  | { run: string; frame: Omit<Frame, "ids">; ids: Float64Array | null; milliseconds: number }
  | { run: string; error: string };

const decoders = new Map<string, { decoder: Decoder; posted: Float64Array | null }>();

async function decode(order: Order): Promise<void> {
  const began = performance.now();
  const state = decoders.get(order.run) ?? { decoder: new Decoder(), posted: null };
  decoders.set(order.run, state);
  const header = readHeader(order.bytes);
  const raw = await inflate(order.bytes.subarray(header.payload, header.payload + header.payloadBytes), header.rawBytes);
  const { ids, ...frame } = state.decoder.decode(header, raw);
  const known = ids === state.posted;
  const copy = known ? null : ids.slice();
  state.posted = ids;
  const reply: Reply = { run: order.run, frame, ids: copy, milliseconds: performance.now() - began };
  postMessage(reply, { transfer: [frame.data.buffer as ArrayBuffer, ...frame.more.map((plane) => plane.buffer as ArrayBuffer), ...(copy ? [copy.buffer] : [])] });
}

// One after the other: a frame is stored as the difference to the one before.
let queue = Promise.resolve();
onmessage = (event: MessageEvent<Order>) => {
  queue = queue.then(() =>
    decode(event.data).catch((error: unknown) => {
      const reply: Reply = { run: event.data.run, error: error instanceof Error ? error.message : String(error) };
      postMessage(reply);
    }),
  );
};
