/** The work with its past and future. Knows neither the engine nor the drawing. */
import type { Patch } from './patch';
import { apply, inverse } from './patch';
import type { Work } from './work';

/** What was done, and both ways. */
export interface Step {
  readonly label: string;
  readonly forward: Patch;
  readonly back: Patch;
}

export interface Kept {
  readonly work: Work | null;
  readonly past: readonly Step[];
  readonly future: readonly Step[];
}

export type Listener = (kept: Kept, before: Work | null) => void;

export class Store {
  private kept: Kept = { work: null, past: [], future: [] };
  private readonly listeners: Listener[] = [];

  get work(): Work | null {
    return this.kept.work;
  }
  get state(): Kept {
    return this.kept;
  }

  subscribe(listener: Listener): void {
    this.listeners.push(listener);
  }

  private become(kept: Kept): void {
    const before = this.kept.work;
    this.kept = kept;
    for (const listener of this.listeners) listener(kept, before);
  }

  /** Takes up what was kept in the browser. */
  restore(kept: Kept): void {
    this.become(kept);
  }

  /** Does something new: the future is forgotten. */
  run(label: string, forward: Patch): void {
    const { work, past } = this.kept;
    const step: Step = { label, forward, back: inverse(work, forward) };
    this.become({ work: apply(work, forward), past: [...past, step], future: [] });
  }

  undo(): string | null {
    const { work, past, future } = this.kept;
    const step = past.at(-1);
    if (!step) return null;
    this.become({ work: apply(work, step.back), past: past.slice(0, -1), future: [step, ...future] });
    return step.label;
  }

  redo(): string | null {
    const { work, past, future } = this.kept;
    const step = future[0];
    if (!step) return null;
    this.become({ work: apply(work, step.forward), past: [...past, step], future: future.slice(1) });
    return step.label;
  }
}
