/** Keys: everything that hands can do. */
import type { App } from '../app';
import type { Vec3 } from '../engine/types';
import { edgesOf } from '../view/wireframe';
import { creaseEdge, nudge, pickNext, toggleInterpolation } from './actions';

const NUDGE = 0.002;
const FAR = 10;
const NUDGES: Readonly<Record<string, Vec3>> = {
  ArrowRight: [1, 0, 0],
  ArrowLeft: [-1, 0, 0],
  ArrowUp: [0, 0, 1],
  ArrowDown: [0, 0, -1],
  PageUp: [0, 1, 0],
  PageDown: [0, -1, 0],
};

export interface KeyTargets {
  openFile(): void;
  help(): void;
  probe(at: Vec3): void;
}

export function listenToKeys(app: App, targets: KeyTargets): void {
  let edge = 0;
  const creaseNext = (): void => {
    const { work, picked } = app;
    if (!work || picked === null) return;
    const edges = edgesOf(work).filter((ends) => ends.includes(picked));
    const one = edges[edge++ % Math.max(1, edges.length)];
    if (one) creaseEdge(app, one, false);
  };
  const letters: Readonly<Record<string, () => void>> = {
    o: () => targets.openFile(),
    i: () => toggleInterpolation(app),
    n: () => pickNext(app, 1),
    N: () => pickNext(app, -1),
    k: creaseNext,
    f: () => app.stage.look('front'),
    r: () => app.stage.look('right'),
    t: () => app.stage.look('top'),
    h: () => app.stage.look('home'),
    '+': () => app.stage.nearer(1.2),
    '-': () => app.stage.nearer(1 / 1.2),
    '?': () => targets.help(),
  };
  window.addEventListener('keydown', (event) => {
    const inField = event.target instanceof HTMLInputElement || event.target instanceof HTMLSelectElement;
    if ((event.ctrlKey || event.metaKey) && !inField) {
      if (event.key === 'z' && !event.shiftKey) app.undo();
      else if (event.key === 'y' || (event.key === 'z' && event.shiftKey) || event.key === 'Z') app.redo();
      else return;
      event.preventDefault();
      return;
    }
    if (event.key === 'Escape') {
      app.engine.stop();
      app.pick(null);
      return;
    }
    if (inField || event.altKey || event.ctrlKey || event.metaKey) return;
    if (event.target === app.stage.canvas && app.picked !== null) {
      const direction = NUDGES[event.key];
      if (direction) {
        void nudge(app, direction, event.shiftKey ? FAR * NUDGE : NUDGE);
        event.preventDefault();
        return;
      }
      const at = event.key === 'Enter' ? app.pointAt(app.picked) : null;
      if (at) targets.probe(at);
    }
    letters[event.key]?.();
  });
}
