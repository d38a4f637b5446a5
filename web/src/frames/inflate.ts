const inflating = (bytes: Uint8Array) => new Blob([bytes as Uint8Array<ArrayBuffer>]).stream().pipeThrough(new DecompressionStream("deflate"));

/** The text in a zlib stream. */
export const inflatedText = (bytes: Uint8Array): Promise<string> => new Response(inflating(bytes)).text();

/** Inflates a zlib stream by the browser's own inflater. Throws where it is damaged or not `size` long. */
export async function inflate(bytes: Uint8Array, size: number): Promise<Uint8Array> {
  const out = new Uint8Array(size);
  const reader = inflating(bytes).getReader();
  let at = 0;
  for (;;) {
    const { done, value } = await reader.read();
    if (done) break;
    if (at + value.length > size) throw new Error(`a frame inflates to more than its ${size} bytes`);
    out.set(value, at);
    at += value.length;
  }
  if (at !== size) throw new Error(`a frame inflates to ${at} bytes, not ${size}`);
  return out;
}
