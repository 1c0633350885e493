import { describe, expect, it } from 'vitest';
import { putRows } from '../../src/view/rows';

describe('putRows', () => {
  it('puts some rows in their places', () => {
    const numbers = new Float32Array(9);
    expect(putRows(numbers, Float32Array.of(1, 2, 3, 4, 5, 6), Int32Array.of(2, 0))).toBe(true);
    expect([...numbers]).toEqual([4, 5, 6, 0, 0, 0, 1, 2, 3]);
  });

  it('leaves numbers of another surface alone', () => {
    const numbers = new Float32Array(6);
    expect(putRows(numbers, Float32Array.of(1, 2, 3))).toBe(false);
    expect(putRows(numbers, Float32Array.of(1, 2, 3), Int32Array.of(2))).toBe(false);
    expect([...numbers]).toEqual([0, 0, 0, 0, 0, 0]);
  });
});
