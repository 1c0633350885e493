import { describe, expect, it } from 'vitest';
import { SHADOW_SIDE, shadowOf, type Shadow } from '../../src/view/shadow';
import type { Vec3 } from '../../src/engine/types';

const UP: Vec3 = [0, 0, 1];
/** A square of two triangles, four corners only, at a height. */
const square = (height: number, half = 1): number[] => [-half, -half, height, half, -half, height, half, half, height, -half, half, height];
const TWO = [0, 1, 2, 0, 2, 3];

/** How dark the ground is at a place of the world. */
function darkAt(shadow: Shadow | null, place: Vec3): number {
  if (!shadow) throw new Error('no shadow');
  const cell = (axis: Vec3): number => {
    const along = axis.reduce((sum, part, i) => sum + part * ((place[i] ?? 0) - (shadow.center[i] ?? 0)), 0);
    return Math.floor((along / shadow.side + 0.5) * SHADOW_SIDE);
  };
  return shadow.darkness[cell(shadow.along) * SHADOW_SIDE + cell(shadow.across)] ?? NaN;
}

describe('shadow', () => {
  it('lies under large triangles as under their corners, and ends beyond them', () => {
    const shadow = shadowOf(square(0), TWO, UP);
    expect(darkAt(shadow, [0, 0, 0])).toBeGreaterThan(0.5);
    expect(darkAt(shadow, [0.6, -0.6, 0])).toBeGreaterThan(0.5);
    expect(darkAt(shadow, [1.5, 0, 0])).toBeLessThan(0.05);
    expect(Math.max(...(shadow?.darkness ?? [1]))).toBeLessThan(0.8);
    const edge = Array.from({ length: SHADOW_SIDE }, (_, i) => shadow?.darkness[i] ?? 1);
    expect(Math.max(...edge)).toBeLessThan(0.01);
  });

  it('is lighter under what is higher', () => {
    // A small foot holds the ground's height; the square is above it.
    const lifted = [...square(1), ...square(0, 0.05)];
    const faces = [...TWO, ...TWO.map((corner) => corner + 4)];
    const near = shadowOf(square(0), TWO, UP);
    const far = shadowOf(lifted, faces, UP);
    expect(darkAt(far, [0.6, 0.6, 0])).toBeGreaterThan(0.005);
    expect(darkAt(far, [0.6, 0.6, 0])).toBeLessThan(0.3 * darkAt(near, [0.6, 0.6, 0]));
    expect(darkAt(far, [0, 0, 0])).toBeGreaterThan(darkAt(far, [0.6, 0.6, 0]));
  });

  it('is below the surface whatever is up', () => {
    for (const [axis, sign] of [[0, 1], [0, -1], [1, 1], [1, -1], [2, -1]] as const) {
      const along = (length: number): Vec3 => [axis === 0 ? length : 0, axis === 1 ? length : 0, axis === 2 ? length : 0];
      const up = along(sign);
      // The square stands on the ground of this axis, and off the origin.
      const points = square(0).map((_, i, all) => {
        const [u = 0, v = 0] = [all[i - (i % 3)], all[i - (i % 3) + 1]];
        const at = [0, 0, 0];
        at[axis] = 5 * sign;
        at[(axis + 1) % 3] = u + 2;
        at[(axis + 2) % 3] = v;
        return at[i % 3] ?? 0;
      });
      const shadow = shadowOf(points, TWO, up);
      const next = (axis + 1) % 3;
      const middle = along(5 * sign).map((part, i) => (i === next ? 2 : part)) as unknown as Vec3;
      expect(darkAt(shadow, middle)).toBeGreaterThan(0.5);
      const height = (shadow?.center[axis] ?? 0) * sign;
      expect(height).toBeLessThan(5);
      expect(height).toBeGreaterThan(4.9);
    }
  });

  it('is that of no points, of points on a line and of points that are no numbers: none', () => {
    expect(shadowOf([], [], UP)).toBeNull();
    expect(shadowOf([0, 0, 0, 0, 0, 1], [], UP)).toBeNull();
    expect(shadowOf([0, 0, 0, NaN, 0, 1, 1, Infinity, 0], [0, 1, 2], UP)).toBeNull();
  });
});
