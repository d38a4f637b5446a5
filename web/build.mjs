// Builds dist/view.html: page, style, script and worker in one file without any address of the net in it.
// node build.mjs [FILE]   FILE: where to write, dist/view.html without it
// Beside it licences.txt: the libraries that are in the page, with their copyright. The page ends with the same text.
import { createHash } from "node:crypto";
import { mkdirSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const here = dirname(fileURLToPath(import.meta.url));
const common = { bundle: true, write: false, minify: true, target: "es2022", format: "esm", legalComments: "none", metafile: true, absWorkingDir: here, charset: "utf8" };

/** `import code from "worker:FILE"`: FILE, bundled, as a text. `inputs` gets the names of all that is in it. */
const workers = (inputs) => ({
  name: "workers",
  setup(plugin) {
    plugin.onResolve({ filter: /^worker:/ }, (found) => ({ path: join(here, "src", found.path.slice("worker:".length)), namespace: "worker" }));
    plugin.onLoad({ filter: /.*/, namespace: "worker" }, async (found) => {
      const { outputFiles, metafile } = await build({ ...common, entryPoints: [found.path], format: "iife" });
      inputs.push(...Object.keys(metafile.inputs));
      return { contents: outputFiles[0].text, loader: "text" };
    });
  },
});

/** The copyright line of a package, from its licence. Only the MIT licence is known here: another one needs a word of its own. */
function copyright(name) {
  const folder = join(here, "node_modules", name);
  const { version, license } = JSON.parse(readFileSync(join(folder, "package.json"), "utf8"));
  if (license !== "MIT") throw new Error(`build.mjs: ${name} is under ${license}; say in licences() what that asks for`);
  const file = readdirSync(folder).find((entry) => /^licen[sc]e/i.test(entry));
  const line = file && /^.*copyright.*\d{4}.*$/im.exec(readFileSync(join(folder, file), "utf8"));
  if (!line) throw new Error(`build.mjs: the licence of ${name} has no copyright line`);
  return `  ${name} ${version}: ${line[0].trim()}`;
}

/** What the licences of the libraries ask for: their copyright, and the text of the one licence that they have. */
function licences(inputs) {
  const names = inputs.map((input) => /.*node_modules\/((?:@[^/]+\/)?[^/]+)\//.exec(input)?.[1]).filter(Boolean);
  const text = readFileSync(join(here, "node_modules/fflate/LICENSE"), "utf8").replaceAll("\r", "");
  const mit = text.slice(text.indexOf("Permission is hereby granted"));
  return `The page of Tailwater's viewer holds these libraries, all under the MIT licence:\n${[...new Set(names)].sort().map(copyright).join("\n")}\n\n${mit.trim()}\n`;
}

/** What the renderer asks of a headset where there is none. */
const noHeadset = `import { EventDispatcher } from "../../core/EventDispatcher.js";
export class WebXRManager extends EventDispatcher {
  enabled = false; isPresenting = false;
  setAnimationLoop() {} dispose() {} getEnvironmentBlendMode() {} getFoveation() {} setFoveation() {} hasDepthSensing() { return false; }
}`;

/** Files of the renderer for shadows and reflections, and what it asks of them where there are none. */
const absent = [
  ["webgl/WebGLShadowMap", "export const WebGLShadowMap = function () { return { enabled: false, render() {} }; }"],
  ["webgl/WebGLEnvironments", "export const WebGLEnvironments = function () { return { get: (texture) => texture, dispose() {} }; }"],
  ["shaders/DFGLUTData", "export const getDFGLUT = () => null"],
];

/** three.js from its sources, without the texts of its own shaders, since the page brings its own, and without headsets,
    shadows and reflections. Saves 45 kB, compressed. */
const leanThree = {
  name: "lean-three",
  setup(plugin) {
    plugin.onResolve({ filter: /^three$/ }, () => ({ path: join(here, "node_modules/three/src/Three.js") }));
    plugin.onLoad({ filter: /three\/src\/renderers\/shaders\/Shader(Chunk|Lib)\/.*\.glsl\.js$/ }, () => ({ contents: 'export default ""; export const vertex = "", fragment = ""' }));
    plugin.onLoad({ filter: /three\/src\/renderers\/webxr\/WebXRManager\.js$/ }, ({ path }) => ({ contents: noHeadset, resolveDir: dirname(path) }));
    for (const [file, contents] of absent) plugin.onLoad({ filter: new RegExp(`three/src/renderers/${file}\\.js$`) }, () => ({ contents }));
  },
};

/** The page and the licences of what is in it. */
export async function page() {
  const inputs = [];
  const script = await build({ ...common, entryPoints: ["src/main.tsx"], plugins: [workers(inputs), leanThree], jsx: "automatic", jsxImportSource: "preact", define: { "process.env.NODE_ENV": '"production"' } });
  const style = await build({ ...common, entryPoints: ["src/style.css"] });
  for (const { metafile } of [script, style]) inputs.push(...Object.keys(metafile.inputs));
  const notices = licences(inputs);
  // `</script` and `<!--` inside of the script would end it; the same text in other letters does not.
  const code = script.outputFiles[0].text.trim().replace(/<\/(script)/gi, "<\\/$1").replace(/<!--/g, "<\\!--");
  const hash = createHash("sha256").update(code).digest("base64");
  const policy = [
    "default-src 'none'", `script-src 'sha256-${hash}' blob:`, "worker-src blob:", "style-src 'unsafe-inline'", "img-src 'self' data: blob:", "media-src blob:",
    "connect-src 'self'", "base-uri 'none'", "form-action 'none'",
  ].join("; ");
  const parts = { licences: notices.trim(), policy, style: style.outputFiles[0].text.trim(), script: code };
  const html = readFileSync(join(here, "src/page.html"), "utf8").replace(/\{\{(\w+)\}\}/g, (_, name) => parts[name]);
  return { html, notices };
}

if (process.argv[1] && resolve(process.argv[1]) === fileURLToPath(import.meta.url)) {
  const target = resolve(process.argv[2] ?? join(here, "dist/view.html"));
  mkdirSync(dirname(target), { recursive: true });
  const { html, notices } = await page();
  writeFileSync(target, html);
  writeFileSync(join(dirname(target), "licences.txt"), notices);
}
