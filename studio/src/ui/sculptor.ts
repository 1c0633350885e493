/** The elastic surface: it moves while the page is looked at, and a hand pulls it. */
import type { App } from '../app';
import type { ElasticWishes, Shape, Vec3 } from '../engine/types';
import { wishesOf } from '../state/work';
import type { Shown } from '../engine/engine';

export type Material = Omit<ElasticWishes, 'scheme' | 'boundary'>;

const HAND_STIFFNESS = 400;

export class Sculptor {
  running = false;
  paused = false;
  /** Milliseconds of the last step in the engine. */
  lastMs = 0;
  onChange: () => void = () => undefined;
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
    const shape = await this.app.engine.run<Shape & { ms: number }>((engine) => engine.stepSculpture(1));
    this.lastMs = shape.ms;
    if (this.running) this.app.stage.reshape(shape);
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
    const points = keep && work ? await this.app.engine.run((engine) => engine.sculptedPoints(work.settings.interpolate)) : null;
    await this.app.engine.run((engine) => engine.endSculpting());
    if (points && work) this.app.store.run('sculpt', { kind: 'all-points', points });
    else this.app.redraw();
    this.onChange();
  }
}
