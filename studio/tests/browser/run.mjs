// node tests/browser/run.mjs PAGE-FOLDER BATTEN [PICTURES]: the page in a real Chromium, every task by mouse or by keys,
// its files against the tool's own. Pictures for docs/studio.md are written where a folder is given.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, mkdirSync, mkdtempSync, readFileSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { AXE, axeFindings } from './axe.mjs';
import { idle, openStudio, status } from './browser.mjs';
import { diagonal, difference, readObj } from './obj.mjs';

const [folder, batten, pictures] = process.argv.slice(2);
const models = new URL('../../../models/', import.meta.url).pathname;
const known = new URL('../../../docs/pictures/studio/', import.meta.url).pathname;
/** What moves while the picture is taken. */
const MOVING = ['studio-sculpt'];
const scratch = mkdtempSync(join(tmpdir(), 'studio-files-'));
if (pictures) mkdirSync(pictures, { recursive: true });

const tool = (...words) => execFileSync(batten, [...words, '--quiet']);
const named = (page, name) => page.getByRole('button', { name, exact: true });
const shoot = async (page, name) => {
  if (!pictures) return;
  await page.waitForTimeout(600);
  const taken = await page.screenshot({ path: join(pictures, `${name}.jpg`), type: 'jpeg', quality: 88 });
  const kept = join(known, `${name}.jpg`);
  if (!existsSync(kept) || MOVING.includes(name)) return;
  const away = await unlike(page, taken, readFileSync(kept));
  assert.ok(away < 0.01, `${name} is unlike docs/pictures/studio/${name}.jpg by ${away}`);
};
/** The mean difference of two pictures, white from black being 1, where each pixel stands for 8 by 8. */
async function unlike(page, one, other) {
  const [first, second] = await page.evaluate(async (pictures) => {
    const shrunk = async (base64) => {
      const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
      const bitmap = await createImageBitmap(new Blob([bytes], { type: 'image/jpeg' }));
      const canvas = new OffscreenCanvas(Math.round(bitmap.width / 8), Math.round(bitmap.height / 8));
      const context = canvas.getContext('2d');
      context.imageSmoothingQuality = 'high';
      context.drawImage(bitmap, 0, 0, canvas.width, canvas.height);
      return [...context.getImageData(0, 0, canvas.width, canvas.height).data];
    };
    return [await shrunk(pictures[0]), await shrunk(pictures[1])];
  }, [one.toString('base64'), other.toString('base64')]);
  if (first.length !== second.length) return 1;
  return first.reduce((sum, part, i) => sum + Math.abs(part - second[i]), 0) / (255 * first.length);
}

async function open(page, path) {
  await page.getByLabel('Open a file').setInputFiles(path);
  await page.waitForTimeout(50);
  await page.waitForFunction(() => (document.querySelector('[role=status]')?.textContent ?? '') !== '');
  await idle(page);
}
async function openModel(page, name) {
  await open(page, `${models}${name}.obj`);
}
async function press(page, name) {
  await named(page, name).click();
  await idle(page);
}
async function download(page, name) {
  const [file] = await Promise.all([page.waitForEvent('download'), named(page, name).click()]);
  const path = join(scratch, file.suggestedFilename());
  await file.saveAs(path);
  return path;
}
async function expand(page, title) {
  const section = page.locator('details', { has: page.getByRole('heading', { name: title, exact: true }) });
  if ((await section.getAttribute('open')) === null) await section.locator('summary').click();
}
/** The tripod's scan as points without faces. */
function scanPoints() {
  const path = join(scratch, 'tripod-scan.xyz');
  writeFileSync(path, readObj(readFileSync(`${models}tripod-scan.obj`, 'utf8')).points.map((point) => point.join(' ')).join('\n'));
  return path;
}
/** 36 quads around, 24 around the tube. */
function fineTorus() {
  const path = join(scratch, 'torus.obj');
  const at = (i, count) => (2 * Math.PI * i) / count;
  const vertices = Array.from({ length: 36 * 24 }, (_, i) => {
    const [u, v] = [at(Math.floor(i / 24), 36), at(i % 24, 24)];
    return `v ${(3 + Math.cos(v)) * Math.cos(u)} ${(3 + Math.cos(v)) * Math.sin(u)} ${Math.sin(v)}`;
  });
  const number = (i, j) => (i % 36) * 24 + (j % 24) + 1;
  const faces = Array.from({ length: 36 * 24 }, (_, k) => {
    const [i, j] = [Math.floor(k / 24), k % 24];
    return `f ${number(i, j)} ${number(i + 1, j)} ${number(i + 1, j + 1)} ${number(i, j + 1)}`;
  });
  writeFileSync(path, [...vertices, ...faces].join('\n'));
  return path;
}
/** What a GLB says, and its numbers. */
function readGlb(path) {
  const bytes = readFileSync(path);
  const length = bytes.readUInt32LE(12);
  const json = JSON.parse(bytes.subarray(20, 20 + length).toString('utf8'));
  const binary = bytes.subarray(20 + length + 8);
  return { json, floats: new Float32Array(binary.buffer.slice(binary.byteOffset, binary.byteOffset + (binary.length & ~3))) };
}
/** Where a vertex that faces the eye is on the page. */
async function visiblePoint(page) {
  return page.evaluate(() => {
    const { app, picker } = globalThis.studio;
    const box = app.stage.canvas.getBoundingClientRect();
    const places = Array.from({ length: app.work.points.length / 3 }, (_, vertex) => ({ vertex, ...picker.screen(app.pointAt(vertex)) }));
    const free = places.filter(({ vertex, x, y }) => x > 200 && x < box.width - 200 && y > 100 && y < box.height - 200 && picker.vertex(app.work.points, x, y) === vertex);
    const one = free[Math.floor(free.length / 2)];
    return { vertex: one.vertex, x: box.left + one.x, y: box.top + one.y };
  });
}
const rows = (flat) => Array.from({ length: flat.length / 3 }, (_, i) => flat.slice(3 * i, 3 * i + 3));
const points = (page) => page.evaluate(() => [...globalThis.studio.app.work.points]);

