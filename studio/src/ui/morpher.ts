/** From the mesh to another of the same faces. */
import type { App } from '../app';
import type { Work } from '../state/work';
import { wishesOf } from '../state/work';
import { save } from './actions';

const PLAY_MS = 2500;
/** As the tool's films. */
const FILM_SECONDS = 2;

export class Morpher {
  /** The mesh from which the morph starts, and the name of the other. */
  private from: Work | null = null;
  private time = 0;
  name = '';
  onChange: () => void = () => undefined;

  constructor(private readonly app: App) {}

  get ready(): boolean {
    return this.from !== null && this.from.source === this.app.work?.source;
  }

  async open(name: string, bytes: Uint8Array): Promise<void> {
    const { work } = this.app;
    if (!work) return;
    await this.app.inOrder(async () => {
      await this.app.withEngine((engine) => engine.startMorph(name, bytes, wishesOf(work)), work);
      this.from = work;
      this.name = name;
      this.app.face.say(`${name} is the shape to morph into.`);
    });
    this.onChange();
  }

  /** Shows a time of the morph; the work stays. */
  async preview(time: number): Promise<void> {
    const { from } = this;
    if (!from || !this.ready) return;
    this.time = time;
    await this.app.inOrder(async () => {
      if (time !== this.time) return; // a later one is wanted
      await this.app.preview({ points: await this.app.engine.run((engine) => engine.morphAt(time)) });
    });
  }

  async keep(time: number): Promise<void> {
    const { from } = this;
    if (!from || !this.ready) return;
    await this.app.inOrder(async () => {
      const points = await this.app.engine.run((engine) => engine.morphAt(time));
      this.app.store.run(`morph to ${time}`, { kind: 'all-points', points });
    });
  }

  /** The whole motion as an animation that viewers play. */
  async saveFilm(): Promise<void> {
    const { from } = this;
    if (!from || !this.ready) return;
    await this.app.inOrder(async () => {
      const bytes = await this.app.engine.run((engine) => engine.morphFilm(FILM_SECONDS));
      save('morph.glb', new Blob([bytes]));
      this.app.face.say('Saved morph.glb, an animation.');
    });
  }

  async play(): Promise<void> {
    const begin = performance.now();
    for (let time = 0; time < 1; ) {
      time = Math.min(1, (performance.now() - begin) / PLAY_MS);
      await this.preview(time);
    }
  }
}
