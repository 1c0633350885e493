/** Puts the page together. */
import './style.css';
import type { Face } from './app';
import { App } from './app';
import type { Field } from './engine/types';
import { clear, keepIn, restore } from './state/keep';
import { workOfLink } from './state/link';
import { fitMeshTo, openFile, openUrl } from './ui/actions';
import { drawColorBar } from './ui/colorbar';
import { button, byId, h } from './ui/dom';
import { gallery } from './ui/gallery';
import { Hands } from './ui/hands';
import { fillHelp } from './ui/help';
import { listenToKeys } from './ui/keys';
import { Morpher } from './ui/morpher';
import { Panel } from './ui/panel';
import { askPlace } from './ui/probe';
import { Sculptor } from './ui/sculptor';
import { Stage } from './view/stage';

const FILES = '.obj,.ply,.off,.stl,.glb,.xyz,.json';

function isDark(): boolean {
  const chosen = document.documentElement.dataset['theme'];
  return chosen ? chosen === 'dark' : matchMedia('(prefers-color-scheme: dark)').matches;
}

function setTheme(dark: boolean, stage: Stage): void {
  document.documentElement.dataset['theme'] = dark ? 'dark' : 'light';
  stage.theme(dark);
}

function main(): void {
  const canvas = byId('canvas');
  if (!(canvas instanceof HTMLCanvasElement)) throw new Error('the page lacks its canvas');
  const stage = new Stage(canvas);
  const status = byId('status');
  const progress = byId('progress');
  const probe = byId('probe');
  const parts: { panel?: Panel } = {};
  const bar = h('progress', { max: 1, value: 0, 'aria-label': 'How much is done' });
  const face: Face = {
    say: (text, isError = false) => {
      status.textContent = text;
      status.classList.toggle('error', isError);
    },
    showScale: (field: Field | null) => {
      byId('colorbar').hidden = field === null;
      if (field) drawColorBar(byId('colorbar'), field.scale);
    },
    showProgress: (done) => {
      progress.hidden = done === null;
      bar.value = done ?? 0;
    },
    refresh: () => {
      byId('welcome').hidden = app.work !== null;
      probe.hidden = true;
      const { past, future } = app.store.state;
      undo.disabled = past.length === 0;
      redo.disabled = future.length === 0;
      parts.panel?.refresh();
    },
  };
  const app = new App(stage, face);
  const undo = button('Undo', () => app.undo());
  const redo = button('Redo', () => app.redo());
  const sculptor = new Sculptor(app);
  app.store.subscribe(() => sculptor.abandon());
  const input = h('input', { type: 'file', id: 'file', accept: FILES, 'aria-label': 'Open a file', onchange: () => takeFiles(input.files) });
  const takeFiles = (files: FileList | null): void => {
    const file = files?.[0];
    if (file) void openFile(app, file).then(() => (input.value = ''));
  };
  progress.append(bar, button('Stop', () => app.engine.stop()));
  parts.panel = new Panel(app, sculptor, new Morpher(app), byId('panel'), h('span', { class: 'file' }, 'Open a file', input));

  const help = byId('help') as HTMLDialogElement;
  fillHelp(help);
  const startAgain = button('Clear', () => {
    app.store.restore({ work: null, past: [], future: [] });
    app.engine.restart('cleared'); // its memory goes back to the machine
    void clear();
  }, { title: 'Forgets the work, which is kept in this browser and nowhere else' });
  byId('tools').append(undo, redo, startAgain, button('\u25d0', () => setTheme(!isDark(), stage), { 'aria-label': 'Light or dark', title: 'Light or dark' }), button('?', () => help.showModal(), { 'aria-label': 'Keys and hands' }));

  byId('welcome').append(
    h('h2', {}, 'Surfaces through points'),
    h('p', {}, 'Open or drop a mesh (OBJ, PLY, OFF, STL, GLB), points (XYZ) or a medial model (.srep.json), or begin with one of these. Drag a point and the surface follows. All is computed on this machine: no file leaves it.'),
    gallery((example) => void openUrl(app, example.name, example.url)),
  );
  const ask = (at: readonly [number, number, number]): void => void askPlace(app, probe, at);
  const hands = new Hands(app, sculptor, ask);
  listenToKeys(app, { openFile: () => input.click(), help: () => help.showModal(), probe: ask });
  const morpher = parts.panel.morpher;
  listenToDrops((files) => {
    const file = files?.[0];
    if (!file || !app.work) takeFiles(files);
    else
      askWhatItIs(file.name, {
        'Open it instead': () => takeFiles(files),
        'Morph into it': () => void file.arrayBuffer().then((bytes) => morpher.open(file.name, new Uint8Array(bytes))),
        'Fit this mesh to it': () => void file.arrayBuffer().then((bytes) => fitMeshTo(app, file.name, new Uint8Array(bytes))),
        'Measure how far its points are': () => void file.arrayBuffer().then((bytes) => app.measureDistances({ name: file.name, bytes: new Uint8Array(bytes) })),
        Nothing: () => undefined,
      });
  });
  setTheme(isDark(), stage);
  face.refresh();
  void Promise.all([workOfLink(location.hash).catch(() => null), restore()]).then(([linked, kept]) => {
    if (linked) void app.open(linked.source, linked.settings);
    else if (kept?.work && !app.work) app.restore(kept);
    keepIn(app.store, () => undefined);
    document.documentElement.dataset['ready'] = String(Math.round(performance.now()));
    void app.engine.run(() => Promise.resolve()); // loads it before it is needed
  });
  if ('serviceWorker' in navigator && import.meta.env.PROD) void navigator.serviceWorker.register('./offline.js').catch(() => undefined);
  // For tests and the bench page.
  Object.assign(globalThis, { studio: { app, sculptor, picker: hands.picker } });
}

/** A second file may be many things. */
function askWhatItIs(name: string, answers: Readonly<Record<string, () => void>>): void {
  const dialog = byId('second') as HTMLDialogElement;
  const buttons = Object.entries(answers).map(([text, act]) =>
    button(text, () => {
      dialog.close();
      act();
    }),
  );
  dialog.replaceChildren(h('h2', { id: 'second-title' }, `What is ${name}?`), h('div', { class: 'buttons' }, ...buttons));
  dialog.showModal();
}

function listenToDrops(take: (files: FileList | null) => void): void {
  const { body } = document;
  body.addEventListener('dragover', (event) => {
    event.preventDefault();
    body.classList.add('dropping');
  });
  body.addEventListener('dragleave', () => body.classList.remove('dropping'));
  body.addEventListener('drop', (event) => {
    event.preventDefault();
    body.classList.remove('dropping');
    take(event.dataTransfer?.files ?? null);
  });
}

main();
