declare module "worker:*" {
  /** The worker's program, bundled. */
  const code: string;
  export default code;
}
