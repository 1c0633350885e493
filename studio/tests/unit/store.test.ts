import { describe, expect, it } from 'vitest';
import { commandFor } from '../../src/state/command';
import { edgeLoop, sharpnessOf, withCreases } from '../../src/state/creases';
import { apply, inverse, type Patch } from '../../src/state/patch';
import { Store } from '../../src/state/store';
import { PLAIN, type Work, wishesOf } from '../../src/state/work';
import { short } from '../../src/ui/text';

/** A grid of 3 by 3 quads. */
function grid(): Work {
  const points: number[] = [];
  const faces: number[] = [];
  for (let j = 0; j < 4; ++j) for (let i = 0; i < 4; ++i) points.push(i, j, 0);
  for (let j = 0; j < 3; ++j) for (let i = 0; i < 3; ++i) faces.push(4 * j + i, 4 * j + i + 1, 4 * j + i + 5, 4 * j + i + 4);
  return {
    source: { name: 'grid.obj', bytes: new Uint8Array() },
    points: Float64Array.from(points),
    faceOffsets: Int32Array.from({ length: 10 }, (_, i) => 4 * i),
    faceVertices: Int32Array.from(faces),
    creases: [],
    corners: [],
    diagonal: Math.hypot(3, 3),
    up: 3,
    fileScheme: 0,
    settings: PLAIN,
  };
}

const PATCHES: readonly Patch[] = [
  { kind: 'points', vertices: [5, 2], values: Float64Array.of(9, 8, 7, 6, 5, 4) },
  { kind: 'all-points', points: new Float64Array(48) },
  { kind: 'tags', creases: [{ a: 0, b: 1, sharpness: 3 }], corners: [{ vertex: 4, sharpness: 10 }] },
  { kind: 'settings', settings: { interpolate: true, alpha: 0.5 } },
  { kind: 'work', work: null },
];

describe('patches', () => {
  it.each(PATCHES)('come back from $kind by their inverse', (patch) => {
    const work = grid();
    expect(apply(apply(work, patch), inverse(work, patch))).toEqual(work);
  });
  it('leave the work that they change as it was', () => {
    const work = grid();
    for (const patch of PATCHES) apply(work, patch);
    expect(work).toEqual(grid());
  });
});

describe('the store', () => {
  it('undoes and redoes a long history to the same work at each step', () => {
    const store = new Store();
    store.run('open', { kind: 'work', work: grid() });
    const seen = [store.work];
    for (let i = 0; i < 200; ++i) {
      store.run('move', { kind: 'points', vertices: [i % 16], values: Float64Array.of(i, -i, 1) });
      seen.push(store.work);
    }
    for (let i = 199; i >= 0; --i) {
      store.undo();
      expect(store.work).toEqual(seen[i]);
    }
    for (let i = 1; i <= 200; ++i) store.redo();
    expect(store.work).toEqual(seen[200]);
  });
  it('forgets the future when something new is done', () => {
    const store = new Store();
    store.run('open', { kind: 'work', work: grid() });
    store.run('one', { kind: 'settings', settings: { alpha: 1 } });
    store.undo();
    store.run('two', { kind: 'settings', settings: { fair: true } });
    expect(store.redo()).toBeNull();
  });
});

describe('creases', () => {
  it('go on straight through vertices of four edges, and end at the boundary', () => {
    const loop = edgeLoop(grid(), 5, 6).map(([a, b]) => [Math.min(a, b), Math.max(a, b)]).sort();
    expect(loop).toEqual([[4, 5], [5, 6], [6, 7]]);
  });
  it('replace one of the same edge, whichever way round', () => {
    const once = withCreases([], [[3, 7]], 2);
    const twice = withCreases(once, [[7, 3]], 5);
    expect(twice).toHaveLength(1);
    expect(sharpnessOf(twice, 3, 7)).toBe(5);
    expect(withCreases(twice, [[3, 7]], 0)).toEqual([]);
  });
});

describe('words', () => {
  it('name the command with what differs from its defaults only', () => {
    const work = { ...grid(), settings: { ...PLAIN, interpolate: true, scheme: 'loop', fair: true } as const };
    expect(commandFor(work, 400, 0)).toBe('batten interpolate grid.obj -o control.obj --scheme loop --fair');
  });
  it('have a tolerance in per cent', () => {
    expect(commandFor({ ...grid(), settings: PLAIN }, 400, 0.0003)).toBe('batten subdivide grid.obj -o surface.obj --chord 0.03%');
  });
  it('are the medial verb for medial models, where it does the same', () => {
    const work = { ...grid(), origins: new Float64Array(3), settings: { ...PLAIN, interpolate: true } };
    expect(commandFor(work, 400, 0)).toBe('batten medial grid.obj -o control.obj');
    expect(commandFor({ ...work, settings: { ...work.settings, fair: true } }, 400, 0)).toBeNull();
  });
  it('quote file names for the shell', () => {
    const work = { ...grid(), source: { name: "it's mine.obj", bytes: new Uint8Array() } };
    expect(commandFor(work, 400, 0)).toContain(`'it'\\''s mine.obj'`);
  });
  it('show small numbers as powers of ten', () => {
    expect(short(3.14e-10)).toBe('3.1e-10');
    expect(short(-0.5)).toBe('-0.5');
  });
  it('leave alpha out where the scheme has none', () => {
    const work = { ...grid(), settings: { ...PLAIN, scheme: 'loop', alpha: 0.5 } as const };
    expect(wishesOf(work).alpha).toBe(0);
  });
});