const tasks = {
  async 'opens a file, interpolates, and says what was reached'({ page }) {
    await openModel(page, 'tripod');
    assert.match(await status(page), /212 vertices, 210 faces/);
    await press(page, 'Interpolate');
    assert.match(await status(page), /max error \d/);
    await shoot(page, 'studio');
  },

  async 'its files are those of the tool, to 1e-12'({ page }) {
    for (const model of ['tripod', 'bracket', 'icosahedron', 'cube']) {
      await openModel(page, model);
      await press(page, 'Interpolate');
      const own = join(scratch, `${model}-tool.obj`);
      tool('interpolate', `${models}${model}.obj`, '-o', own);
      const ours = readObj(readFileSync(await download(page, 'Download OBJ'), 'utf8'));
      const theirs = readObj(readFileSync(own, 'utf8'));
      const away = difference(ours, theirs) / diagonal(theirs);
      assert.ok(away < 1e-12, `${model}: ${away}`);
      const ply = await download(page, 'Download PLY');
      tool('convert', ply, '-o', join(scratch, 'back.obj'));
      const back = readObj(readFileSync(join(scratch, 'back.obj'), 'utf8'));
      assert.deepEqual(back.points, ours.points);
    }
  },

  async 'a point is dragged, the surface follows, undo and redo'({ page }) {
    await openModel(page, 'tripod');
    await press(page, 'Interpolate');
    const before = await points(page);
    const { vertex, x, y } = await visiblePoint(page);
    await page.mouse.move(x, y);
    await page.mouse.down();
    for (let i = 1; i <= 12; ++i) await page.mouse.move(x + 4 * i, y - 2 * i);
    await page.mouse.up();
    await page.waitForFunction(() => globalThis.studio.app.store.state.past.at(-1)?.label.startsWith('move'));
    await idle(page);
    const after = await points(page);
    const changed = after.flatMap((number, i) => (number === before[i] ? [] : [Math.floor(i / 3)]));
    assert.deepEqual([...new Set(changed)], [vertex]);
    // The surface drawn passes through the moved point.
    const miss = await page.evaluate((v) => {
      const { app } = globalThis.studio;
      const drawn = app.stage.surface.mesh.geometry.getAttribute('position');
      return Math.hypot(drawn.getX(v) - app.pointAt(v)[0], drawn.getY(v) - app.pointAt(v)[1], drawn.getZ(v) - app.pointAt(v)[2]);
    }, vertex);
    assert.ok(miss < 1e-5, `misses by ${miss}`);
    await shoot(page, 'studio-drag');
    // The file is that of the tool for the moved mesh.
    const ours = readObj(readFileSync(await download(page, 'Download OBJ'), 'utf8'));
    const moved = readFileSync(`${models}tripod.obj`, 'utf8').split('\n');
    let number = -1;
    writeFileSync(join(scratch, 'moved.obj'), moved.map((line) => (line.startsWith('v ') && ++number === vertex ? `v ${after.slice(3 * vertex, 3 * vertex + 3).join(' ')}` : line)).join('\n'));
    tool('interpolate', join(scratch, 'moved.obj'), '-o', join(scratch, 'moved-control.obj'));
    const theirs = readObj(readFileSync(join(scratch, 'moved-control.obj'), 'utf8'));
    assert.ok(difference(ours, theirs) < 1e-12 * diagonal(theirs));
    await press(page, 'Undo');
    assert.deepEqual(await points(page), before);
    await press(page, 'Redo');
    assert.deepEqual(await points(page), after);
  },

  async 'the same by keys alone'({ page }) {
    await openModel(page, 'tripod');
    await page.locator('#canvas').focus();
    await page.keyboard.press('i');
    await idle(page);
    assert.match(await status(page), /max error/);
    const before = await points(page);
    await page.keyboard.press('n');
    await page.keyboard.press('ArrowUp');
    await page.waitForFunction(() => globalThis.studio.app.store.state.past.at(-1)?.label === 'move point 0');
    await idle(page);
    const after = await points(page);
    assert.ok(after[2] > before[2] && after[0] === before[0]);
    await page.keyboard.press('Control+z');
    await idle(page);
    assert.deepEqual(await points(page), before);
    await page.keyboard.press('Control+y');
    await idle(page);
    assert.deepEqual(await points(page), after);
    await page.keyboard.press('?');
    assert.ok(await page.locator('#help').isVisible());
    await page.keyboard.press('Escape');
  },

  async 'colours show measures with a bar'({ page }) {
    await openModel(page, 'creature');
    await press(page, 'Interpolate');
    for (const word of ['error', 'moved', 'gaussian', 'valence', 'sharpness', 'zebra', 'mean']) {
      await page.getByLabel('Colour by', { exact: true }).selectOption(word);
      await idle(page);
      assert.equal(await page.locator('#colorbar').isVisible(), word !== 'zebra', word);
      if (word === 'zebra') await shoot(page, 'studio-zebra');
    }
    await shoot(page, 'studio-curvature');
    await page.getByLabel('Colour by', { exact: true }).selectOption('plain');
    await idle(page);
  },

  async 'a click asks a place'({ page }) {
    await openModel(page, 'torus-knot');
    await press(page, 'Interpolate');
    const at = await page.evaluate(() => {
      const { app, picker } = globalThis.studio;
      const box = app.stage.canvas.getBoundingClientRect();
      for (let y = box.height / 2; y > 50; y -= 7)
        for (let x = box.width / 2; x < box.width - 50; x += 7) if (picker.surface(x, y) && picker.vertex(app.work.points, x, y) === null) return { x: box.left + x, y: box.top + y };
      return null;
    });
    await page.mouse.click(at.x, at.y);
    await page.waitForFunction(() => !document.getElementById('probe').hidden);
    assert.match(await page.locator('#probe').textContent(), /mean curvature/);
    await shoot(page, 'studio-place');
  },

  async 'edges become creases, and smooth again'({ page }) {
    await openModel(page, 'cube');
    await page.locator('#canvas').focus();
    await page.keyboard.press('n');
    await page.keyboard.press('k');
    await idle(page);
    assert.equal(await page.evaluate(() => globalThis.studio.app.work.creases.length), 1);
    await press(page, 'Undo');
    assert.equal(await page.evaluate(() => globalThis.studio.app.work.creases.length), 0);
  },

  async 'edges become creases by the mouse, and whole loops'({ page }) {
    await open(page, fineTorus());
    const { vertex } = await visiblePoint(page);
    const middle = await page.evaluate((v) => {
      const { app, picker } = globalThis.studio;
      const box = app.stage.canvas.getBoundingClientRect();
      const next = 24 * Math.floor(v / 24) + ((v + 1) % 24); // around the tube
      const [a, b] = [app.pointAt(v), app.pointAt(next)];
      const { x, y } = picker.screen([0, 1, 2].map((i) => (a[i] + b[i]) / 2));
      return { x: box.left + x, y: box.top + y };
    }, vertex);
    const creases = () => page.evaluate(() => globalThis.studio.app.work.creases.length);
    await page.keyboard.down('Alt');
    await page.mouse.click(middle.x, middle.y);
    await idle(page);
    assert.equal(await creases(), 1);
    await page.mouse.click(middle.x, middle.y);
    await idle(page);
    assert.equal(await creases(), 0);
    await page.waitForTimeout(700);
    await page.mouse.dblclick(middle.x, middle.y);
    await idle(page);
    await page.keyboard.up('Alt');
    assert.ok([24, 36].includes(await creases()), 'a whole loop, around the tube or along it');
  },

  async 'the detail that is drawn'({ page }) {
    await openModel(page, 'cube');
    const drawn = () => page.evaluate(() => globalThis.studio.app.drawing.triangles.length / 3);
    await page.getByLabel('Detail').fill('2');
    await idle(page);
    assert.equal(await drawn(), 6 * 16 * 2);
    await page.getByLabel('Detail').fill('3');
    await idle(page);
    assert.equal(await drawn(), 6 * 64 * 2);
    await page.getByLabel('Detail').fill('0');
    await idle(page);
  },

  async 'a tolerance instead of detail'({ page }) {
    await openModel(page, 'creature');
    await page.getByLabel('Colour by', { exact: true }).selectOption('mean');
    await page.getByLabel('Tolerance', { exact: true }).selectOption('0.1');
    await idle(page);
    assert.match(await status(page), /Drawn in [\d,\u2009 ]+ triangles, nowhere farther than/);
    assert.ok(await page.locator('#colorbar').isVisible());
    const triangles = () => page.evaluate(() => globalThis.studio.app.drawing.triangles.length / 3);
    const coarse = await triangles();
    await shoot(page, 'studio-tolerance');
    await page.getByLabel('The surface as a fine mesh, not its control mesh').check();
    const ours = readObj(readFileSync(await download(page, 'Download OBJ'), 'utf8'));
    tool('subdivide', `${models}creature.obj`, '--chord', '0.1%', '-o', join(scratch, 'chord.obj'));
    const theirs = readObj(readFileSync(join(scratch, 'chord.obj'), 'utf8'));
    assert.equal(ours.points.length, theirs.points.length);
    assert.ok(difference(ours, theirs) < 1e-12 * diagonal(theirs));
    await page.getByLabel('The surface as a fine mesh, not its control mesh').uncheck();
    await page.getByLabel('Tolerance', { exact: true }).selectOption('0.01');
    await idle(page);
    assert.ok((await triangles()) > 3 * coarse);
    await page.getByLabel('Colour by', { exact: true }).selectOption('marble'); // by steps
    await idle(page);
    await page.getByLabel('Colour by', { exact: true }).selectOption('plain');
    await page.getByLabel('Tolerance', { exact: true }).selectOption('0');
    await idle(page);
    assert.doesNotMatch(await status(page), /Drawn in/);
  },

  async 'a medial model becomes the surface through its spokes\u2019 ends'({ page }) {
    for (const model of ['bean.srep.json', 'fork.json', 'bent-tube.json']) {
      await open(page, `${models}${model}`);
      assert.match(await status(page), /ends of \d+ spokes.*Interpolated: max error.*lean by at most/);
      const own = join(scratch, 'medial.obj');
      tool('medial', `${models}${model}`, '-o', own);
      const ours = readObj(readFileSync(await download(page, 'Download OBJ'), 'utf8'));
      const theirs = readObj(readFileSync(own, 'utf8'));
      assert.ok(difference(ours, theirs) < 1e-12 * diagonal(theirs), model);
    }
    await page.getByLabel('Control mesh', { exact: true }).uncheck();
    await shoot(page, 'studio-medial');
    await page.getByLabel('Control mesh', { exact: true }).check();
    await page.getByLabel('Spokes', { exact: true }).uncheck();
    await page.getByLabel('Spokes', { exact: true }).check();
    await openModel(page, 'cube');
    assert.ok(!(await page.getByLabel('Spokes', { exact: true }).isVisible()));
  },

  async 'a picture of any size, and what the size is'({ page }) {
    await openModel(page, 'cube');
    assert.ok(await page.getByText('2 × 2 × 2 in the file\u2019s unit, y is up').isVisible());
    const size = async (width) => {
      await page.getByLabel('PNG, pixels wide').fill(String(width));
      const bytes = readFileSync(await download(page, 'Download PNG'));
      return [bytes.readUInt32BE(16), bytes.readUInt32BE(20)];
    };
    const [small, large] = [await size(480), await size(2400)];
    assert.deepEqual([small[0], large[0]], [480, 2400]);
    assert.ok(Math.abs(large[1] - 5 * small[1]) <= 5);
    await page.getByLabel('PNG, pixels wide').fill('1000000');
    await press(page, 'Download PNG');
    assert.match(await status(page), /draws pictures 16 to \d+ pixels wide/);
  },

  async 'schemes, boundaries, fairness and iterations'({ page }) {
    await openModel(page, 'flag');
    await press(page, 'Interpolate');
    await page.getByLabel('Boundary', { exact: true }).selectOption('edge-and-corner');
    await idle(page);
    assert.match(await status(page), /max error/);
    await page.getByLabel('Scheme', { exact: true }).selectOption('loop');
    await idle(page);
    assert.match(await status(page), /triangles/);
    await press(page, 'Undo');
    await page.getByLabel('Fairest surface through the points').check();
    await idle(page);
    assert.match(await status(page), /max error/);
    await openModel(page, 'creature');
    await press(page, 'Interpolate');
    await press(page, 'Compare methods');
    assert.match(await status(page), /Thall 2002: \d+ iterations/);
    await shoot(page, 'studio-methods');
  },

  async 'an elastic surface is pulled'({ page }) {
    await openModel(page, 'creature');
    await press(page, 'Interpolate');
    await expand(page, 'Sculpt');
    await press(page, 'Sculpt');
    await page.waitForFunction(() => globalThis.studio.sculptor.lastMs > 0);
    const { x, y } = await page.evaluate(() => {
      const box = document.getElementById('canvas').getBoundingClientRect();
      const { picker } = globalThis.studio;
      for (let row = 60; row < box.height; row += 5)
        for (let column = 60; column < box.width - 60; column += 5) if (picker.surface(column, row)) return { x: box.left + column, y: box.top + row + 12 };
      return { x: 0, y: 0 };
    });
    await page.mouse.move(x, y);
    await page.mouse.down();
    for (let i = 1; i <= 10; ++i) await page.mouse.move(x - 12 * i, y - 4 * i);
    await page.waitForTimeout(900);
    await shoot(page, 'studio-sculpt');
    await page.mouse.up();
    const before = await points(page);
    await press(page, 'Keep');
    await page.waitForFunction(() => globalThis.studio.app.store.state.past.at(-1)?.label === 'sculpt');
    await idle(page);
    const moved = Math.max(...(await points(page)).map((number, i) => Math.abs(number - before[i])));
    assert.ok(moved > 1e-3, `moved ${moved}`);
  },

  async 'an elastic surface is held, refined and kept'({ page }) {
    await openModel(page, 'tripod');
    await expand(page, 'Sculpt');
    await press(page, 'Sculpt');
    const middle = await page.evaluate(() => {
      const box = globalThis.studio.app.stage.canvas.getBoundingClientRect();
      return { x: box.left + box.width / 2, y: box.top + box.height / 2 - 60 };
    });
    await page.keyboard.down('Alt');
    await page.mouse.click(middle.x, middle.y);
    await page.keyboard.up('Alt');
    await page.waitForFunction(() => document.querySelector('[role=status]').textContent.includes('1 place is held'));
    await press(page, 'Refine');
    await page.waitForFunction(() => document.querySelector('[role=status]').textContent.includes('Refined: 842 control points'));
    await press(page, 'Keep');
    await page.waitForFunction(() => globalThis.studio.app.store.state.past.at(-1)?.label === 'sculpt');
    await idle(page);
    assert.match(await status(page), /842 vertices, 840 faces/);
    await press(page, 'Undo');
    assert.match(await status(page), /212 vertices, 210 faces/);
  },

  async 'denoise and bands'({ page }) {
    await openModel(page, 'creature');
    const before = await points(page);
    await expand(page, 'Smooth and bands');
    await press(page, 'Denoise');
    tool('denoise', `${models}creature.obj`, '--passes', '4', '-o', join(scratch, 'smooth.obj'));
    const own = readObj(readFileSync(join(scratch, 'smooth.obj'), 'utf8'));
    const away = difference(own, { ...own, points: rows(await points(page)) });
    assert.ok(away < 1e-12 * diagonal(own), `${away}`);
    await press(page, 'Undo');
    assert.deepEqual(await points(page), before);
    await press(page, 'Mix the bands');
    assert.deepEqual(await points(page), before); // gains of 1 change no bit
  },

  async 'broken meshes are told and repaired; hostile files are refused'({ page }) {
    await openModel(page, 'broken-tripod');
    assert.match(await status(page), /edge|vertex|face/);
    await shoot(page, 'studio-broken');
    await press(page, 'Repair');
    assert.match(await status(page), /Repaired/);
    await press(page, 'Interpolate');
    assert.match(await status(page), /max error/);
    const hostile = {
      'claims.ply': 'ply\nformat binary_little_endian 1.0\nelement vertex 1000000000\nproperty double x\nproperty double y\nproperty double z\nend_header\nabc',
      'number.obj': 'v 1 2\n', 'range.obj': 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n', 'nan.obj': 'v 0 0 nan\n', 'short.stl': 'solid x\nfacet', 'text.off': 'OFF\n9 9 9\n1', 'word.xyz': '1 2 three\n', 'empty.obj': '',
    };
    for (const [name, content] of Object.entries(hostile)) {
      const path = join(scratch, name);
      writeFileSync(path, content);
      await open(page, path);
      assert.ok(await page.evaluate(() => document.getElementById('status').classList.contains('error')) || name === 'empty.obj', name);
    }
    await openModel(page, 'cube');
    assert.match(await status(page), /8 vertices, 6 faces/);
  },

  async 'a shape morphs into another'({ page }) {
    await openModel(page, 'creature');
    await expand(page, 'Morph');
    await page.getByLabel('The shape to morph into').setInputFiles(`${models}creature-ball.obj`);
    await idle(page);
    await page.getByLabel('Time').fill('0.5');
    await page.waitForFunction(() => globalThis.studio.app.store.state.past.at(-1)?.label === 'morph to 0.5');
    await idle(page);
    tool('morph', `${models}creature.obj`, `${models}creature-ball.obj`, '--at', '0.5', '-o', join(scratch, 'half.obj'));
    const own = readObj(readFileSync(join(scratch, 'half.obj'), 'utf8'));
    const away = difference(own, { ...own, points: rows(await points(page)) });
    assert.ok(away < 1e-12 * diagonal(own), `${away}`);
  },

  async 'a link opens to the same work'({ page, ready }) {
    await openModel(page, 'cube');
    await press(page, 'Interpolate');
    const before = await points(page);
    await press(page, 'Copy a link');
    await page.waitForFunction(() => location.hash.startsWith('#work='));
    await press(page, 'Clear');
    await page.reload();
    await ready();
    await page.waitForFunction(() => (document.querySelector('[role=status]')?.textContent ?? '').includes('max error'));
    assert.deepEqual(await points(page), before);
    await page.evaluate(() => history.replaceState(null, '', location.pathname));
  },

  async 'a normal is turned by its arrow, and by numbers'({ page }) {
    await openModel(page, 'creature');
    await press(page, 'Interpolate');
    await expand(page, 'Points and creases');
    const { vertex } = await visiblePoint(page);
    await page.evaluate((v) => globalThis.studio.app.pick(v), vertex);
    await press(page, 'Normal');
    assert.match(await status(page), /Normals within/);
    const before = await points(page);
    const arrow = () => page.evaluate(() => {
      const { app, picker } = globalThis.studio;
      const box = app.stage.canvas.getBoundingClientRect();
      const { tip } = app.stage.arrows.tips()[0];
      const { x, y } = picker.screen(tip);
      return { x: box.left + x, y: box.top + y, direction: app.work.settings.normals[0].direction };
    });
    const first = await arrow();
    await page.mouse.move(first.x, first.y);
    await page.mouse.down();
    for (let i = 1; i <= 5; ++i) await page.mouse.move(first.x + 5 * i, first.y - 4 * i);
    await page.mouse.up();
    await page.waitForFunction(() => globalThis.studio.app.store.state.past.at(-1)?.label.startsWith('normal at point'));
    await idle(page);
    const turned = await arrow();
    assert.ok(Math.hypot(...turned.direction.map((part, i) => part - first.direction[i])) > 0.05);
    assert.ok(Math.hypot(turned.x - first.x - 25, turned.y - first.y + 20) < 12, 'the arrow follows the hand');
    assert.match(await status(page), /Normals within \S+.* degrees/);
    assert.deepEqual(await points(page), before);
    await shoot(page, 'studio-normal');
    const reached = await page.evaluate((v) => [...globalThis.studio.app.drawing.normals.subarray(3 * v, 3 * v + 3)], vertex);
    assert.ok(Math.hypot(...turned.direction.map((part, i) => part - reached[i])) < 1e-5);
    // The same as the tool with the file of normals.
    const normals = await download(page, 'Download normals');
    tool('interpolate', `${models}creature.obj`, '--normals', normals, '-o', join(scratch, 'turned.obj'));
    const own = readObj(readFileSync(await download(page, 'Download OBJ'), 'utf8'));
    const its = readObj(readFileSync(join(scratch, 'turned.obj'), 'utf8'));
    assert.ok(difference(own, its) < 1e-12 * diagonal(own));
    await page.getByLabel('normal x').fill('1');
    await page.getByLabel('normal x').blur();
    await idle(page);
    assert.ok((await arrow()).direction[0] === 1);
    await press(page, 'Normal');
    assert.doesNotMatch(await status(page), /Normals/);
  },

  async 'a film of a morph is the tool\u2019s'({ page }) {
    await openModel(page, 'creature');
    await expand(page, 'Morph');
    await page.getByLabel('The shape to morph into').setInputFiles(`${models}creature-ball.obj`);
    await idle(page);
    const film = await download(page, 'Download film');
    tool('morph', `${models}creature.obj`, `${models}creature-ball.obj`, '-o', join(scratch, 'film.glb'));
    const [ours, theirs] = [film, join(scratch, 'film.glb')].map(readGlb);
    const shape = ({ json }) => json.accessors.map(({ count, type, componentType }) => ({ count, type, componentType }));
    assert.deepEqual(shape(ours), shape(theirs));
    assert.deepEqual(ours.json.animations, theirs.json.animations);
    assert.ok(!ours.floats.some((number, i) => Math.abs(number - theirs.floats[i]) > 1e-5), 'the same numbers');
  },

  async 'memory is used again: ten times open and close'({ page }) {
    const large = join(scratch, 'large.obj');
    tool('subdivide', `${models}creature.obj`, '--levels', '3', '-o', large);
    const taken = [];
    for (let i = 0; i < 10; ++i) {
      await open(page, large);
      await press(page, 'Interpolate');
      taken.push(await page.evaluate(() => globalThis.studio.app.engine.run((engine) => engine.memory())));
    }
    assert.equal(taken[9], taken[2], `${taken}`);
    await press(page, 'Clear');
  },

  async 'fingers: one drags a point, a tap with two undoes'() {
    const phone = await openStudio(folder, { hasTouch: true, viewport: { width: 390, height: 800 } });
    const { page } = phone;
    try {
      await openModel(page, 'tripod');
      await press(page, 'Interpolate');
      const before = await points(page);
      const at = await page.evaluate(() => {
        const { app, picker } = globalThis.studio;
        const box = app.stage.canvas.getBoundingClientRect();
        const places = Array.from({ length: app.work.points.length / 3 }, (_, vertex) => ({ vertex, ...picker.screen(app.pointAt(vertex)) }));
        const one = places.find(({ vertex, x, y }) => x > 60 && x < box.width - 120 && y > 60 && y < box.height - 120 && picker.vertex(app.work.points, x, y) === vertex);
        return { x: box.left + one.x, y: box.top + one.y };
      });
      const touch = await phone.context.newCDPSession(page);
      const send = (type, ...fingers) => touch.send('Input.dispatchTouchEvent', { type, touchPoints: fingers.map(([x, y], id) => ({ x, y, id })) });
      await send('touchStart', [at.x, at.y]);
      for (let i = 1; i <= 6; ++i) await send('touchMove', [at.x + 6 * i, at.y]);
      await send('touchEnd');
      await page.waitForFunction(() => globalThis.studio.app.store.state.past.at(-1)?.label.startsWith('move'));
      await idle(page);
      assert.notDeepEqual(await points(page), before);
      await Promise.all([send('touchStart', [120, 200], [220, 200]), send('touchEnd')]); // a tap, however busy the page is
      await page.waitForFunction(() => globalThis.studio.app.store.state.future.length > 0);
      await idle(page);
      assert.deepEqual(await points(page), before);
    } finally {
      await phone.close();
    }
  },

  async 'distances of other points are those of the tool'({ page }) {
    await openModel(page, 'tripod');
    await press(page, 'Interpolate');
    const scan = scanPoints();
    await page.getByLabel('Points to measure from the surface').setInputFiles(scan);
    await page.waitForFunction(() => (document.querySelector('[role=status]')?.textContent ?? '').includes('rms'));
    const said = await status(page);
    const report = join(scratch, 'distance.json');
    tool('interpolate', `${models}tripod.obj`, '-o', join(scratch, 'surface.obj'));
    tool('distance', scan, join(scratch, 'surface.obj'), '--report', report);
    const { max } = JSON.parse(readFileSync(report, 'utf8'));
    assert.ok(said.includes(`at most ${Number(max.toPrecision(4))},`), `${said} ${max}`);
    await shoot(page, 'studio-distance');
  },

  async 'another scheme stands beside, with how far it leaves the points'({ page }) {
    await openModel(page, 'pipe-joint');
    await press(page, 'Interpolate');
    await page.getByLabel('Beside it').selectOption('catmull-clark');
    await page.waitForFunction(() => (document.querySelector('[role=status]')?.textContent ?? '').includes('leaves the points'));
    await idle(page);
    assert.match(await status(page), /by up to \d/);
    const captions = await page.locator('.captions span').allTextContents();
    assert.match(captions.join('; '), /^Catmull-Clark through the points; Catmull-Clark, up to [\d.]+ % off the points$/);
    await shoot(page, 'studio-beside');
    await page.getByLabel('Beside it').selectOption('none');
    await idle(page);
    assert.equal(await page.locator('.captions').isVisible(), false);
  },

  async 'textures'({ page }) {
    await openModel(page, 'torus-knot');
    await press(page, 'Interpolate');
    await page.getByLabel('Points', { exact: true }).uncheck();
    await page.getByLabel('Control mesh', { exact: true }).uncheck();
    await page.getByLabel('Colour by', { exact: true }).selectOption('marble');
    await idle(page);
    await shoot(page, 'studio-texture');
    await page.getByLabel('Points', { exact: true }).check();
    await page.getByLabel('Control mesh', { exact: true }).check();
    await page.getByLabel('Colour by', { exact: true }).selectOption('plain');
    await idle(page);
  },

  async 'points get a surface'({ page }) {
    const scan = readObj(readFileSync(`${models}bracket-scan.obj`, 'utf8'));
    writeFileSync(join(scratch, 'scan.xyz'), scan.points.map((point) => point.join(' ')).join('\n'));
    await open(page, join(scratch, 'scan.xyz'));
    assert.match(await status(page), /points without faces/);
    await expand(page, 'Fit');
    await page.getByLabel('Vertices').fill('150');
    await page.evaluate(() => {
      const { engine } = globalThis.studio.app;
      const draw = engine.onFrame;
      globalThis.framesSeen = 0;
      engine.onFrame = (drawing) => { ++globalThis.framesSeen; draw(drawing); };
    });
    await press(page, 'Fit');
    assert.ok(await page.evaluate(() => globalThis.framesSeen) > 2, 'the surface is seen to grow');
    assert.equal(await page.locator('.plot canvas').count() > 0, true);
    assert.match(await status(page), /rms distance/);
    await shoot(page, 'studio-fit');
  },

  async 'a mesh is fitted to points, and keeps its faces'({ page }) {
    await openModel(page, 'tripod');
    await expand(page, 'Fit');
    const scan = scanPoints();
    await page.getByLabel('Points or a mesh that the surface shall hug').setInputFiles(scan);
    await page.waitForFunction(() => globalThis.studio.app.store.state.past.at(-1)?.label === 'fit to tripod-scan.xyz');
    await idle(page);
    await page.waitForFunction(() => document.querySelector('[role=status]').textContent.includes('rms distance'));
    tool('fit', scan, '--init', `${models}tripod.obj`, '-o', join(scratch, 'hugging.obj'));
    const own = readObj(readFileSync(join(scratch, 'hugging.obj'), 'utf8'));
    const away = difference(own, { ...own, points: rows(await points(page)) });
    assert.ok(away < 1e-6 * diagonal(own), `${away}`);
    await press(page, 'Undo');
    assert.match(await status(page), /212 vertices, 210 faces/);
  },

  async 'nothing is lost by a reload'({ page, ready }) {
    await openModel(page, 'tripod');
    await press(page, 'Interpolate');
    const before = await status(page);
    await page.waitForTimeout(900);
    await page.reload();
    await ready();
    await page.waitForFunction(() => (document.querySelector('[role=status]')?.textContent ?? '').includes('max error'));
    assert.equal(await status(page), before);
    await press(page, 'Undo');
    assert.doesNotMatch(await status(page), /^tripod.*max error/);
  },

  async 'axe finds nothing, in light and dark'({ page }) {
    await openModel(page, 'tripod');
    for (const title of ['Points and creases', 'Sculpt', 'Smooth and bands', 'Fit']) await expand(page, title);
    for (const theme of ['light', 'dark']) {
      await page.evaluate(AXE);
      const found = await axeFindings(page);
      assert.deepEqual(found, [], theme);
      await press(page, 'Light or dark');
    }
    await press(page, 'Light or dark');
    await press(page, 'Interpolate');
    await shoot(page, 'studio-dark');
    await press(page, 'Light or dark');
  },

  async 'works at 360 pixels, and without a network'({ page, context, ready, server }) {
    await page.setViewportSize({ width: 360, height: 740 });
    await openModel(page, 'pipe-joint');
    await press(page, 'Interpolate');
    const wide = await page.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(wide <= 360, `${wide} pixels wide`);
    await shoot(page, 'studio-phone');
    await page.setViewportSize({ width: 1280, height: 800 });
    await page.waitForFunction(async () => (await caches.keys()).length > 0 && navigator.serviceWorker.controller !== null);
    server.closeAllConnections();
    await context.setOffline(true);
    await page.reload();
    await ready();
    await openModel(page, 'cube');
    await press(page, 'Interpolate');
    assert.match(await status(page), /max error/);
    await context.setOffline(false);
  },
};

const studio = await openStudio(folder);
let failed = 0;
const only = process.env.ONLY;
for (const [name, task] of Object.entries(tasks)) {
  if (only && !name.includes(only)) continue;
  const begin = performance.now();
  try {
    await task(studio);
    assert.deepEqual(studio.complaints.splice(0), [], 'the console complains');
    process.stdout.write(`ok   ${name} (${Math.round(performance.now() - begin)} ms)\n`);
  } catch (error) {
    ++failed;
    process.stdout.write(`FAIL ${name}\n     ${error.stack ?? error}\n     status: ${await status(studio.page)}\n`);
    studio.complaints.splice(0);
    await studio.page.screenshot({ path: join(tmpdir(), `studio-failed-${failed}.png`) });
  }
}
await studio.close();
process.exit(failed > 0 ? 1 : 0);
