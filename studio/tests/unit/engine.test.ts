// The engine under Node, against closed forms and identities.
import { readFileSync } from 'node:fs';
import { beforeAll, describe, expect, it } from 'vitest';
import createEngine from '@engine/engine.js';
import { Engine } from '../../src/engine/engine';
import type { EngineModule } from '../../src/engine/module';
import type { Drawing, SurfaceWishes } from '../../src/engine/types';
import { EngineError } from '../../src/engine/types';
import { putRows } from '../../src/view/rows';

const root = new URL('../../../', import.meta.url);
const PLAIN: SurfaceWishes = { scheme: 0, boundary: 2, alpha: 0, interpolate: true, fair: false, smoothing: 0, levels: 2, chord: 0, normals: new Float64Array() };
let engine: Engine;
/** The surfaces on the way of the last fits. */
const frames: Drawing[] = [];

function model(name: string): Uint8Array {
  return readFileSync(new URL(`models/${name}.obj`, root));
}
function text(content: string): Uint8Array {
  return new TextEncoder().encode(content);
}
/** A torus of quads as OBJ, `around` by `across`. */
function torus(around: number, across: number): Uint8Array {
  const lines: string[] = [];
  for (let i = 0; i < around; ++i)
    for (let j = 0; j < across; ++j) {
      const [u, v] = [(2 * Math.PI * i) / around, (2 * Math.PI * j) / across];
      lines.push(`v ${(3 + Math.cos(v)) * Math.cos(u)} ${(3 + Math.cos(v)) * Math.sin(u)} ${Math.sin(v)}`);
    }
  const vertex = (i: number, j: number) => (i % around) * across + (j % across) + 1;
  for (let i = 0; i < around; ++i) for (let j = 0; j < across; ++j) lines.push(`f ${vertex(i, j)} ${vertex(i + 1, j)} ${vertex(i + 1, j + 1)} ${vertex(i, j + 1)}`);
  return text(lines.join('\n'));
}
function distance(a: ArrayLike<number>, i: number, b: ArrayLike<number>, j: number): number {
  return Math.hypot(...[0, 1, 2].map((k) => (a[3 * i + k] ?? NaN) - (b[3 * j + k] ?? NaN)));
}

beforeAll(async () => {
  const wasmBinary = readFileSync(new URL('build/studio/studio/engine/engine.wasm', root));
  engine = new Engine((await createEngine({ wasmBinary })) as EngineModule, null, (drawing) => void frames.push(drawing));
});

describe('interpolation', () => {
  it.each(['tripod', 'bracket', 'creature', 'cube', 'icosahedron'])('passes through the points of %s', (name) => {
    const { points, diagonal } = engine.open(`${name}.obj`, model(name));
    const { report, drawing } = engine.show({ ...PLAIN, scheme: name === 'icosahedron' ? 1 : 0 });
    expect(report.maxError).toBeLessThan(1e-9 * diagonal);
    // Vertex i of the picture is point i; floats have 24 bits.
    for (let i = 0; i < points.length / 3; ++i) expect(distance(drawing.points, i, points, i)).toBeLessThan(3e-7 * diagonal);
  });

  it.each(['tripod', 'torus-fine'])('follows a dragged point of %s to where a whole solve of the moved points leads', (name) => {
    const { points } = name === 'tripod' ? engine.open('tripod.obj', model(name)) : engine.open('fine.obj', torus(100, 80));
    const { drawing } = engine.show(PLAIN);
    const to = [points[30] ?? 0, points[31] ?? 0, (points[32] ?? 0) + 0.1] as const;
    for (const [count, z] of [to[2] + 0.2, to[2]].entries()) {
      const { vertices, moved, ...change } = engine.move(10, [to[0], to[1], z], 0);
      expect(vertices === undefined).toBe(name === 'tripod' || count === 0); // of a small mesh, and at first, all
      expect(putRows(drawing.points, change.points, vertices)).toBe(true);
      expect(putRows(drawing.normals, change.normals, vertices)).toBe(true);
      expect(putRows(drawing.control, change.control, moved)).toBe(true);
    }
    points.set(to, 30);
    engine.setPoints(points);
    const solved = engine.show(PLAIN).drawing;
    for (const part of ['control', 'points', 'normals'] as const)
      for (let i = 0; i < solved[part].length; ++i) expect(Math.abs((drawing[part][i] ?? NaN) - (solved[part][i] ?? NaN))).toBeLessThan(1e-6);
    expect(distance(drawing.points, 10, to, 0)).toBeLessThan(1e-6);
  });
});

