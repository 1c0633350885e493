/** The Embind classes of studio/engine/bindings.cpp, as Emscripten makes them. */
import type { Change, Contents, Drawing, ElasticWishes, Field, FitRound, Method, Probe, Problem, Report, Shape, SurfaceWishes } from './types';
import { EngineError } from './types';

export interface Failure {
  failure: string;
  code: number;
}
export type Result<T> = T | Failure;
export type ReportProgress = ((done: number) => boolean) | null;

/** Is shown each surface on the way to a result. */
export type WatchDrawing = ((drawing: Drawing) => void) | null;

interface Handle {
  delete(): void;
}
export interface MeshFile extends Handle {
  contents(): Contents;
  problems(): Result<Problem[]>;
  setPoints(points: Float64Array): Result<null>;
  setTags(creases: Float64Array, corners: Float64Array): Result<null>;
  repaired(weld: number): Result<{ changes: string[]; mesh: MeshFile }>;
  write(path: string, levels: number): Result<{ losses: string[] }>;
  writeAdaptive(path: string, chord: number): Result<{ losses: string[] }>;
  writeNormals(path: string, normals: Float64Array): Result<null>;
}
export interface Surface extends Handle {
  report(): Report;
  drawing(): Result<Drawing>;
  shape(room: Shape | null): Result<Shape>;
  change(room: Shape | null): Result<Change>;
  move(vertex: number, x: number, y: number, z: number, rings: number): Result<{ moved?: number; maxError?: number }>;
  follow(body: Elastic): Result<null>;
  limitPoints(): Result<Float64Array>;
  field(word: string): Result<Field>;
  texture(preset: number, seed: number): Result<Float32Array>;
  probe(x: number, y: number, z: number): Result<Probe>;
  distances(points: Float64Array): Result<Field>;
  controlFile(): Result<MeshFile>;
}
export interface Elastic extends Handle {
  grab(x: number, y: number, z: number, stiffness: number): Result<null>;
  pull(x: number, y: number, z: number): Result<null>;
  release(): Result<null>;
  step(count: number): Result<{ time: number }>;
  pin(x: number, y: number, z: number): Result<{ point: Float64Array }>;
  refine(): Result<null>;
  control(): Result<Float64Array>;
  controlFile(): Result<MeshFile>;
}
export interface ShapeMorph extends Handle {
  at(time: number): Result<Float64Array>;
  film(path: string, seconds: number, report: ReportProgress): Result<null>;
}
export interface FileSystem {
  writeFile(path: string, bytes: Uint8Array): void;
  readFile(path: string): Uint8Array<ArrayBuffer>;
  unlink(path: string): void;
}
export interface EngineModule {
  FS: FileSystem;
  HEAPU8: Uint8Array;
  readMesh(path: string, report: ReportProgress): Result<MeshFile>;
  makeSurface(file: MeshFile, wishes: SurfaceWishes, report: ReportProgress): Result<Surface>;
  makeElastic(file: MeshFile, wishes: ElasticWishes): Result<Elastic>;
  denoisedPoints(file: MeshFile, wishes: SurfaceWishes, m: number, passes: number, report: ReportProgress): Result<{ points: Float64Array; removed: number }>;
  bandedPoints(file: MeshFile, wishes: SurfaceWishes, gains: number[]): Result<{ points: Float64Array; energies: Float64Array }>;
  makeMorph(from: MeshFile, to: MeshFile, wishes: SurfaceWishes): Result<ShapeMorph>;
  comparedMethods(file: MeshFile, wishes: SurfaceWishes, report: ReportProgress): Result<Method[]>;
  fitted(points: MeshFile, cage: MeshFile | null, vertices: number, tolerance: number, report: ReportProgress, watch: WatchDrawing): Result<{ mesh: MeshFile; rms: number; max: number; outliers: number; rounds: FitRound[] }>;
}

function isFailure(result: unknown): result is Failure {
  return typeof result === 'object' && result !== null && 'failure' in result && 'code' in result && !('rounds' in result) && !('name' in result);
}

/** The result, or its failure as an exception. */
export function got<T>(result: Result<T>): T {
  if (isFailure(result)) throw new EngineError(result.failure, result.code);
  return result;
}
