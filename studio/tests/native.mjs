// node tests/native.mjs BATTEN PAGE_WORK: tessellation and elastic steps by the page's engine, under Node, and by the
// library itself in one thread (bench/page_work.cpp). Medians, milliseconds: a part of docs/decisions/017-studio.md.
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

const [batten, pageWork] = process.argv.slice(2);
const root = new URL('../../', import.meta.url);
const folder = new URL('build/studio/studio/engine/', root);
// Emscripten's own way into Node is older than modules.
Object.assign(globalThis, { require: createRequire(import.meta.url), __dirname: folder.pathname });
const { default: createEngine } = await import(new URL('engine.js', folder));
const engine = await createEngine({ wasmBinary: readFileSync(new URL('engine.wasm', folder)) });
const scratch = mkdtempSync(join(tmpdir(), 'studio-native-'));

const got = (result) => {
  if (result?.failure !== undefined) throw new Error(result.failure);
  return result;
};
const median = (numbers) => [...numbers].sort((a, b) => a - b)[Math.floor(numbers.length / 2)];
const time = (work) =>
  median(Array.from({ length: 25 }, () => {
    const begin = performance.now();
    work();
    return performance.now() - begin;
  }));

for (const [model, levels] of [['creature', 0], ['creature', 2], ['sphere', 5]]) {
  const path = join(scratch, `${model}.obj`);
  execFileSync(batten, ['subdivide', new URL(`models/${model}.obj`, root).pathname, '--levels', String(levels), '-o', path, '--quiet']);
  engine.FS.writeFile('/mesh.obj', readFileSync(path));
  const file = got(engine.readMesh('/mesh.obj', null));
  const plain = { scheme: 0, boundary: 2, alpha: 0, interpolate: false, fair: false, smoothing: 0, levels: 0, chord: 0, normals: new Float64Array() };
  const surface = got(engine.makeSurface(file, plain, null));
  got(surface.drawing());
  // The page hands the arrays back when it has drawn them.
  let shape = got(surface.shape(null));
  const steps = surface.report().levels;
  const { points } = file.contents();
  const elastic = got(engine.makeElastic(file, { scheme: 0, boundary: 2, tension: 40, rigidity: 0.1, damping: 4, pressure: 0, gravity: 0, floor: false, holdBoundary: true }));
  got(elastic.grab(points[0], points[1], points[2], 400));
  got(elastic.pull(points[0], points[1], points[2] + 0.2 * file.contents().diagonal));
  const page = { tessellate: time(() => (shape = got(surface.shape(shape)))), step: time(() => got(elastic.step(1))) };
  const native = JSON.parse(execFileSync(pageWork, [path, String(steps)], { encoding: 'utf8' }));
  for (const part of ['tessellate', 'step'])
    process.stdout.write(`${model}, ${points.length / 3} control points, ${part}: page ${page[part].toFixed(2)}, native ${native[part].toFixed(2)}, ${(page[part] / native[part]).toFixed(2)} times\n`);
  for (const one of [elastic, surface, file]) one.delete();
}
