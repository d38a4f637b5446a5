// A film of the picture: the moments of a span of time, drawn one after the other and encoded as WebM.
import { ArrayBufferTarget, Muxer } from "webm-muxer";
import type { App } from "../app.ts";
import { compose } from "./still.ts";
import { saveText } from "./save.ts";

export interface FilmPlan {
  from: number;
  to: number;
  /** Simulated seconds per second of film. */
  speed: number;
  rate: number;
}

export const pictures = (plan: FilmPlan) => Math.max(2, Math.round(((plan.to - plan.from) / plan.speed) * plan.rate) + 1);

/** Whether this browser can encode films. */
export const isFilmPossible = () => typeof VideoEncoder !== "undefined";

/** The first kind of film that this browser can encode at this size: its name in WebM and what the encoder asks for. */
async function encoding(size: { width: number; height: number }): Promise<[name: string, VideoEncoderConfig]> {
  for (const [name, codec] of [["V_VP9", "vp09.00.51.08"], ["V_VP8", "vp8"]] as const) {
    const config = { ...size, codec, bitrate: 8e6 };
    if ((await VideoEncoder.isConfigSupported(config)).supported) return [name, config];
  }
  throw new Error("This browser cannot encode films of this size; remedy: a smaller window, or Chromium, Chrome, Edge or Firefox.");
}

/** Makes the film; `tell` hears how far it is and may end it by returning false. Each picture has its own time in the film,
 * however long a busy machine took to draw it. */
export async function record(app: App, plan: FilmPlan, tell: (share: number) => boolean): Promise<Blob | null> {
  const canvas = document.createElement("canvas");
  compose(app, canvas);
  const { width, height } = canvas;
  const [codec, config] = await encoding({ width, height });
  const muxer = new Muxer({ target: new ArrayBufferTarget(), video: { codec, width, height, frameRate: plan.rate } });
  let fail: (error: Error) => void;
  const failed = new Promise<never>((_, reject) => (fail = reject));
  failed.catch(() => {}); // heard where a picture waits
  const encoder = new VideoEncoder({ output: (chunk, about) => muxer.addVideoChunk(chunk, about), error: (error) => fail(error) });
  encoder.configure(config);
  const n = pictures(plan);
  const before = app.player.time;
  let whole = true;
  app.recording = true;
  try {
    for (let i = 0; i < n && whole; ++i) {
      await shown(app, plan.from + ((plan.to - plan.from) * i) / (n - 1));
      compose(app, canvas);
      const picture = new VideoFrame(canvas, { timestamp: (1e6 * i) / plan.rate, duration: 1e6 / plan.rate });
      encoder.encode(picture, { keyFrame: i % (2 * plan.rate) === 0 }); // a player can go to each second second
      picture.close();
      while (encoder.encodeQueueSize > 8) await Promise.race([failed, new Promise((resolve) => encoder.addEventListener("dequeue", resolve, { once: true }))]);
      whole = tell((i + 1) / n);
    }
    await encoder.flush();
  } finally {
    if (encoder.state !== "closed") encoder.close();
    app.recording = false;
    app.player.seek(before);
  }
  muxer.finalize();
  return whole ? new Blob([muxer.target.buffer], { type: "video/webm" }) : null;
}

/** Shows a moment and waits until its own frames are on the screen. */
function shown(app: App, time: number): Promise<void> {
  return new Promise((resolve) => {
    app.drawn = (exact) => {
      if (!exact || Math.abs(app.player.time - time) > 1e-9 * Math.max(1, time)) return;
      app.drawn = null;
      resolve();
    };
    app.player.seek(time);
    app.touch();
  });
}

export function saveFilm(app: App, film: Blob): void {
  saveText(`${app.shown()[0]?.name ?? "tailwater"}.webm`, film.type, film);
}
