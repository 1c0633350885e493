/** The elastic surface: it moves while the page is looked at, and a hand pulls it. */
import type { App } from '../app';
import type { ElasticWishes, Shape, Vec3 } from '../engine/types';
import { wishesOf } from '../state/work';
import type { Shown } from '../engine/engine';
import { takeMesh } from './actions';
import { counted } from './text';

export type Material = Omit<ElasticWishes, 'scheme' | 'boundary'>;

const HAND_STIFFNESS = 400;

export class Sculptor {
  running = false;
  paused = false;
  /** Milliseconds of the last step in the engine. */
  lastMs = 0;
  onChange: () => void = () => undefined;
  /** The body has more control points than the work. */
  private refined = false;
  private pins: number[] = [];
  private waiting: (() => Promise<void>)[] = [];

  constructor(private readonly app: App) {}

  async start(material: Material): Promise<void> {
    const { work } = this.app;
    if (!work || this.running) return;
    const { scheme, boundary } = wishesOf(work);
    const shown = await this.app.inOrder(() => this.app.withEngine<Shown>((engine) => engine.startSculpting({ ...material, scheme, boundary }), work));
    if (!shown) return;
    this.app.stage.draw(shown.drawing);
    this.app.stage.wear('plain');
    this.app.face.showScale(null);
    this.app.stage.drawPoints(new Float64Array());
    this.running = true;
    this.paused = false;
    this.refined = false;
    this.pins = [];
    this.onChange();
    this.app.face.say('Sculpting: pull at the surface. Keep takes the shape over.');
    void this.loop();
  }

  private async loop(): Promise<void> {
    while (this.running) {
      const next = this.waiting.shift();
      try {
        if (next) await next();
        else if (!this.paused) await this.step();
      } catch (error) {
        this.app.face.say(error instanceof Error ? error.message : String(error), true);
        this.paused = true;
      }
      if (!next) await new Promise((resolve) => requestAnimationFrame(resolve));
    }
  }

  async step(): Promise<void> {
    const { ms } = await this.app.engine.reshape<Shape & { ms: number }>(
      (engine, room) => engine.stepSculpture(1, room),
      (shape) => {
        if (this.running) this.app.stage.reshape(shape);
      },
    );
    this.lastMs = ms;
  }

  private then(work: () => Promise<void>): void {
    this.waiting.push(work);
  }

  grab(at: Vec3): void {
    this.then(() => this.app.engine.run((engine) => engine.grab(at, HAND_STIFFNESS)));
  }
  pull(to: Vec3): void {
    this.then(() => this.app.engine.run((engine) => engine.pull(to)));
  }
  release(): void {
    this.then(() => this.app.engine.run((engine) => engine.release()));
  }

  /** Holds a place of the surface. */
  pin(at: Vec3): void {
    this.then(async () => {
      this.pins.push(...(await this.app.engine.run((engine) => engine.pin(at))));
      this.app.stage.drawPoints(Float64Array.from(this.pins));
      this.app.face.say(`${counted(this.pins.length / 3, 'place is', 'places are')} held.`);
    });
  }
  /** The same surface with four times the control points: it can bend more finely. */
  refine(): void {
    this.then(async () => {
      const { report, drawing } = await this.app.engine.run((engine) => engine.refineSculpture());
      this.refined = true;
      this.app.stage.draw(drawing);
      this.app.face.say(`Refined: ${counted(report.vertices, 'control point', 'control points')}.`);
    });
  }

  /** Something else is shown now. */
  abandon(): void {
    if (!this.running) return;
    this.running = false;
    this.onChange();
  }

  /** Ends; with `keep` the shape becomes the work, as one step. */
  async end(keep: boolean): Promise<void> {
    if (!this.running) return;
    this.running = false;
    const { work } = this.app;
    if (keep && work && this.refined) {
      await this.app.inOrder(async () => takeMesh(this.app, 'sculpt', 'sculpted', await this.app.engine.run((engine) => engine.takeSculpture())));
      this.onChange();
      return;
    }
    const points = keep && work ? await this.app.engine.run((engine) => engine.sculptedPoints(work.settings.interpolate)) : null;
    await this.app.engine.run((engine) => engine.endSculpting());
    if (points && work) this.app.store.run('sculpt', { kind: 'all-points', points });
    else this.app.redraw();
    this.onChange();
  }
}
