/** Creases of a mesh as a list: one edge, or the loop that goes on straight from it. */
import type { Crease } from '../engine/types';
import type { Work } from './work';

function same(crease: Crease, a: number, b: number): boolean {
  return (crease.a === a && crease.b === b) || (crease.a === b && crease.b === a);
}

export function sharpnessOf(creases: readonly Crease[], a: number, b: number): number {
  return creases.find((crease) => same(crease, a, b))?.sharpness ?? 0;
}

/** The list with these edges at this sharpness; 0 takes them off. */
export function withCreases(creases: readonly Crease[], edges: readonly (readonly [number, number])[], sharpness: number): Crease[] {
  const others = creases.filter((crease) => !edges.some(([a, b]) => same(crease, a, b)));
  return sharpness > 0 ? [...others, ...edges.map(([a, b]) => ({ a, b, sharpness }))] : others;
}

/** Neighbours of each vertex along edges, and the faces of each edge. */
function neighbours(work: Pick<Work, 'faceOffsets' | 'faceVertices'>): { around: Map<number, Set<number>>; faces: Map<string, number[]> } {
  const around = new Map<number, Set<number>>();
  const faces = new Map<string, number[]>();
  const link = (a: number, b: number): void => void (around.get(a) ?? around.set(a, new Set()).get(a))?.add(b);
  for (let face = 0; face + 1 < work.faceOffsets.length; ++face) {
    const begin = work.faceOffsets[face] ?? 0;
    const end = work.faceOffsets[face + 1] ?? 0;
    for (let i = begin; i < end; ++i) {
      const a = work.faceVertices[i] ?? 0;
      const b = work.faceVertices[i + 1 < end ? i + 1 : begin] ?? 0;
      link(a, b);
      link(b, a);
      const key = edgeKey(a, b);
      faces.set(key, [...(faces.get(key) ?? []), face]);
    }
  }
  return { around, faces };
}

function edgeKey(a: number, b: number): string {
  return a < b ? `${a} ${b}` : `${b} ${a}`;
}

/** The edges that go on from a-b at vertices of valence 4: those that share no face with the one before. */
export function edgeLoop(work: Pick<Work, 'faceOffsets' | 'faceVertices'>, a: number, b: number): [number, number][] {
  const { around, faces } = neighbours(work);
  const seen = new Map<string, [number, number]>([[edgeKey(a, b), [a, b]]]);
  const walk = (from: number, to: number): void => {
    for (;;) {
      const next = [...(around.get(to) ?? [])];
      const here = new Set(faces.get(edgeKey(from, to)));
      const onward = next.filter((vertex) => vertex !== from && !(faces.get(edgeKey(to, vertex)) ?? []).some((face) => here.has(face)));
      const vertex = onward[0];
      if (next.length !== 4 || onward.length !== 1 || vertex === undefined || seen.has(edgeKey(to, vertex))) return;
      seen.set(edgeKey(to, vertex), [to, vertex]);
      [from, to] = [to, vertex];
    }
  };
  walk(a, b);
  walk(b, a);
  return [...seen.values()];
}
