// node tests/browser/bench.mjs PAGE-FOLDER BATTEN: the figures of docs/decisions/017-studio.md, by one run in this
// machine's Chromium. Medians; milliseconds of the engine unless said otherwise.
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readdirSync, readFileSync, statSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { idle, openStudio, status } from './browser.mjs';

const [folder, batten] = process.argv.slice(2);
const models = new URL('../../../models/', import.meta.url).pathname;
const scratch = mkdtempSync(join(tmpdir(), 'studio-bench-'));
const row = (name, value) => process.stdout.write(`${name.padEnd(64)} ${value}\n`);
const median = (numbers) => [...numbers].sort((a, b) => a - b)[Math.floor(numbers.length / 2)];

function refined(model, levels) {
  const path = join(scratch, `${model}-${levels}.obj`);
  execFileSync(batten, ['subdivide', `${models}${model}.obj`, '--levels', String(levels), '-o', path, '--quiet']);
  return path;
}
/** Of what the Worker fetches, which the page's own list lacks. */
function packedSize() {
  const files = readdirSync(join(folder, 'assets')).filter((name) => /\.wasm\.br$|^worker.*\.br$/.test(name));
  return files.reduce((sum, name) => sum + statSync(join(folder, 'assets', name)).size, 0);
}
function native(path) {
  const report = join(scratch, 'report.json');
  const seconds = Array.from({ length: 5 }, () => {
    execFileSync(batten, ['interpolate', path, '-o', join(scratch, 'control.obj'), '--threads', '1', '--report', report, '--quiet']);
    return JSON.parse(readFileSync(report, 'utf8')).seconds;
  });
  return { build: median(seconds.map((one) => one.build)) * 1e3, solve: median(seconds.map((one) => one.solve)) * 1e3 };
}

const studio = await openStudio(folder);
const { page } = studio;
const readies = [];
for (let i = 0; i < 5; ++i) {
  await page.goto(studio.url);
  await studio.ready();
  readies.push(Number(await page.evaluate(() => document.documentElement.dataset.ready)));
}
row('page ready, ms (Chromium with a warm disk cache)', median(readies));
const fresh = await openStudio(folder);
row('page ready, ms (the first load)', await fresh.page.evaluate(() => document.documentElement.dataset.ready));
const fetched = () => fresh.page.evaluate(() => performance.getEntriesByType('resource').reduce((sum, one) => sum + one.encodedBodySize, 0));
row('bytes over the wire, without and with the engine (brotli)', `${await fetched()}, ${(await fetched()) + packedSize()}`);
await fresh.close();

async function open(path) {
  await page.evaluate(() => globalThis.studio.app.store.restore({ work: null, past: [], future: [] }));
  const begin = performance.now();
  await page.getByLabel('Open a file').setInputFiles(path);
  await page.waitForFunction(() => globalThis.studio.app.work !== null, null, { timeout: 120_000 });
  await idle(page);
  return performance.now() - begin;
}

for (const [model, levels] of [['tripod', 2], ['sphere', 5]]) {
  const path = refined(model, levels);
  await open(path);
  await page.evaluate(() => globalThis.studio.app.set('interpolate', { interpolate: true }));
  await idle(page);
  const vertices = await page.evaluate(() => globalThis.studio.app.work.points.length / 3);
  const moves = await page.evaluate(async () => {
    const { app } = globalThis.studio;
    const vertex = Math.floor(app.work.points.length / 7);
    const [x, y, z] = app.pointAt(vertex);
    const all = [];
    for (let i = 0; i < 40; ++i) {
      const to = [x, y, z + 0.0005 * app.work.diagonal * i];
      const begin = performance.now();
      const moved = await app.engine.run((engine) => engine.move(vertex, to, 0));
      all.push({ solve: moved.solveMs, draw: moved.drawMs, whole: performance.now() - begin });
    }
    return all.slice(5);
  });
  row(`drag, ${vertices} vertices: solve, tessellate, with the way to the page`, ['solve', 'draw', 'whole'].map((part) => median(moves.map((one) => one[part])).toFixed(2)).join(', '));
  const seconds = [];
  for (let i = 0; i < 7; ++i) {
    seconds.push(await page.evaluate(async () => {
      const { app } = globalThis.studio;
      app.set('on', { interpolate: false });
      await app.idle();
      app.set('off', { interpolate: true });
      await app.idle();
      return app.report.seconds * 1e3;
    }));
  }
  const own = native(path);
  row(`solve, ${vertices} vertices: page, native in one thread`, `${median(seconds).toFixed(1)}, ${own.solve.toFixed(1)} (with writing of results: build ${own.build.toFixed(1)})`);
}

for (const [model, levels] of [['creature', 0], ['creature', 2]]) {
  await open(refined(model, levels));
  const steps = await page.evaluate(async () => {
    const { app } = globalThis.studio;
    await app.idle();
    const wishes = { scheme: 0, boundary: 2, tension: 40, rigidity: 0.1, damping: 4, pressure: 0, gravity: 0, floor: false, holdBoundary: true };
    await app.engine.run((engine) => engine.startSculpting(wishes));
    const at = app.pointAt(0);
    await app.engine.run((engine) => engine.grab(at, 400));
    await app.engine.run((engine) => engine.pull([at[0], at[1], at[2] + 0.2 * app.work.diagonal]));
    const all = [];
    for (let i = 0; i < 40; ++i) all.push((await app.engine.run((engine) => engine.stepSculpture(1))).ms);
    await app.engine.run((engine) => engine.endSculpting());
    return all.slice(5);
  });
  const vertices = await page.evaluate(() => globalThis.studio.app.work.points.length / 3);
  row(`elastic step, ${vertices} control points`, `${median(steps).toFixed(1)} (${(1000 / median(steps)).toFixed(0)} a second)`);
}

const large = refined('creature', 5);
const opened = await open(large);
const begin = performance.now();
await page.evaluate(() => globalThis.studio.app.set('interpolate', { interpolate: true }));
await idle(page);
row(`OBJ of ${(statSync(large).size / 1e6).toFixed(0)} MB: opened and shown, interpolated and shown, s`, `${(opened / 1e3).toFixed(1)}, ${((performance.now() - begin) / 1e3).toFixed(1)}`);
row('  its memory in the engine, MB', Math.round((await page.evaluate(() => globalThis.studio.app.engine.run((engine) => engine.memory()))) / 1e6));
row('  ', await status(page));
await studio.close();
