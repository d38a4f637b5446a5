// A film of the picture: the moments of a span of time, drawn one after the other and recorded as WebM.
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

/** The first kind of film that this browser can record; "" if none. */
export function filmType(): string {
  const kinds = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm", "video/mp4"];
  return typeof MediaRecorder === "undefined" ? "" : (kinds.find((kind) => MediaRecorder.isTypeSupported(kind)) ?? "");
}

/** Records the film; `tell` hears how far it is and may end it by returning false. */
export async function record(app: App, plan: FilmPlan, tell: (share: number) => boolean): Promise<Blob | null> {
  const canvas = document.createElement("canvas");
  compose(app, canvas);
  const stream = canvas.captureStream(0); // pictures on request: at a fixed rate a busy machine took none at times
  const track = stream.getVideoTracks()[0] as CanvasCaptureMediaStreamTrack;
  const recorder = new MediaRecorder(stream, { mimeType: filmType(), videoBitsPerSecond: 8e6 });
  const chunks: Blob[] = [];
  recorder.ondataavailable = (event) => chunks.push(event.data);
  const ended = new Promise<void>((resolve) => (recorder.onstop = () => resolve()));
  const taken = watch(stream);
  const n = pictures(plan);
  const before = app.player.time;
  let whole = true;
  app.recording = true;
  await shown(app, plan.from);
  compose(app, canvas);
  recorder.start();
  for (let i = 0; i < n && whole; ++i) {
    recorder.pause(); // only pictures that are ready go into the film
    await shown(app, plan.from + ((plan.to - plan.from) * i) / (n - 1));
    recorder.resume();
    compose(app, canvas);
    const isTaken = taken();
    track.requestFrame();
    await Promise.all([isTaken, new Promise((resolve) => setTimeout(resolve, 1000 / plan.rate))]);
    whole = tell((i + 1) / n);
  }
  recorder.stop();
  await ended;
  stream.getTracks().forEach((track) => track.stop());
  app.recording = false;
  app.player.seek(before);
  return whole ? new Blob(chunks, { type: recorder.mimeType }) : null;
}

/** A function whose promise resolves when the stream has taken its next picture: on a busy machine tens of milliseconds
 * after the request, when a paused recorder would miss it. */
function watch(stream: MediaStream): () => Promise<void> {
  const video = document.createElement("video");
  video.muted = true;
  video.srcObject = stream;
  void video.play().catch(() => {});
  return () =>
    new Promise((resolve) => {
      video.requestVideoFrameCallback(() => resolve());
      setTimeout(resolve, 1000); // a picture that never comes must not hold the film up
    });
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
  saveText(`${app.shown()[0]?.name ?? "tailwater"}.${film.type.includes("mp4") ? "mp4" : "webm"}`, film.type, film);
}
