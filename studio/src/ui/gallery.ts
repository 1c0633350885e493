/** The project's own models, with previews. */
import { button, h } from './dom';

const files = import.meta.glob(['../../../models/*.obj', '../../../models/bent-tube.json'], { query: '?url', import: 'default', eager: true });
const previews = import.meta.glob('../../gallery/*.webp', { query: '?url', import: 'default', eager: true });

export interface Example {
  readonly name: string;
  readonly title: string;
  readonly url: string;
  readonly preview: string | null;
}

const TITLES: readonly (readonly [string, string])[] = [
  ['tripod', 'Tripod'],
  ['pipe-joint', 'Pipe joint'],
  ['creature', 'Creature'],
  ['torus-knot', 'Torus knot'],
  ['bracket', 'Bracket with creases'],
  ['flag', 'Flag'],
  ['icosahedron', 'Icosahedron'],
  ['cube', 'Cube'],
  ['broken-tripod', 'A broken mesh'],
  ['bracket-scan', 'A scan'],
  ['bent-tube', 'A medial model'],
];

function ending(all: Record<string, unknown>, end: string): string | null {
  const entry = Object.entries(all).find(([path]) => path.endsWith(end));
  return typeof entry?.[1] === 'string' ? entry[1] : null;
}

export const EXAMPLES: readonly Example[] = TITLES.flatMap(([name, title]) => {
  const file = [`${name}.obj`, `${name}.json`].find((one) => ending(files, `/${one}`));
  const url = file && ending(files, `/${file}`);
  return url ? [{ name: file, title, url, preview: ending(previews, `/${name}.webp`) }] : [];
});

/** The address of a model of the project, for a morph's other shape. */
export function modelUrl(name: string): string | null {
  return ending(files, `/${name}.obj`);
}

export function gallery(open: (example: Example) => void): HTMLElement {
  return h(
    'div',
    { class: 'gallery' },
    ...EXAMPLES.map((example) => {
      const card = button('', () => open(example), { class: 'card' });
      if (example.preview) card.append(h('img', { src: example.preview, alt: '', width: 160, height: 120 }));
      card.append(h('span', {}, example.title));
      return card;
    }),
  );
}
