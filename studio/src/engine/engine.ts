/** One mesh at work in the engine. Runs in a Worker (worker.ts) and, for tests, in Node. */
import type { EngineModule, Elastic, MeshFile, ReportProgress, ShapeMorph, Surface, WatchDrawing } from './module';
import { got } from './module';
import type { Contents, Corner, Crease, Drawing, ElasticWishes, Field, FitRound, Measure, Method, Moved, Probe, Problem, Report, Shape, SurfaceWishes, Vec3, Written } from './types';

export interface Shown {
  report: Report;
  drawing: Drawing;
}
export interface Fitted {
  contents: Contents;
  rms: number;
  max: number;
  outliers: number;
  rounds: FitRound[];
}

/** The end of a file's name, which tells its format; the engine's own name has nothing else of it. */
function engineName(name: string): string {
  const match = /\.([A-Za-z0-9]{1,5})$/.exec(name);
  return `/input.${match?.[1]?.toLowerCase() ?? 'obj'}`;
}

export class Engine {
  private file: MeshFile | null = null;
  private morph: ShapeMorph | null = null;
  private surface: Surface | null = null;
  private elastic: Elastic | null = null;
  private elasticWishes: ElasticWishes | null = null;
  private sculpted: Surface | null = null;

  constructor(
    private readonly module: EngineModule,
    private readonly report: ReportProgress,
    private readonly watch: WatchDrawing = null,
  ) {}

  private get mesh(): MeshFile {
    if (!this.file) throw new Error('open a file first');
    return this.file;
  }
  private get shown(): Surface {
    if (!this.surface) throw new Error('there is no surface yet');
    return this.surface;
  }

  private read(name: string, bytes: Uint8Array): MeshFile {
    const path = engineName(name);
    this.module.FS.writeFile(path, bytes);
    try {
      return got(this.module.readMesh(path, this.report));
    } catch (error) {
      if (error instanceof Error) error.message = error.message.replaceAll(path, name);
      throw error;
    } finally {
      this.module.FS.unlink(path);
    }
  }

  private take(file: MeshFile): Contents {
    this.close();
    this.file = file;
    return file.contents();
  }

  close(): void {
    this.endSculpting();
    this.surface?.delete();
    this.file?.delete();
    this.surface = null;
    this.file = null;
  }

  open(name: string, bytes: Uint8Array): Contents {
    const file = this.read(name, bytes);
    return this.take(file);
  }

  /** The morph from the mesh, as its points are now, to another of the same faces. */
  startMorph(name: string, bytes: Uint8Array, wishes: SurfaceWishes): void {
    const end = this.read(name, bytes);
    try {
      const morph = got(this.module.makeMorph(this.mesh, end, wishes));
      this.morph?.delete();
      this.morph = morph;
    } finally {
      end.delete();
    }
  }

  private get morphing(): ShapeMorph {
    if (!this.morph) throw new Error('open the shape to morph into first');
    return this.morph;
  }

  /** The points at a time of it. */
  morphAt(time: number): Float64Array {
    return got(this.morphing.at(time));
  }

  /** The surface in motion, as GLB. */
  morphFilm(seconds: number): Uint8Array<ArrayBuffer> {
    got(this.morphing.film('/film.glb', seconds, this.report));
    const bytes = this.module.FS.readFile('/film.glb');
    this.module.FS.unlink('/film.glb');
    return bytes;
  }

  problems(): Problem[] {
    return got(this.mesh.problems());
  }

  repair(weld: number): { changes: string[]; contents: Contents } {
    const repaired = got(this.mesh.repaired(weld));
    return { changes: repaired.changes, contents: this.take(repaired.mesh) };
  }

  setPoints(points: Float64Array): void {
    got(this.mesh.setPoints(points));
  }

  setTags(creases: readonly Crease[], corners: readonly Corner[]): void {
    got(this.mesh.setTags(
      Float64Array.from(creases.flatMap((crease) => [crease.a, crease.b, crease.sharpness])),
      Float64Array.from(corners.flatMap((corner) => [corner.vertex, corner.sharpness])),
    ));
  }

  show(wishes: SurfaceWishes): Shown {
    const surface = got(this.module.makeSurface(this.mesh, wishes, this.report));
    this.endSculpting();
    this.surface?.delete();
    this.surface = surface;
    const drawing = got(surface.drawing());
    return { report: surface.report(), drawing };
  }

  /** Another surface of the same mesh, to be drawn beside the first. */
  beside(wishes: SurfaceWishes): Shown {
    const other = got(this.module.makeSurface(this.mesh, wishes, this.report));
    try {
      return { report: other.report(), drawing: got(other.drawing()) };
    } finally {
      other.delete();
    }
  }

  /**
   * Moves one point; the surface follows. The file's points follow by setPoints(), when the drag ends.
   * room: the arrays of an earlier answer, to be filled again; fresh ones are cleared first.
   */
  move(vertex: number, to: Vec3, rings: number, room: Shape | null = null): Moved {
    const begin = performance.now();
    const report = got(this.shown.move(vertex, to[0], to[1], to[2], rings));
    const solved = performance.now();
    const change = got(this.shown.change(room));
    return { ...change, maxError: report.maxError, solveMs: solved - begin, drawMs: performance.now() - solved };
  }

  field(measure: Measure): Field {
    return got(this.shown.field(measure));
  }

  /** sRGB of each vertex drawn; preset: a place in PRESETS. */
  texture(preset: number, seed: number): Float32Array {
    return got(this.shown.texture(preset, seed));
  }

  /** Bytes that the engine has taken; it never gives them back but uses them again. */
  memory(): number {
    return this.module.HEAPU8.length;
  }

  probe(at: Vec3): Probe {
    return got(this.shown.probe(at[0], at[1], at[2]));
  }

