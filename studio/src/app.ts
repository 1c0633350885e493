/** The page without its controls: work, engine and picture, kept in step. */
import { EngineClient } from './engine/client';
import type { Drawing, Field, Measure, Moved, Preset, Report, SchemeWord, SurfaceWishes, Vec3 } from './engine/types';
import { PRESETS, SCHEMES } from './engine/types';
import type { Kept } from './state/store';
import { Store } from './state/store';
import type { Settings, Source, Work } from './state/work';
import { faceCount, isCloud, isMedial, PLAIN, vertexCount, wantedNormals, wishesOf, withNormal, workOf } from './state/work';
import type { Stage } from './view/stage';
import { counted, short, sizeOf } from './ui/text';
import { wireframe } from './view/wireframe';

export type Coloring = 'plain' | 'zebra' | Measure | Preset;

/** What the page's own parts show; the panel fills it in. */
export interface Face {
  say(text: string, isError?: boolean): void;
  showScale(field: Field | null): void;
  showProgress(done: number | null): void;
  refresh(): void;
}

const SLOW_MS = 400;
/** The length of a normal's arrow, as a share of the diagonal. */
const ARROW = 0.12;
/** Of larger meshes the surface follows a normal when the hand lets go. */
const MOST_TO_TURN = 5000;

/** The vertex that a message of the library names, or one of the face that it names. */
function placeIn(message: string, work: Work): number | null {
  const vertex = /vert(?:ex|ices) (\d+)/.exec(message);
  if (vertex) return Number(vertex[1]);
  const face = /face (\d+)/.exec(message);
  return face ? (work.faceVertices[work.faceOffsets[Number(face[1])] ?? 0] ?? null) : null;
}

function placeOf(work: Work, vertex: number): Vec3 | null {
  if (vertex >= vertexCount(work)) return null;
  const [x = 0, y = 0, z = 0] = work.points.subarray(3 * vertex, 3 * vertex + 3);
  return [x, y, z];
}

/** Vertex i of the picture belongs to point i. */
function farthest(points: Float64Array, drawn: Float32Array): number {
  let most = 0;
  for (let i = 0; i + 2 < points.length; i += 3)
    most = Math.max(most, Math.hypot((points[i] ?? 0) - (drawn[i] ?? 0), (points[i + 1] ?? 0) - (drawn[i + 1] ?? 0), (points[i + 2] ?? 0) - (drawn[i + 2] ?? 0)));
  return most;
}

export class App {
  readonly store = new Store();
  readonly engine = new EngineClient();
  report: Report | null = null;
  drawing: Drawing | null = null;
  /** Why the mesh has no surface, or empty. */
  problem = '';
  coloring: Coloring = 'plain';
  /** The surface of the points as a plain control mesh, shown beside. */
  beside: 'none' | SchemeWord = 'none';
  /** Steps of refinement that are drawn; 0: as many as suit the screen. */
  detail = 0;
  /** How far what is drawn may be from the surface, as a share of the size, instead; 0: any. */
  tolerance = 0;
  /** Of textures. */
  seed = 1;
  picked: number | null = null;
  /** Timings of the last drag, for the bench page. */
  lastMove: Moved | null = null;
  private inEngine: Work | null = null;
  private shown: Work | null = null;
  private framed: Source | null = null;
  /** What the reader says of a file. */
  private notes: { source: Source; text: string } | null = null;
  private turning: Vec3 | null = null;
  private queue: Promise<unknown> = Promise.resolve();
  private dragging: { vertex: number; wanted: Vec3 | null; to: Vec3; running: Promise<void> } | null = null;

  constructor(
    readonly stage: Stage,
    readonly face: Face,
  ) {
    this.engine.onProgress = (done) => face.showProgress(done);
    this.engine.onFrame = (drawing) => stage.draw(drawing);
    this.engine.onRestart = () => {
      this.inEngine = null;
      this.shown = null;
    };
    this.store.subscribe(() => void this.update());
  }

  get work(): Work | null {
    return this.store.work;
  }

  /** One after the other; errors are told and do not stop what follows. */
  async inOrder<T>(work: () => Promise<T>): Promise<T | undefined> {
    const turn = this.queue.then(async () => {
      const slow = setTimeout(() => this.face.showProgress(0), SLOW_MS);
      try {
        return await work();
      } catch (error) {
        this.face.say(error instanceof Error ? error.message : String(error), true);
        return undefined;
      } finally {
        clearTimeout(slow);
        this.face.showProgress(null);
      }
    });
    this.queue = turn;
    return turn;
  }

