// Decodes the planes of a frame's payload into particles. Each coordinate is stored as the difference to the prediction
// of the two frames before for the same particle; a Decoder remembers these two, so frames come in order from a key
// frame on.
import { FrameError, stride, type Frame, type Header } from "./format.ts";

/** Reads LEB128 varints from a plane of ids. */
class Varints {
  constructor(private bytes: Uint8Array, public at = 0) {}

  next(): number {
    let value = 0;
    for (let scale = 1; ; scale *= 128) {
      if (this.at >= this.bytes.length) throw new FrameError("the ids of a frame are cut off");
      const byte = this.bytes[this.at++]!;
      value += (byte & 127) * scale;
      if (byte < 128) return value;
    }
  }

  u32(): number {
    if (this.at + 4 > this.bytes.length) throw new FrameError("the ids of a frame are cut off");
    const b = this.bytes;
    const i = this.at;
    this.at += 4;
    return (b[i]! | (b[i + 1]! << 8) | (b[i + 2]! << 16) | (b[i + 3]! << 24)) >>> 0;
  }

  /** `n` ascending numbers, written as differences. */
  ascending(n: number, what: string): Float64Array {
    const out = new Float64Array(n);
    let value = 0;
    for (let i = 0; i < n; ++i) {
      value += this.next();
      if (value > Number.MAX_SAFE_INTEGER) throw new FrameError(`${what} ${value} is beyond what this page counts to`);
      out[i] = value;
    }
    return out;
  }
}

/** The list of ids after `removed` (places in `before`) and `added` (ids), and where each was before (-1: new). */
export function change(before: Float64Array, removed: Float64Array, added: Float64Array): { ids: Float64Array; from: Int32Array } {
  const count = before.length - removed.length + added.length;
  const ids = new Float64Array(count);
  const from = new Int32Array(count);
  let out = 0;
  let r = 0;
  let a = 0;
  for (let i = 0; i <= before.length; ++i) {
    if (i < before.length && r < removed.length && removed[r] === i) {
      ++r;
      continue;
    }
    const limit = i < before.length ? before[i]! : Infinity;
    for (; a < added.length && added[a]! < limit; ++a) {
      ids[out] = added[a]!;
      from[out++] = -1;
    }
    if (i < before.length) {
      ids[out] = before[i]!;
      from[out++] = i;
    }
  }
  if (out !== count || r !== removed.length) throw new FrameError("removed particles that were not there");
  return { ids, from };
}

function gather<T extends Uint16Array | Uint8Array>(from: Int32Array, values: T): T {
  const out = new (values.constructor as { new (n: number): T })(from.length);
  for (let i = 0; i < from.length; ++i) if (from[i]! >= 0) out[i] = values[from[i]!]!;
  return out;
}

export class Decoder {
  private ids: Float64Array = new Float64Array(0);
  /** In how many of the last frames each particle was, 0 to 2. */
  private seen: Uint8Array = new Uint8Array(0);
  private last: Uint16Array[] = [];
  private beforeLast: Uint16Array[] = [];
  private scalars: Uint8Array[] = [];
  /** Every particle was in both of the last frames. */
  private settled = false;
  /** Index of the frame that was decoded last; -1: none. */
  index = -1;

  /** `raw` is the inflated payload. A predicted frame must follow the one decoded last. */
  decode(header: Header, raw: Uint8Array): Frame {
    if (raw.length !== header.rawBytes) throw new FrameError(`frame ${header.index}: ${raw.length} bytes, not ${header.rawBytes}`);
    const key = header.order === 0;
    if (!key && header.index !== this.index + 1) throw new FrameError(`frame ${header.index} does not follow ${this.index}`);
    this.index = -1; // until this frame stands
    const planes = new Varints(raw);
    if (key) this.begin(header, planes);
    else this.goOn(planes);
    if (this.ids.length !== header.count) throw new FrameError(`frame ${header.index} has ${this.ids.length} ids, not ${header.count}`);
    const size = header.count * (2 * header.dim + header.scalars.length);
    if (planes.at + size !== raw.length) throw new FrameError(`frame ${header.index}: its planes do not fill its payload`);

    const data = new Uint16Array(header.count * stride);
    for (let d = 0; d < header.dim; ++d) this.coordinate(d, header.order, raw.subarray(planes.at + 2 * d * header.count), data);
    for (let s = 0; s < header.scalars.length; ++s) {
      this.scalar(s, raw.subarray(planes.at + (2 * header.dim + s) * header.count), data);
    }
    const seen = this.seen;
    if (!this.settled) {
      this.settled = true;
      for (let i = 0; i < seen.length; ++i) {
        if (seen[i]! < 2) seen[i]!++;
        if (seen[i]! < 2) this.settled = false;
      }
    }
    this.index = header.index;
    return { ...header, ids: this.ids, data, more: this.scalars.slice(2).map((plane) => plane.slice()) };
  }

  private begin(header: Header, planes: Varints): void {
    const n = header.count;
    this.ids = planes.ascending(n, "id");
    this.seen = new Uint8Array(n);
    this.settled = false;
    this.last = Array.from({ length: header.dim }, () => new Uint16Array(n));
    this.beforeLast = this.last.map(() => new Uint16Array(n));
    this.scalars = header.scalars.map(() => new Uint8Array(n));
  }

  private goOn(planes: Varints): void {
    const removed = planes.ascending(planes.u32(), "place");
    const added = planes.ascending(planes.u32(), "id");
    if (removed.length === 0 && added.length === 0) return;
    const { ids, from } = change(this.ids, removed, added);
    this.ids = ids;
    this.seen = gather(from, this.seen);
    this.settled = this.settled && added.length === 0;
    this.last = this.last.map((plane) => gather(from, plane));
    this.beforeLast = this.beforeLast.map((plane) => gather(from, plane));
    this.scalars = this.scalars.map((plane) => gather(from, plane));
  }

  /** `plane`: all low bytes, then all high bytes, of the residuals of coordinate `d`. */
  private coordinate(d: number, order: number, plane: Uint8Array, data: Uint16Array): void {
    const last = this.last[d]!;
    const before = this.beforeLast[d]!;
    const seen = this.seen;
    const n = last.length;
    if (order === 2 && this.settled) {
      for (let i = 0, out = d; i < n; ++i, out += stride) {
        const coded = plane[i]! | (plane[n + i]! << 8);
        const q1 = last[i]!;
        const q = ((coded >>> 1) ^ -(coded & 1)) + 2 * q1 - before[i]!;
        before[i] = q1;
        last[i] = q;
        data[out] = q;
      }
      return;
    }
    for (let i = 0, out = d; i < n; ++i, out += stride) {
      const coded = plane[i]! | (plane[n + i]! << 8);
      let q = coded;
      if (order > 0) {
        const residual = (coded >>> 1) ^ -(coded & 1);
        const known = seen[i]!;
        const q1 = last[i]!;
        q = known === 0 ? residual : known === 1 || order === 1 ? residual + q1 : residual + 2 * q1 - before[i]!;
        before[i] = q1;
      }
      last[i] = q;
      data[out] = q;
    }
  }

  private scalar(s: number, plane: Uint8Array, data: Uint16Array): void {
    const last = this.scalars[s]!;
    for (let i = 0, out = 3; i < last.length; ++i, out += stride) {
      const value = (last[i]! + plane[i]!) & 255;
      last[i] = value;
      if (s < 2) data[out]! |= value << (8 * s);
    }
  }
}
