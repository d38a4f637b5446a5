// Icons as paths in a square of 24.
const paths = {
  play: "M7 4.5v15l13-7.5z",
  pause: "M6 5h4.5v14H6zM13.5 5H18v14h-4.5z",
  start: "M5 5h2.5v14H5zM20 5v14L9 12z",
  back: "M15.5 5v14L5 12zM17 5h2.5v14H17z",
  forward: "M8.5 5v14L19 12zM4.5 5H7v14H4.5z",
  loop: "M12 5V2L7.5 6l4.5 4V7a5 5 0 1 1-5 5H5a7 7 0 1 0 7-7z",
  sun: "M12 7a5 5 0 1 0 0 10 5 5 0 0 0 0-10zM11 1h2v3.5h-2zM11 19.5h2V23h-2zM1 11h3.5v2H1zM19.5 11H23v2h-3.5zM4.2 5.6l1.4-1.4 2.5 2.5-1.4 1.4zM15.9 17.3l1.4-1.4 2.5 2.5-1.4 1.4zM18.4 4.2l1.4 1.4-2.5 2.5-1.4-1.4zM6.7 15.9l1.4 1.4-2.5 2.5-1.4-1.4z",
  moon: "M12.5 3a9 9 0 1 0 8.5 11.8A7.2 7.2 0 0 1 12.5 3z",
  fit: "M4 9V4h5v2H6v3zM15 4h5v5h-2V6h-3zM4 15h2v3h3v2H4zM18 15h2v5h-5v-2h3z",
  camera: "M9 4h6l1.5 2.5H21V20H3V6.5h4.5zM12 9a4 4 0 1 0 0 8 4 4 0 0 0 0-8z",
  film: "M3 5h12v14H3zM16.5 10.5 21 7v10l-4.5-3.5z",
  keys: "M3 6h18v12H3zM5.5 8.5v2h2v-2zM9.5 8.5v2h2v-2zM13.5 8.5v2h2v-2zM17 8.5v2h2v-2zM7 13.5v2h10v-2z",
  side: "M3 5h18v14H3zM14.5 6.5v11h5v-11z",
  look: "M4 6h9v2H4zM17 6h3v2h-3zM14 4.5h2v5h-2zM4 16h3v2H4zM11 16h9v2h-9zM8 14.5h2v5H8zM4 11h5v2H4zM13 11h7v2h-7zM10 9.5h2v5h-2z",
};

export function Icon({ name }: { name: keyof typeof paths }) {
  return (
    <svg viewBox="0 0 24 24" width="18" height="18" aria-hidden="true" fill="currentColor" fill-rule="evenodd">
      <path d={paths[name]} />
    </svg>
  );
}