  /** Settles when nothing is running. */
  async idle(): Promise<void> {
    for (let last: unknown = null; last !== this.queue; ) {
      last = this.queue;
      await this.queue;
    }
  }

  async open(source: Source, settings: Settings = PLAIN): Promise<void> {
    await this.inOrder(async () => {
      const contents = await this.engine.run((engine) => engine.open(source.name, source.bytes));
      const opened = workOf(source, contents, settings);
      // The surface of a medial model is the one through its spokes' ends.
      const work = isMedial(opened) && settings === PLAIN ? { ...opened, settings: { ...PLAIN, interpolate: true } } : opened;
      this.notes = { source, text: contents.notes.map((note) => ` ${note}`).join('') };
      this.inEngine = work;
      this.shown = null;
      this.picked = null;
      this.store.run(`open ${source.name}`, { kind: 'work', work });
    });
    await this.idle();
  }

  restore(kept: Kept): void {
    this.store.restore(kept);
  }

  set(label: string, settings: Partial<Settings>): void {
    if (this.work) this.store.run(label, { kind: 'settings', settings });
  }

  /** The engine has the same mesh as the work. */
  private async sync(work: Work): Promise<void> {
    await this.engine.run(async (engine) => {
      const there = this.inEngine;
      if (there?.source !== work.source) await engine.open(work.source.name, work.source.bytes);
      if (there?.source !== work.source || there.points !== work.points) await engine.setPoints(work.points);
      if (there?.source !== work.source || there.creases !== work.creases || there.corners !== work.corners)
        await engine.setTags(work.creases, work.corners);
      this.inEngine = work;
    });
  }

  /** Runs on the engine after it has this work. */
  async withEngine<T>(use: Parameters<EngineClient['run']>[0], work: Work): Promise<T> {
    await this.sync(work);
    return (await this.engine.run(use)) as T;
  }

  /** Draws the work again, after something else was drawn. */
  redraw(): void {
    this.shown = null;
    void this.update();
  }

  async update(): Promise<void> {
    await this.inOrder(() => this.show());
  }

  /** In the file's unit; textures are drawn by steps. */
  chordOf(work: Work): number {
    return PRESETS.some((word) => word === this.coloring) ? 0 : this.tolerance * work.diagonal;
  }

  private drawn(work: Work): SurfaceWishes {
    return { ...wishesOf(work), levels: this.detail, chord: this.chordOf(work) };
  }

  private async show(): Promise<void> {
    const { work } = this;
    if (work === this.shown && work) return;
    this.face.refresh();
    if (!work) {
      this.stage.clearSurface();
      this.stage.cloud.clear();
      this.stage.drawPoints(new Float64Array());
      this.stage.arrows.draw([], 1);
      this.shown = null;
      this.report = null;
      this.face.showScale(null);
      this.face.say('');
      return;
    }
    if (this.framed !== work.source) {
      this.stage.frame(work.points, work.up);
      this.framed = work.source;
    }
    this.stage.drawPoints(work.points, work.origins);
    this.drawArrows(work);
    this.stage.points.pick(this.picked);
    this.stage.cloud.clear();
    this.problem = '';
    this.report = null;
    this.drawing = null;
    if (isCloud(work)) {
      this.stage.clearSurface();
      this.shown = work;
      this.face.showScale(null);
      this.face.say(`${work.source.name}: ${counted(vertexCount(work), 'point', 'points')} without faces. Fit draws a surface to them.${this.notes?.source === work.source ? this.notes.text : ''}`);
      this.face.refresh();
      return;
    }
    await this.sync(work);
    try {
      const { report, drawing } = await this.engine.run((engine) => engine.show(this.drawn(work)));
      this.report = report;
      this.drawing = drawing;
      this.shown = work;
      this.stage.draw(drawing);
      await this.color();
      this.face.say(this.resultText(work, report));
      await this.showBeside(work);
    } catch (error) {
      if (this.report) throw error; // there is a surface; what is beside it is not
      this.problem = error instanceof Error ? error.message : String(error);
      this.shown = work;
      this.stage.clearSurface();
      this.stage.control.draw(wireframe(work));
      this.face.showScale(null);
      this.stage.points.pick(placeIn(this.problem, work));
      this.face.say(this.problem, true);
    }
    this.stage.touch();
    this.face.refresh();
  }

