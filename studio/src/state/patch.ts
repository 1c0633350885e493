/** Changes of the work as data: applied forwards, and backwards by their inverse. */
import type { Corner, Crease } from '../engine/types';
import type { Settings, Work } from './work';

export type Patch =
  | { readonly kind: 'work'; readonly work: Work | null }
  | { readonly kind: 'points'; readonly vertices: readonly number[]; readonly values: Float64Array }
  | { readonly kind: 'all-points'; readonly points: Float64Array }
  | { readonly kind: 'tags'; readonly creases: readonly Crease[]; readonly corners: readonly Corner[] }
  | { readonly kind: 'settings'; readonly settings: Partial<Settings> };

function required(work: Work | null): Work {
  if (!work) throw new Error('open a file first');
  return work;
}

export function apply(work: Work | null, patch: Patch): Work | null {
  switch (patch.kind) {
    case 'work':
      return patch.work;
    case 'points': {
      const points = required(work).points.slice();
      patch.vertices.forEach((vertex, i) => points.set(patch.values.subarray(3 * i, 3 * i + 3), 3 * vertex));
      return { ...required(work), points };
    }
    case 'all-points':
      return { ...required(work), points: patch.points };
    case 'tags':
      return { ...required(work), creases: patch.creases, corners: patch.corners };
    case 'settings':
      return { ...required(work), settings: { ...required(work).settings, ...patch.settings } };
  }
}

/** The patch that leads back from apply(work, patch) to `work`. */
export function inverse(work: Work | null, patch: Patch): Patch {
  switch (patch.kind) {
    case 'work':
      return { kind: 'work', work };
    case 'points': {
      const { points } = required(work);
      const values = Float64Array.from(patch.vertices.flatMap((vertex) => [...points.subarray(3 * vertex, 3 * vertex + 3)]));
      return { kind: 'points', vertices: patch.vertices, values };
    }
    case 'all-points':
      return { kind: 'all-points', points: required(work).points };
    case 'tags':
      return { kind: 'tags', creases: required(work).creases, corners: required(work).corners };
    case 'settings':
      return { kind: 'settings', settings: required(work).settings };
  }
}
