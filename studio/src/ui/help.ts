/** The list of keys. */
import { button, h } from './dom';

const KEYS: readonly (readonly [string, string])[] = [
  ['O', 'open a file'],
  ['I', 'interpolate: the surface passes through the points, or not'],
  ['N, Shift N', 'pick the next or the previous point'],
  ['Arrow keys, Page Up, Page Down', 'move the picked point along the axes; with Shift ten times as far'],
  ['K', 'crease along the next edge at the picked point; again for the one after'],
  ['Enter', 'ask for the place of the surface at the picked point'],
  ['F, R, T, H', 'look from the front, the right, the top, home'],
  ['+, \u2212', 'nearer, farther'],
  ['Ctrl Z, Ctrl Y', 'undo, redo'],
  ['Esc', 'stop what is running; let go of the point'],
  ['?', 'this list'],
];
const HANDS: readonly (readonly [string, string])[] = [
  ['Drag beside a point', 'turn the view; the right button moves it; the wheel zooms'],
  ['Drag a point', 'move it; the surface follows'],
  ['Click the surface', 'position, normal, curvatures, face and (u, v) there'],
  ['Alt click an edge', 'make it a crease, or smooth again; a double click takes the whole loop'],
  ['One finger, two fingers', 'turn; move and zoom. A tap with two fingers undoes'],
];

export function fillHelp(dialog: HTMLDialogElement): void {
  const rows = (list: typeof KEYS): HTMLElement => h('dl', {}, ...list.flatMap(([key, what]) => [h('dt', {}, key), h('dd', {}, what)]));
  dialog.replaceChildren(
    h('h2', { id: 'help-title' }, 'Keys and hands'),
    rows(KEYS),
    rows(HANDS),
    button('Close', () => dialog.close(), { autofocus: true }),
  );
}
