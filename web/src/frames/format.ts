// The frame files a run writes for looking, `DIR/view/NNNNN.frame`: layout in docs/reference/view.md.
// A decoded frame keeps its particles in one block of four uint16 each, as the graphics card takes them.

export const magic = "TWVF";
export const formatVersion = 1;
/** uint16 per particle of a decoded frame: x, y, z (0 in 2D), and the first two scalars as low and high byte. */
export const stride = 4;

export interface Range {
  low: number;
  high: number;
}

export interface Header {
  dim: 2 | 3;
  /** 0: a key frame; 1, 2: predicted from as many frames before. */
  order: 0 | 1 | 2;
  index: number;
  count: number;
  time: number;
  boxMin: number[];
  boxMax: number[];
  scalars: Range[];
  /** Per moving part: 2D x, y, angle; 3D x, y, z, qw, qx, qy, qz. */
  poses: number[][];
  payloadBytes: number;
  rawBytes: number;
  /** Offset of the payload in the file. */
  payload: number;
}

export interface Frame extends Header {
  /** Ascending, up to 2^53: those that come by splits begin at 2^40. Frames with equal particles share the same array. */
  ids: Float64Array;
  /** count * stride. */
  data: Uint16Array;
  /** The scalars after the first two, one number per particle. */
  more: Uint8Array[];
}

export class FrameError extends Error {}

/** Throws FrameError on what is not a frame of this format, or not whole. */
export function readHeader(bytes: Uint8Array): Header {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  let at = 0;
  const take = <T>(size: number, read: (at: number) => T): T => {
    if (at + size > bytes.length) throw new FrameError(`a frame of ${bytes.length} bytes ends inside its header`);
    const value = read(at);
    at += size;
    return value;
  };
  const u8 = () => take(1, (i) => view.getUint8(i));
  const u16 = () => take(2, (i) => view.getUint16(i, true));
  const u32 = () => take(4, (i) => view.getUint32(i, true));
  const f32 = () => take(4, (i) => view.getFloat32(i, true));
  const f64 = () => take(8, (i) => view.getFloat64(i, true));
  const list = <T>(n: number, read: () => T): T[] => Array.from({ length: n }, read);

  const mark = list(4, () => String.fromCharCode(u8())).join("");
  if (mark !== magic) throw new FrameError(`not a frame: it begins with "${mark}", not with "${magic}"`);
  const version = u16();
  if (version !== formatVersion) throw new FrameError(`a frame of format ${version}; this page reads ${formatVersion}`);
  const dim = u8();
  const order = u8();
  if ((dim !== 2 && dim !== 3) || order > 2) throw new FrameError(`a frame with dimension ${dim} and order ${order}`);
  const index = u32();
  const count = u32();
  const time = f64();
  const poseCount = u32();
  const scalarCount = u32();
  if (poseCount > 1e5 || scalarCount > 16) throw new FrameError(`a frame with ${poseCount} poses, ${scalarCount} scalars`);
  const boxMin = list(dim, f64);
  const boxMax = list(dim, f64);
  const scalars = list(scalarCount, () => ({ low: f32(), high: f32() }));
  const poses = list(poseCount, () => list(dim === 2 ? 3 : 7, f64));
  const payloadBytes = u32();
  const rawBytes = u32();
  if (at + payloadBytes > bytes.length) {
    throw new FrameError(`frame ${index} is cut off: ${bytes.length - at} of ${payloadBytes} bytes of its payload`);
  }
  return { dim, order: order as 0 | 1 | 2, index, count, time, boxMin, boxMax, scalars, poses, payloadBytes, rawBytes, payload: at };
}