describe('room', () => {
  it('is filled again where it has the sizes, and is left alone elsewhere', () => {
    engine.open('tripod.obj', model('tripod'));
    engine.show(PLAIN);
    const first = engine.move(10, [1, 2, 3], 0);
    const kept = { points: first.points.slice(), normals: first.normals.slice(), control: first.control.slice() };
    const { points, normals, control } = first;
    const second = engine.move(10, [1, 2, 4], 0, { points, normals, control });
    for (const part of ['points', 'normals', 'control'] as const) expect(second[part]).toBe(first[part]);
    expect(second.points).not.toEqual(kept.points);
    const third = engine.move(10, [1, 2, 3], 0, { points: new Float32Array(3), normals, control: new Float32Array() });
    expect(third.normals).toBe(normals);
    for (const part of ['points', 'normals', 'control'] as const)
      for (let i = 0; i < kept[part].length; ++i) expect(third[part][i]).toBeCloseTo(kept[part][i] ?? NaN, 5);
  });
});

describe('wanted normals', () => {
  it.each([false, true])('are those of the surface, fair: %s', (fair) => {
    engine.open('creature.obj', model('creature'));
    const before = engine.show({ ...PLAIN, fair }).drawing;
    const vertex = 40;
    const wanted = [0.6, 0, 0.8];
    expect(distance(before.normals, vertex, wanted, 0)).toBeGreaterThan(0.1);
    const { report, drawing } = engine.show({ ...PLAIN, fair, normals: Float64Array.of(vertex, 3, 0, 4) });
    expect(report.worstAngle).toBeLessThan(1e-8);
    expect(distance(drawing.normals, vertex, wanted, 0)).toBeLessThan(1e-5);
    expect(distance(drawing.points, vertex, before.points, vertex)).toBeLessThan(1e-5);
    // and in the file
    engine.open('normals.obj', engine.write('obj', -1, 0).bytes);
    expect(distance(engine.show({ ...PLAIN, interpolate: false }).drawing.normals, vertex, wanted, 0)).toBeLessThan(1e-5);
  });
});

/** The vertices of a model as points without faces. */
function cloud(name: string): Uint8Array {
  const lines = new TextDecoder().decode(model(name)).split('\n').filter((line) => line.startsWith('v '));
  return text(lines.map((line) => line.slice(2)).join('\n'));
}

describe('fits', () => {
  it('show the surface as it grows', () => {
    const { points, diagonal } = engine.open('scan.xyz', cloud('tripod-scan'));
    frames.length = 0;
    const { contents, rms, rounds } = engine.fit(150, 0);
    expect(points.length / 3).toBeGreaterThan(500);
    expect(rms).toBeLessThan(0.02 * diagonal);
    expect(frames.length).toBeGreaterThan(rounds.length);
    const last = frames.at(-1);
    expect(last?.control.length).toBe(contents.points.length);
    for (let i = 0; i < contents.points.length; ++i) expect(Math.abs((last?.control[i] ?? NaN) - (contents.points[i] ?? NaN))).toBeLessThan(1e-5 * diagonal);
  });
  it('keep the faces of a cage', () => {
    const cage = engine.open('tripod.obj', model('tripod'));
    const { contents, rms } = engine.fitTo('scan.xyz', cloud('tripod-scan'), 0);
    expect(contents.faceVertices).toEqual(cage.faceVertices);
    expect(rms).toBeLessThan(0.01 * cage.diagonal);
  });
});

