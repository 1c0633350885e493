/** What the surface is like at a place. */
import type { App } from '../app';
import type { Probe, Vec3 } from '../engine/types';
import { h } from './dom';
import { short } from './text';

function triple(vector: Float64Array): string {
  return [...vector].map((part) => short(part)).join(', ');
}

export async function askPlace(app: App, place: HTMLElement, at: Vec3): Promise<void> {
  if (!app.report) return;
  const found = await app.inOrder(() => app.engine.run<Probe>((engine) => engine.probe(at)));
  if (!found) return;
  const rows: [string, string][] = [
    ['position', triple(found.point)],
    ['normal', triple(found.normal)],
    ['mean curvature', short(found.mean)],
    ['Gaussian', short(found.gaussian)],
    ['principal', `${short(found.greatest)}, ${short(found.least)}`],
    [found.hasFirstStep ? 'face, its quad' : 'face', found.hasFirstStep ? `${found.face}, ${found.baseFace}` : String(found.face)],
    ['(u, v)', `${short(found.u)}, ${short(found.v)}`],
  ];
  place.replaceChildren(h('dl', {}, ...rows.flatMap(([name, value]) => [h('dt', {}, name), h('dd', {}, value)])));
  place.hidden = false;
  app.face.say(`Face ${found.face}, mean curvature ${short(found.mean)}, Gaussian ${short(found.gaussian)}.`);
}