  /** The other surface, and how far it leaves the points. */
  async showBeside(work: Work): Promise<void> {
    if (this.beside === 'none') {
      this.stage.drawBeside(null);
      return;
    }
    const scheme = SCHEMES.indexOf(this.beside);
    const { report, drawing } = await this.engine.run((engine) => engine.beside({ ...this.drawn(work), scheme, alpha: 0, interpolate: false, fair: false }));
    const left = farthest(work.points, drawing.points);
    const share = `${short((100 * left) / work.diagonal)} %`;
    this.stage.drawBeside(drawing, [`${this.report?.scheme ?? 'the surface'}${work.settings.interpolate ? ' through the points' : ''}`, `${report.scheme}, up to ${share} off the points`]);
    this.face.say(`Beside it: ${report.scheme} of the points as control mesh. It leaves the points by up to ${short(left)}, ${share} of the size.`);
  }

  /** What a tolerance has come to. */
  private drawnText(work: Work, report: Report): string {
    if (this.chordOf(work) === 0) return '';
    if (report.triangles === undefined) return ' Between its vertices it has no closed form to measure a distance from: drawn by steps.';
    return ` Drawn in ${counted(report.triangles, 'triangle', 'triangles')}, nowhere farther than ${short(this.chordOf(work))} from the surface.`;
  }

  private resultText(work: Work, report: Report): string {
    const size = isMedial(work) ? `the ends of ${counted(vertexCount(work), 'spoke', 'spokes')}, ${counted(faceCount(work), 'face', 'faces')}` : sizeOf(work);
    const drawn = this.drawnText(work, report) + (this.notes?.source === work.source ? this.notes.text : '');
    if (report.maxError === undefined) {
      const how = report.scheme.includes('Butterfly') ? `${report.scheme}, which passes through the points` : `${report.scheme} surface of this control mesh`;
      return `${work.source.name}: ${size}. ${how}.${drawn}`;
    }
    const normals = report.worstAngle === undefined ? '' : ` Normals within ${short((180 / Math.PI) * report.worstAngle)} degrees.`;
    const refined = report.isRefined ? ` Refined: ${counted(report.vertices, 'control point', 'control points')}.` : '';
    return `${work.source.name}: ${size}. Interpolated: max error ${short(report.maxError)}, ${counted(report.iterations ?? 0, 'iteration', 'iterations')}.${normals}${refined}${drawn}`;
  }

  /** Shows other points on the same faces, or other settings; the work stays. For use inside inOrder(). */
  async preview(other: Partial<Pick<Work, 'points' | 'settings'>>): Promise<void> {
    const { work } = this;
    if (!work) return;
    const shown = { ...work, ...other };
    await this.sync(shown);
    const { drawing } = await this.engine.run((engine) => engine.show(this.drawn(shown)));
    this.stage.draw(drawing);
    this.stage.drawPoints(shown.points, shown.origins);
    this.shown = null;
  }

  private drawArrows(work: Work): void {
    const arrows = wantedNormals(work.settings).map(({ vertex, direction }) => ({ vertex, direction, at: placeOf(work, vertex) ?? [0, 0, 0] }) as const);
    this.stage.arrows.draw(work.settings.interpolate ? arrows : [], ARROW * work.diagonal);
  }

  /** The normal at a point follows a hand; the surface as fast as the engine can. */
  async turnTo(vertex: number, direction: Vec3): Promise<void> {
    const { work } = this;
    if (!work) return;
    this.stage.arrows.change(vertex, { direction });
    this.stage.touch();
    this.turning = direction;
    await this.inOrder(async () => {
      if (this.turning === direction && vertexCount(work) <= MOST_TO_TURN)
        await this.preview({ settings: { ...work.settings, ...withNormal(work.settings, vertex, direction) } });
    });
  }

  /** The normal at a point, as one step; null: any. */
  setNormal(vertex: number, direction: Vec3 | null): void {
    this.turning = null;
    const { work } = this;
    if (!work) return;
    this.set(direction ? `normal at point ${vertex}` : `no normal at point ${vertex}`, withNormal(work.settings, vertex, direction));
  }