  /** How far the points of another file are from the surface. */
  distances(name: string, bytes: Uint8Array): { points: Float64Array; field: Field } {
    const file = this.read(name, bytes);
    try {
      const { points } = file.contents();
      return { points, field: got(this.shown.distances(points)) };
    } finally {
      file.delete();
    }
  }

  /** The control mesh as a file, or with `levels` 0 or more the surface as a mesh; or with a chord as an adaptive one. */
  write(format: string, levels: number, chord: number): Written {
    const control = this.surface ? got(this.surface.controlFile()) : null;
    const path = `/output.${format}`;
    try {
      const file = control ?? this.mesh;
      const { losses } = got(chord > 0 ? file.writeAdaptive(path, chord) : file.write(path, levels));
      return { bytes: this.module.FS.readFile(path), losses };
    } finally {
      control?.delete();
    }
  }

  /** The mesh given, with all its tags. */
  writeMesh(): Uint8Array<ArrayBuffer> {
    got(this.mesh.write('/mesh.obj', -1));
    return this.module.FS.readFile('/mesh.obj');
  }

  /** The mesh given with these normals (SurfaceWishes), as PLY: what the tool's --normals takes. */
  writeNormals(normals: Float64Array): Uint8Array<ArrayBuffer> {
    got(this.mesh.writeNormals('/normals.ply', normals));
    return this.module.FS.readFile('/normals.ply');
  }

  methods(wishes: SurfaceWishes): Method[] {
    return got(this.module.comparedMethods(this.mesh, wishes, this.report));
  }

  denoise(wishes: SurfaceWishes, m: number, passes: number): { points: Float64Array; removed: number } {
    return got(this.module.denoisedPoints(this.mesh, wishes, m, passes, this.report));
  }

  bands(wishes: SurfaceWishes, gains: readonly number[]): { points: Float64Array; energies: Float64Array } {
    return got(this.module.bandedPoints(this.mesh, wishes, [...gains]));
  }

  /** A surface to the points. */
  fit(vertices: number, tolerance: number): Fitted {
    return this.fitMesh(this.mesh, null, vertices, tolerance);
  }

  /** The mesh becomes a control mesh whose surface hugs the points of another file; its faces stay. */
  fitTo(name: string, bytes: Uint8Array, tolerance: number): Fitted {
    const points = this.read(name, bytes);
    try {
      return this.fitMesh(points, this.mesh, 0, tolerance);
    } finally {
      points.delete();
    }
  }

  private fitMesh(points: MeshFile, cage: MeshFile | null, vertices: number, tolerance: number): Fitted {
    const fitted = got(this.module.fitted(points, cage, vertices, tolerance, this.report, this.watch));
    const { rms, max, outliers, rounds } = fitted;
    return { contents: this.take(fitted.mesh), rms, max, outliers, rounds };
  }

  /** The body is the control mesh of the surface that is shown. */
  startSculpting(wishes: ElasticWishes): Shown {
    this.endSculpting();
    const control = got(this.shown.controlFile());
    try {
      this.elastic = got(this.module.makeElastic(control, wishes));
      this.elasticWishes = wishes;
      return this.showSculpture(control);
    } finally {
      control.delete();
    }
  }
  private showSculpture(control: MeshFile): Shown {
    const { scheme, boundary } = this.elasticWishes ?? { scheme: 0, boundary: 0 };
    const plain: SurfaceWishes = { scheme, boundary, alpha: 0, interpolate: false, fair: false, smoothing: 0, levels: 0, chord: 0, normals: new Float64Array() };
    const surface = got(this.module.makeSurface(control, plain, null));
    this.sculpted?.delete();
    this.sculpted = surface;
    return { report: surface.report(), drawing: got(surface.drawing()) };
  }
  /** Goes on with four times the control points. */
  refineSculpture(): Shown {
    if (!this.elastic) throw new Error('nothing is being sculpted');
    got(this.elastic.refine());
    const control = got(this.elastic.controlFile());
    try {
      return this.showSculpture(control);
    } finally {
      control.delete();
    }
  }
  /** Holds a place of the body: where it is. */
  pin(at: Vec3): Float64Array {
    if (!this.elastic) throw new Error('nothing is being sculpted');
    return got(this.elastic.pin(at[0], at[1], at[2])).point;
  }
  /** The body as a control mesh becomes the mesh. */
  takeSculpture(): Contents {
    if (!this.elastic) throw new Error('nothing is being sculpted');
    return this.take(got(this.elastic.controlFile()));
  }
  grab(at: Vec3, stiffness: number): void {
    if (this.elastic) got(this.elastic.grab(at[0], at[1], at[2], stiffness));
  }
  pull(to: Vec3): void {
    if (this.elastic) got(this.elastic.pull(to[0], to[1], to[2]));
  }
  release(): void {
    if (this.elastic) got(this.elastic.release());
  }
  /** room: as move() has it. */
  stepSculpture(count: number, room: Shape | null = null): Shape & { ms: number } {
    if (!this.elastic || !this.sculpted) throw new Error('nothing is being sculpted');
    const begin = performance.now();
    got(this.elastic.step(count));
    const ms = performance.now() - begin;
    got(this.sculpted.follow(this.elastic));
    return { ...got(this.sculpted.shape(room)), ms };
  }
  /** The points through which the sculpted surface passes, or its control points. */
  sculptedPoints(interpolated: boolean): Float64Array {
    if (!this.elastic || !this.sculpted) throw new Error('nothing is being sculpted');
    return interpolated ? got(this.sculpted.limitPoints()) : got(this.elastic.control());
  }
  endSculpting(): void {
    this.elastic?.delete();
    this.sculpted?.delete();
    this.elastic = null;
    this.sculpted = null;
  }
}
