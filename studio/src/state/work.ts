/** What the person works on: one plain object, never changed in place. */
import type { BoundaryWord, Contents, Corner, Crease, SchemeWord, SurfaceWishes, Vec3 } from '../engine/types';
import { BOUNDARIES, SCHEMES } from '../engine/types';

export interface Settings {
  readonly interpolate: boolean;
  /** auto: Loop for triangles, Catmull-Clark for anything else, or what the file says. */
  readonly scheme: 'auto' | SchemeWord;
  readonly boundary: BoundaryWord;
  readonly alpha: number;
  readonly fair: boolean;
  /** Share of the diagonal (FairOptions::smoothing). */
  readonly smoothing: number;
  /** How far a dragged point's change reaches, in rings; 0: as far as it matters. */
  readonly rings: number;
  /** Which normals the surface shall have at its points; links and kept work of earlier pages have none. */
  readonly normals?: readonly WantedNormal[];
}

export interface WantedNormal {
  readonly vertex: number;
  /** Of any length but zero. */
  readonly direction: Vec3;
}

export const PLAIN: Settings = { interpolate: false, scheme: 'auto', boundary: 'edge-only', alpha: 0, fair: false, smoothing: 0, rings: 0 };

/** A file as it was opened, or as the engine wrote it. */
export interface Source {
  readonly name: string;
  readonly bytes: Uint8Array;
}

export interface Work {
  readonly source: Source;
  /** x, y, z of each vertex. */
  readonly points: Float64Array;
  readonly faceOffsets: Int32Array;
  readonly faceVertices: Int32Array;
  readonly creases: readonly Crease[];
  readonly corners: readonly Corner[];
  readonly diagonal: number;
  readonly up: number;
  readonly fileScheme: number;
  /** Of a medial model, whose spokes end at the points: where they start; work kept by earlier pages has none. */
  readonly origins?: Float64Array;
  readonly settings: Settings;
}

export function vertexCount(work: Work): number {
  return work.points.length / 3;
}
export function faceCount(work: Work): number {
  return Math.max(0, work.faceOffsets.length - 1);
}
/** True for a cloud: points without faces. */
export function isCloud(work: Work): boolean {
  return faceCount(work) === 0;
}

/** True for a medial model: the points are its spokes' ends. */
export function isMedial(work: Work): boolean {
  return (work.origins?.length ?? 0) > 0;
}

function tuples(flat: Float64Array, size: number): number[][] {
  return Array.from({ length: flat.length / size }, (_, i) => [...flat.subarray(size * i, size * (i + 1))]);
}

export function workOf(source: Source, contents: Contents, settings: Settings): Work {
  return {
    source,
    points: contents.points,
    faceOffsets: contents.faceOffsets,
    faceVertices: contents.faceVertices,
    creases: tuples(contents.creases, 3).map(([a = 0, b = 0, sharpness = 0]) => ({ a, b, sharpness })),
    corners: tuples(contents.corners, 2).map(([vertex = 0, sharpness = 0]) => ({ vertex, sharpness })),
    diagonal: contents.diagonal,
    up: contents.up,
    fileScheme: contents.scheme,
    origins: contents.origins,
    settings,
  };
}

export function wantedNormals(settings: Settings): readonly WantedNormal[] {
  return settings.normals ?? [];
}
/** The settings that want this normal at its vertex instead of any other, or with null none. */
export function withNormal(settings: Settings, vertex: number, direction: Vec3 | null): Pick<Settings, 'normals'> {
  const others = wantedNormals(settings).filter((one) => one.vertex !== vertex);
  return { normals: direction ? [...others, { vertex, direction }] : others };
}

export function schemeNumber(work: Work): number {
  return work.settings.scheme === 'auto' ? work.fileScheme : SCHEMES.indexOf(work.settings.scheme);
}

export function wishesOf(work: Work): SurfaceWishes {
  const { settings } = work;
  const scheme = schemeNumber(work);
  return {
    scheme,
    boundary: BOUNDARIES.indexOf(settings.boundary),
    alpha: scheme === 0 ? settings.alpha : 0,
    interpolate: settings.interpolate,
    fair: settings.interpolate && settings.fair,
    smoothing: settings.smoothing * work.diagonal,
    levels: 0,
    chord: 0,
    normals: Float64Array.from(settings.interpolate ? wantedNormals(settings).flatMap(({ vertex, direction }) => [vertex, ...direction]) : []),
  };
}