  async color(): Promise<void> {
    const { coloring } = this;
    if (coloring === 'plain' || coloring === 'zebra' || !this.report) {
      this.stage.wear(coloring === 'zebra' ? 'zebra' : 'plain');
      this.face.showScale(null);
      return;
    }
    try {
      const preset = PRESETS.findIndex((word) => word === coloring);
      if (preset >= 0) {
        this.stage.wear(await this.engine.run((engine) => engine.texture(preset, this.seed)));
        this.face.showScale(null);
        return;
      }
      const field = await this.engine.run((engine) => engine.field(coloring as Measure));
      this.stage.wear(field);
      this.face.showScale(field);
    } catch (error) {
      this.stage.wear('plain');
      this.face.showScale(null);
      throw error;
    }
  }

  /** Draws the points of another file, coloured by their distance from the surface. */
  async measureDistances(source: Source): Promise<void> {
    await this.inOrder(async () => {
      if (!this.report) throw new Error('there is no surface to measure from');
      const { points, field } = await this.engine.run((engine) => engine.distances(source.name, source.bytes));
      this.stage.cloud.draw(points, field);
      this.stage.touch();
      this.face.showScale(field);
      const count = field.numbers.length;
      const rms = Math.sqrt(field.numbers.reduce((sum, one) => sum + one * one, 0) / Math.max(1, count));
      this.face.say(`${source.name}: ${counted(count, 'point', 'points')}, distance from the surface at most ${short(field.scale.highest)}, rms ${short(rms)}.`);
    });
  }

  pick(vertex: number | null): void {
    this.picked = vertex;
    this.stage.points.pick(vertex);
    this.stage.touch();
    this.face.refresh();
  }

  pointAt(vertex: number): Vec3 | null {
    return this.work && placeOf(this.work, vertex);
  }

  /** The point goes to a place; the surface follows as fast as the engine can: places in between are left out. */
  dragTo(vertex: number, to: Vec3): void {
    this.stage.points.move(vertex, to);
    this.stage.spokes.move(vertex, to);
    this.stage.arrows.change(vertex, { at: to });
    this.stage.touch();
    if (this.dragging) {
      this.dragging.to = to;
      this.dragging.wanted = to;
      return;
    }
    const drag = { vertex, wanted: to as Vec3 | null, to, running: Promise.resolve() };
    this.dragging = drag;
    drag.running = this.follow(drag).catch((error: unknown) => this.face.say(error instanceof Error ? error.message : String(error), true));
  }

  private async follow(drag: NonNullable<App['dragging']>): Promise<void> {
    while (this.dragging === drag || drag.wanted) {
      const to = drag.wanted;
      drag.wanted = null;
      if (!to) {
        await new Promise((resolve) => setTimeout(resolve, 2));
        continue;
      }
      if (!this.drawing) continue;
      this.lastMove = await this.engine.reshape<Moved>(
        (engine, room) => engine.move(drag.vertex, to, this.work?.settings.rings ?? 0, room),
        (moved) => this.stage.reshape(moved),
      );
    }
  }

  /** The drag is one step of the history. */
  async endDrag(): Promise<void> {
    const drag = this.dragging;
    if (!drag) return;
    this.dragging = null;
    await drag.running;
    const { work } = this;
    if (!work) return;
    const { vertex, to } = drag;
    await this.inOrder(async () => {
      this.store.run(`move point ${vertex}`, { kind: 'points', vertices: [vertex], values: Float64Array.from(to) });
      const after = this.work;
      if (after && this.drawing && this.shown === work && work.settings.rings === 0) {
        await this.sync(after);
        this.shown = after;
        await this.color();
        const maxError = this.lastMove?.maxError;
        if (this.report && maxError !== undefined) this.report = { ...this.report, maxError };
        if (this.report) this.face.say(this.resultText(after, this.report));
        this.face.refresh();
      }
    });
  }

  /** Moves a point at once, as one step. */
  async movePoint(vertex: number, to: Vec3): Promise<void> {
    this.dragTo(vertex, to);
    await this.endDrag();
  }

  undo(): void {
    const label = this.store.undo();
    if (label) void this.inOrder(async () => this.face.say(`Undone: ${label}. ${this.work && this.report ? this.resultText(this.work, this.report) : ''}`));
  }
  redo(): void {
    const label = this.store.redo();
    if (label) void this.inOrder(async () => this.face.say(`Done again: ${label}. ${this.work && this.report ? this.resultText(this.work, this.report) : ''}`));
  }
}
