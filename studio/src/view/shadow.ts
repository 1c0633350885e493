/** The soft shadow of a surface on the ground below it: how dark each place of the ground is. */
import type { Vec3 } from '../engine/types';

export interface Shadow {
  /** SHADOW_SIDE rows of as many numbers from 0 to 1; a row goes along `across`. */
  readonly darkness: Float32Array;
  /** The middle of the square of ground. */
  readonly center: Vec3;
  readonly side: number;
  readonly across: Vec3;
  readonly along: Vec3;
}

export const SHADOW_SIDE = 128;
/** Room around the surface for what is soft, as a share of its width. */
const MARGIN = 0.35;
/** Samples of triangles larger than a cell: no mesh shall stop the page. */
const MOST_SAMPLES = 2e6;
/** Heights, as a share of the size, in which darkness falls to 1/e: where it touches the ground, and of all of it. */
const TOUCH = { fall: 0.03, blur: 2, weight: 0.5 };
const WHOLE = { fall: 0.3, blur: 7, weight: 0.42 };

const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a: Vec3, b: Vec3): Vec3 => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/** Means over 2 reach + 1 cells of each row, written as columns: twice it blurs both ways. */
function blurAcross(cells: Float32Array, reach: number): Float32Array {
  const n = SHADOW_SIDE;
  const result = new Float32Array(n * n);
  for (let row = 0; row < n; ++row) {
    let sum = 0;
    for (let i = -reach; i < n; ++i) {
      sum += i + reach < n ? (cells[row * n + i + reach] ?? 0) : 0;
      sum -= i - reach - 1 >= 0 ? (cells[row * n + i - reach - 1] ?? 0) : 0;
      if (i >= 0) result[i * n + row] = sum / (2 * reach + 1);
    }
  }
  return result;
}

/** Three boxes are nearly a bell. */
function blur(cells: Float32Array, reach: number): Float32Array {
  let result = cells;
  for (let pass = 0; pass < 6; ++pass) result = blurAcross(result, reach);
  return result;
}

/** up: of length 1. Null where there is nothing that could cast one. */
export function shadowOf(points: ArrayLike<number>, triangles: ArrayLike<number>, up: Vec3): Shadow | null {
  const across: Vec3 = Math.abs(up[0]) > 0.5 ? [0, 1, 0] : [1, 0, 0];
  const along = cross(up, across);
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  const places = new Float32Array(points.length);
  for (let i = 0; i + 2 < points.length; i += 3) {
    const at: Vec3 = [points[i] ?? 0, points[i + 1] ?? 0, points[i + 2] ?? 0];
    [dot(at, across), dot(at, along), dot(at, up)].forEach((part, axis) => {
      places[i + axis] = part;
      low[axis] = Math.min(low[axis] ?? part, part);
      high[axis] = Math.max(high[axis] ?? part, part);
    });
  }
  const [left = 0, near = 0, ground = 0] = low;
  const [right = 0, far = 0, top = 0] = high;
  const width = Math.max(right - left, far - near);
  const size = Math.max(width, top - ground);
  if (!(width > 0) || !Number.isFinite(size)) return null;
  const side = width + 2 * MARGIN * size;
  const cell = side / SHADOW_SIDE;
  const corner = [(left + right - side) / 2, (near + far - side) / 2] as const;

  const heights = new Float32Array(SHADOW_SIDE * SHADOW_SIDE).fill(Infinity);
  const mark = (u: number, v: number, height: number): void => {
    const at = Math.floor((v - corner[1]) / cell) * SHADOW_SIDE + Math.floor((u - corner[0]) / cell);
    if (height - ground < (heights[at] ?? 0)) heights[at] = height - ground;
  };
  for (let i = 0; i + 2 < places.length; i += 3) mark(places[i] ?? 0, places[i + 1] ?? 0, places[i + 2] ?? 0);
  const finest = Math.max(1, Math.floor(Math.sqrt((6 * MOST_SAMPLES) / Math.max(3, triangles.length))));
  for (let i = 0; i + 2 < triangles.length; i += 3) {
    const [a, b, c] = [3 * (triangles[i] ?? 0), 3 * (triangles[i + 1] ?? 0), 3 * (triangles[i + 2] ?? 0)];
    const part = (axis: number, s: number, t: number): number =>
      (places[a + axis] ?? 0) * (1 - s - t) + (places[b + axis] ?? 0) * s + (places[c + axis] ?? 0) * t;
    const reach = (p: number, q: number): number => Math.max(Math.abs((places[p] ?? 0) - (places[q] ?? 0)), Math.abs((places[p + 1] ?? 0) - (places[q + 1] ?? 0)));
    const steps = Math.min(finest, Math.ceil(Math.max(reach(a, b), reach(b, c), reach(c, a)) / cell));
    if (steps < 2) continue;  // its corners are marked
    for (let j = 0; j <= steps; ++j)
      for (let k = 0; j + k <= steps; ++k) mark(part(0, j / steps, k / steps), part(1, j / steps, k / steps), part(2, j / steps, k / steps));
  }

  const layers = [TOUCH, WHOLE].map(({ fall, blur: reach, weight }) =>
    blur(heights.map((height) => weight * Math.exp(-height / (fall * size))), reach));
  const darkness = new Float32Array(heights.length);
  for (let i = 0; i < darkness.length; ++i) darkness[i] = 1 - layers.reduce((light, layer) => light * (1 - (layer[i] ?? 0)), 1);
  const middle = [(left + right) / 2, (near + far) / 2, ground - 0.004 * size] as const;
  const center: Vec3 = [0, 1, 2].map((i) => middle[0] * (across[i] ?? 0) + middle[1] * (along[i] ?? 0) + middle[2] * (up[i] ?? 0)) as unknown as Vec3;
  return { darkness, center, side, across, along };
}
