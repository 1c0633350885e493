/** What the engine gives and takes: as the C++ side states it (studio/engine/*.h), lengths in the file's unit. */

export type Vec3 = readonly [number, number, number];

/** One kind of change at a vertex pair or vertex, as OBJ tags have them: sharpness 10 is for ever. */
export interface Crease {
  readonly a: number;
  readonly b: number;
  readonly sharpness: number;
}
export interface Corner {
  readonly vertex: number;
  readonly sharpness: number;
}

export const SCHEMES = ['catmull-clark', 'loop', 'butterfly', 'modified-butterfly'] as const;
export const BOUNDARIES = ['none', 'edge-and-corner', 'edge-only'] as const;
/** TexturePreset. */
export const PRESETS = ['marble', 'wood', 'granite', 'rust', 'clouds'] as const;
export type Preset = (typeof PRESETS)[number];
export type SchemeWord = (typeof SCHEMES)[number];
export type BoundaryWord = (typeof BOUNDARIES)[number];

export interface Contents {
  points: Float64Array;
  faceOffsets: Int32Array;
  faceVertices: Int32Array;
  creases: Float64Array;
  corners: Float64Array;
  notes: string[];
  diagonal: number;
  /** UpAxis: 1 x, 2 y, 3 z, then with a minus. */
  up: number;
  triangles: boolean;
  scheme: number;
  /** Where the spokes of a medial model start that end at the points; or none. */
  origins: Float64Array;
}

export interface Problem {
  code: number;
  count: number;
  messages: string[];
}

export interface SurfaceWishes {
  scheme: number;
  boundary: number;
  alpha: number;
  interpolate: boolean;
  fair: boolean;
  smoothing: number;
  levels: number;
  /** How far what is drawn may be from the surface, instead of levels; 0: any. */
  chord: number;
  /** Wanted normals, four numbers each: a vertex and a direction. */
  normals: Float64Array;
}

export interface Report {
  vertices: number;
  faces: number;
  points: number;
  isRefined: boolean;
  diagonal: number;
  scheme: string;
  levels: number;
  /** What was drawn under a tolerance. */
  triangles?: number;
  maxError?: number;
  rmsError?: number;
  maxMovement?: number;
  method?: string;
  /** Of solving alone. */
  seconds?: number;
  iterations?: number;
  residuals?: Float64Array;
  measuredAfter?: Int32Array;
  singular?: number;
  /** Between normals wanted and reached, in radians. */
  worstAngle?: number;
}

export interface Shape {
  points: Float32Array;
  normals: Float32Array;
  control: Float32Array;
}
export interface Drawing extends Shape {
  triangles: Uint32Array;
  edges: Uint32Array;
  sharpness: Float32Array;
}

/** What moved of a Shape: rows of these vertices only, or without `vertices` all of it. */
export interface Change extends Shape {
  vertices?: Int32Array;
  /** Whose control points are in `control`. */
  moved?: Int32Array;
  /** Under a tolerance other ones each time. */
  triangles?: Uint32Array;
}

export interface Moved extends Change {
  maxError?: number;
  /** Milliseconds that solving and drawing took in the engine. */
  solveMs: number;
  drawMs: number;
}

export interface Scale {
  title: string;
  unit: string;
  low: number;
  high: number;
  lowest: number;
  highest: number;
  lowestText: string;
  highestText: string;
  colors: Uint8Array;
  ticks: { place: number; text: string }[];
}
export interface Field {
  numbers: Float64Array;
  positions: Float32Array;
  scale: Scale;
}
export type Measure = 'error' | 'moved' | 'mean' | 'gaussian' | 'valence' | 'sharpness';

export interface Probe {
  face: number;
  baseFace: number;
  hasFirstStep: boolean;
  u: number;
  v: number;
  mean: number;
  gaussian: number;
  greatest: number;
  least: number;
  distance: number;
  point: Float64Array;
  normal: Float64Array;
}

export interface ElasticWishes {
  scheme: number;
  boundary: number;
  tension: number;
  rigidity: number;
  damping: number;
  pressure: number;
  gravity: number;
  floor: boolean;
  holdBoundary: boolean;
}

export interface Method {
  name: string;
  failure: string;
  iterations: number;
  seconds: number;
  maxError: number;
  residuals: Float64Array;
  measuredAfter: Int32Array;
}

export interface FitRound {
  vertices: number;
  rms: number;
  max: number;
}

export interface Written {
  bytes: Uint8Array<ArrayBuffer>;
  losses: string[];
}

/** An error of the library: its code (src/batten/error.h) and its sentence. */
export class EngineError extends Error {
  constructor(
    message: string,
    readonly code: number,
  ) {
    super(message);
    this.name = 'EngineError';
  }
}
