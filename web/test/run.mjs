// Runs the tests of a kind, test/KIND/*.test.ts, in one process by Node's own runner. node test/run.mjs unit|browser|speed|pictures [name of a file]
// Exit 77: skipped, because what it takes is not installed.
import { spawnSync } from "node:child_process";
import { existsSync, mkdirSync, mkdtempSync, readdirSync, rmSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const [kind = "unit", only = ""] = process.argv.slice(2);
const skip = (why) => {
  console.log(`skipped: ${why}; remedy: scripts/install.sh web`);
  process.exit(77);
};
if (!existsSync(join(here, "../node_modules/esbuild"))) skip("web/node_modules is not installed");
// The shell has no windows to draw and takes two thirds of the time.
const chromium = [process.env.CHROMIUM, ...["chromium-headless-shell", "chromium", "chromium-browser", "google-chrome"].map((name) => `/usr/bin/${name}`)].find((path) => path && existsSync(path));
if (kind !== "unit" && !chromium) skip("there is no Chromium");
const { build } = await import("esbuild");
mkdirSync(join(here, "../build"), { recursive: true });
const out = mkdtempSync(join(here, "../build/test-"));
let status = 1;
try {
  const files = readdirSync(join(here, kind)).filter((name) => name.endsWith(".test.ts") && name.startsWith(only));
  if (files.length === 0) throw new Error(`test/${kind} has no file ${only}*.test.ts`);
  const all = join(out, "all.mjs");
  await build({
    stdin: { contents: files.map((name) => `import "./${name}";`).join("\n"), resolveDir: join(here, kind) },
    outfile: all, bundle: true, platform: "node", format: "esm",
    target: "node18", packages: "external", sourcemap: "inline", loader: { ".html": "text" },
  });
  status = spawnSync(process.execPath, ["--enable-source-maps", "--test", all], {
    stdio: "inherit", env: { ...process.env, TAILWATER_WEB: join(here, ".."), CHROMIUM: chromium },
  }).status ?? 1;
} finally {
  rmSync(out, { recursive: true, force: true });
}
process.exit(status);
