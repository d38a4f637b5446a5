// Builds dist/view.html: page, style, script and worker in one file without any address of the net in it.
// node build.mjs [FILE]   FILE: where to write, dist/view.html without it
import { createHash } from "node:crypto";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const here = dirname(fileURLToPath(import.meta.url));
const common = { bundle: true, write: false, minify: true, target: "es2022", format: "esm", legalComments: "none", absWorkingDir: here, charset: "utf8" };

/** `import code from "worker:FILE"`: FILE, bundled, as a text. */
export const workers = {
  name: "workers",
  setup(plugin) {
    plugin.onResolve({ filter: /^worker:/ }, (found) => ({ path: join(here, "src", found.path.slice("worker:".length)), namespace: "worker" }));
    plugin.onLoad({ filter: /.*/, namespace: "worker" }, async (found) => {
      const { outputFiles } = await build({ ...common, entryPoints: [found.path], format: "iife" });
      return { contents: outputFiles[0].text, loader: "text" };
    });
  },
};

/** three.js from its sources, without the texts of its own shaders: the page brings its own. Saves 32 kB, compressed. */
const threeWithoutShaders = {
  name: "three-without-shaders",
  setup(plugin) {
    plugin.onResolve({ filter: /^three$/ }, () => ({ path: join(here, "node_modules/three/src/Three.js") }));
    plugin.onLoad({ filter: /three\/src\/renderers\/shaders\/Shader(Chunk|Lib)\/.*\.glsl\.js$/ }, () => ({ contents: 'export default ""; export const vertex = "", fragment = ""' }));
  },
};

export async function page() {
  const script = await build({ ...common, entryPoints: ["src/main.tsx"], plugins: [workers, threeWithoutShaders], jsx: "automatic", jsxImportSource: "preact", define: { "process.env.NODE_ENV": '"production"' } });
  const style = await build({ ...common, entryPoints: ["src/style.css"] });
  // `</script` and `<!--` inside of the script would end it; the same text in other letters does not.
  const code = script.outputFiles[0].text.trim().replace(/<\/(script)/gi, "<\\/$1").replace(/<!--/g, "<\\!--");
  const hash = createHash("sha256").update(code).digest("base64");
  const policy = [
    "default-src 'none'", `script-src 'sha256-${hash}' blob:`, "worker-src blob:", "style-src 'unsafe-inline'", "img-src 'self' data: blob:", "media-src blob:",
    "connect-src 'self'", "base-uri 'none'", "form-action 'none'",
  ].join("; ");
  const parts = { policy, style: style.outputFiles[0].text.trim(), script: code };
  return readFileSync(join(here, "src/page.html"), "utf8").replace(/\{\{(\w+)\}\}/g, (_, name) => parts[name]);
}

if (process.argv[1] && resolve(process.argv[1]) === fileURLToPath(import.meta.url)) {
  const target = resolve(process.argv[2] ?? join(here, "dist/view.html"));
  mkdirSync(dirname(target), { recursive: true });
  writeFileSync(target, await page());
}