describe('a tolerance', () => {
  it('bounds the distance of what is drawn', () => {
    engine.open('torus.obj', torus(12, 8));
    const coarse = engine.show({ ...PLAIN, chord: 0.05 });
    const fine = engine.show({ ...PLAIN, chord: 0.002 });
    expect(fine.report.triangles).toBeGreaterThan(2 * (coarse.report.triangles ?? Infinity));
    const { points, triangles } = fine.drawing;
    expect(triangles.length / 3).toBe(fine.report.triangles);
    let farthest = 0;
    for (let t = 0; t < triangles.length; t += 3) {
      const middle = [0, 1, 2].map((k) => ((points[3 * (triangles[t] ?? 0) + k] ?? NaN) + (points[3 * (triangles[t + 1] ?? 0) + k] ?? NaN)) / 2) as [number, number, number];
      farthest = Math.max(farthest, engine.probe(middle).distance);
    }
    expect(farthest).toBeGreaterThan(0);
    expect(farthest).toBeLessThan(0.002);
  });
  it('follows a point, and carries measures', () => {
    engine.open('torus.obj', torus(12, 8));
    const before = engine.show({ ...PLAIN, chord: 0.01 }).drawing;
    const moved = engine.move(0, [4.5, 0, 0], 0);
    expect(moved.triangles?.length).not.toBe(before.triangles.length);
    expect(distance(moved.points, 0, [4.5, 0, 0], 0)).toBeLessThan(1e-5);
    for (const measure of ['mean', 'gaussian', 'error', 'valence', 'sharpness', 'moved'] as const) {
      const { numbers } = engine.field(measure);
      expect(numbers.length).toBe(moved.points.length / 3);
      expect([...numbers].every(Number.isFinite)).toBe(true);
    }
    expect([...engine.field('valence').numbers].every((valence) => Math.abs(valence - 4) < 1e-9)).toBe(true);
  });
  it('is left out by a Butterfly', () => {
    engine.open('icosahedron.obj', model('icosahedron'));
    expect(engine.show({ ...PLAIN, scheme: 3, chord: 0.01 }).report.triangles).toBeUndefined();
  });
});

describe('medial models', () => {
  it('become the mesh of their spokes\u2019 ends, and tell where these start', () => {
    const { points, origins, notes } = engine.open('bean.srep.json', readFileSync(new URL('models/bean.srep.json', root)));
    expect(origins.length).toBe(points.length);
    expect(notes[0]).toContain('spokes');
    const { report, drawing } = engine.show(PLAIN);
    expect(report.maxError).toBeLessThan(1e-11);
    for (let i = 0; i < points.length / 3; ++i) expect(distance(drawing.points, i, points, i)).toBeLessThan(1e-4);
    expect(engine.open('cube.obj', model('cube')).origins.length).toBe(0);
  });
  it('are refused with the place of the fault', () => {
    expect(() => engine.open('broken.json', text('{"figures": [{"atoms": [{}]}]}'))).toThrow(EngineError);
    expect(() => engine.open('broken.json', text('{"figures": [{"atoms": [{}]}]}'))).toThrow(/broken\.json/);
  });
});

describe('GLB', () => {
  it('is read again', () => {
    engine.open('tripod.obj', model('tripod'));
    engine.show(PLAIN);
    const { bytes, losses } = engine.write('glb', 2, 0);
    expect(losses).toEqual(['polygons (cut into triangles)']);
    const { points } = engine.open('tripod.glb', bytes);
    expect(points.length).toBeGreaterThan(1000);
  });
  it('holds a film', () => {
    engine.open('creature.obj', model('creature'));
    engine.startMorph('creature-ball.obj', model('creature-ball'), PLAIN);
    const film = engine.morphFilm(2);
    const text = new TextDecoder().decode(film.subarray(0, 20_000));
    expect(text.startsWith('glTF')).toBe(true);
    expect(text).toContain('"animations"');
  });
});

describe('places', () => {
  it('lie on the surface, with unit normals and curvatures that belong together', () => {
    const { points } = engine.open('creature.obj', model('creature'));
    engine.show(PLAIN);
    const found = engine.probe([points[0] ?? 0, points[1] ?? 0, points[2] ?? 0]);
    expect(found.distance).toBeLessThan(1e-8);
    expect(Math.hypot(...found.normal)).toBeCloseTo(1, 12);
    const between = engine.probe([5, 1, 3]);
    expect(between.mean).toBeCloseTo((between.greatest + between.least) / 2, 9);
    expect(between.gaussian).toBeCloseTo(between.greatest * between.least, 8);
  });
});

describe('colours', () => {
  it('have a place on the bar for each vertex drawn', () => {
    engine.open('tripod.obj', model('tripod'));
    const { drawing } = engine.show(PLAIN);
    for (const measure of ['error', 'moved', 'mean', 'gaussian', 'valence', 'sharpness'] as const) {
      const field = engine.field(measure);
      expect(field.positions).toHaveLength(drawing.points.length / 3);
      expect(Math.max(...field.numbers)).toBeCloseTo(field.scale.highest, 12);
      expect(field.scale.colors).toHaveLength(3 * 256);
    }
  });
});

