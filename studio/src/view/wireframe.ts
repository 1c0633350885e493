/** The edges of a mesh that has no surface, as its file has them: broken faces are no obstacle. */
import type { Work } from '../state/work';

export interface Wireframe {
  control: Float32Array;
  edges: Uint32Array;
  sharpness: Float32Array;
}

/** Edges as pairs of vertices, each once. */
export function edgesOf(work: Pick<Work, 'faceOffsets' | 'faceVertices'>): [number, number][] {
  const seen = new Map<string, [number, number]>();
  for (let face = 0; face + 1 < work.faceOffsets.length; ++face) {
    const begin = work.faceOffsets[face] ?? 0;
    const end = work.faceOffsets[face + 1] ?? 0;
    for (let i = begin; i < end; ++i) {
      const a = work.faceVertices[i] ?? 0;
      const b = work.faceVertices[i + 1 < end ? i + 1 : begin] ?? 0;
      if (a !== b) seen.set(a < b ? `${a} ${b}` : `${b} ${a}`, [a, b]);
    }
  }
  return [...seen.values()];
}

export function wireframe(work: Work): Wireframe {
  const edges = edgesOf(work);
  return { control: Float32Array.from(work.points), edges: Uint32Array.from(edges.flat()), sharpness: new Float32Array(edges.length) };
}