describe('tags', () => {
  it('make the surface sharp where they are: a creased cube stays a cube', () => {
    const { faceVertices } = engine.open('cube.obj', model('cube'));
    const creases = [...faceVertices].map((a, i) => ({ a, b: faceVertices[i % 4 === 3 ? i - 3 : i + 1] ?? 0, sharpness: 10 })).filter(({ a, b }) => a < b);
    expect(creases).toHaveLength(12);
    engine.setTags(creases, []);
    const { drawing } = engine.show({ ...PLAIN, interpolate: false });
    const flat = [...drawing.points].filter((_, i) => i % 3 === 0).map(Math.abs);
    const corner = Math.max(...flat);
    // Every vertex lies on one of the six planes.
    for (let i = 0; i < drawing.points.length; i += 3) {
      const farthest = Math.max(...[0, 1, 2].map((k) => Math.abs(drawing.points[i + k] ?? NaN)));
      expect(farthest).toBeCloseTo(corner, 6);
    }
  });
});

describe('elastic surfaces', () => {
  it('stay at rest when nothing pulls, and come towards the hand', () => {
    engine.open('icosahedron.obj', model('icosahedron'));
    engine.show({ ...PLAIN, scheme: 1, interpolate: false });
    const material = { scheme: 1, boundary: 2, tension: 100, rigidity: 1, damping: 1, pressure: 0, gravity: 0, floor: false, holdBoundary: true };
    const { drawing } = engine.startSculpting(material);
    const still = engine.stepSculpture(5);
    for (let i = 0; i < still.control.length; ++i) expect(still.control[i]).toBeCloseTo(drawing.control[i] ?? NaN, 5);
    const top = [drawing.points[0] ?? 0, drawing.points[1] ?? 0, drawing.points[2] ?? 0] as const;
    engine.grab(top, 400);
    const hand = [2 * top[0], 2 * top[1], 2 * top[2]] as const;
    engine.pull(hand);
    const pulled = engine.stepSculpture(30);
    expect(distance(pulled.points, 0, hand, 0)).toBeLessThan(0.8 * distance(top, 0, hand, 0));
    engine.endSculpting();
  });
});

describe('broken input', () => {
  it.each([
    ['words.obj', 'v 1 2\nf 1 2 3\n'],
    ['range.obj', 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n'],
    ['nan.obj', 'v 0 0 nan\n'],
    ['huge.ply', 'ply\nformat binary_little_endian 1.0\nelement vertex 1000000000\nproperty double x\nproperty double y\nproperty double z\nend_header\nabc'],
    ['short.stl', 'solid x\nfacet'],
    ['kind.xyz', '1 2 three\n'],
    ['kind.doc', 'hello'],
  ])('%s is refused with a sentence that names it, and the engine goes on', (name, content) => {
    expect(() => engine.open(name, text(content))).toThrowError(EngineError);
    try {
      engine.open(name, text(content));
    } catch (error) {
      expect(String(error)).toContain(name);
    }
    expect(engine.open('cube.obj', model('cube')).points).toHaveLength(24);
  });

  it('is repaired', () => {
    engine.open('broken-tripod.obj', model('broken-tripod'));
    expect(engine.problems().length).toBeGreaterThan(0);
    expect(engine.repair(0).changes.length).toBeGreaterThan(0);
    expect(engine.problems()).toEqual([]);
    expect(engine.show(PLAIN).report.maxError).toBeLessThan(1e-8);
  });
});

describe('operations', () => {
  it('bands with gains of 1 change no bit', () => {
    const { points } = engine.open('creature.obj', model('creature'));
    expect(engine.bands(PLAIN, [1, 1, 1, 1]).points).toEqual(points);
  });
  it('a morph begins and ends at its shapes', () => {
    const { points } = engine.open('creature.obj', model('creature'));
    engine.startMorph('creature-ball.obj', model('creature-ball'), PLAIN);
    expect(engine.morphAt(0)).toEqual(points);
    const half = engine.morphAt(0.5);
    expect(engine.morphAt(1)).toEqual(engine.open('creature-ball.obj', model('creature-ball')).points);
    expect(half).not.toEqual(points);
  });
  it('compares the iterations of the papers with ours', () => {
    engine.open('tripod.obj', model('tripod'));
    expect(engine.methods(PLAIN).map((method) => method.name)).toEqual(['Batten', 'Thall 2002', 'Lai and Cheng 2006', 'direct']);
  });
});
