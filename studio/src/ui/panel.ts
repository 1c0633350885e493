/** The tools beside the picture. */
import type { App, Coloring } from '../app';
import type { BoundaryWord, FitRound, Method, Vec3 } from '../engine/types';
import { PRESETS } from '../engine/types';
import { bandsCommand, commandFor, denoiseCommand, fitCommand, morphCommand, repairCommand, textureCommand } from '../state/command';
import type { Settings, Work } from '../state/work';
import { isCloud, isMedial, wantedNormals, wishesOf } from '../state/work';
import { copyLink, creaseSharpness, denoise, download, downloadNormals, downloadPicture, equalize, fitMeshTo, fitSurface, nudge, repairMesh, toggleCorner, toggleInterpolation, toggleNormal } from './actions';
import { button, choice, fileButton, h, section, slider, tick } from './dom';
import { plotMethods, plotRounds } from './plot';
import { modelUrl } from './gallery';
import type { Morpher } from './morpher';
import type { Sculptor } from './sculptor';
import { counted, extentOf } from './text';

const SCHEME_CHOICES: readonly (readonly [Settings['scheme'], string])[] = [
  ['auto', 'as the mesh asks'],
  ['catmull-clark', 'Catmull-Clark'],
  ['loop', 'Loop'],
  ['butterfly', 'Butterfly'],
  ['modified-butterfly', 'Modified Butterfly'],
];
const BOUNDARY_CHOICES: readonly (readonly [BoundaryWord, string])[] = [
  ['edge-only', 'smooth curves'],
  ['edge-and-corner', 'curves with corners'],
  ['none', 'left open'],
];
const COLORINGS: readonly (readonly [Coloring, string])[] = [
  ['plain', 'nothing'],
  ['error', 'error'],
  ['moved', 'distance moved'],
  ['mean', 'mean curvature'],
  ['gaussian', 'Gaussian curvature'],
  ['zebra', 'zebra stripes'],
  ['valence', 'valence'],
  ['sharpness', 'sharpness'],
  ['marble', 'marble'],
  ['wood', 'wood'],
  ['granite', 'granite'],
  ['rust', 'rust'],
  ['clouds', 'clouds'],
];
const BESIDE_CHOICES: readonly (readonly [App['beside'], string])[] = [
  ['none', 'nothing'],
  ['catmull-clark', 'plain Catmull-Clark'],
  ['loop', 'plain Loop'],
  ['butterfly', 'Butterfly'],
  ['modified-butterfly', 'Modified Butterfly'],
];
const BANDS = ['up to 4 edges', '4 to 8', '8 to 16', 'the shape'];
const FORMATS = ['obj', 'ply', 'off', 'stl', 'usda', 'glb'] as const;

/** In % of the size. */
const TOLERANCES = [['0', 'none'], ['1', '1 %'], ['0.3', '0.3 %'], ['0.1', '0.1 %'], ['0.03', '0.03 %'], ['0.01', '0.01 %']] as const;

function isTexture(coloring: Coloring): boolean {
  return PRESETS.some((preset) => preset === coloring);
}

export class Panel {
  private readonly refreshers: (() => void)[] = [];
  private budget = 400;

  constructor(
    private readonly app: App,
    private readonly sculptor: Sculptor,
    readonly morpher: Morpher,
    place: HTMLElement,
    fileInput: HTMLElement,
  ) {
    place.append(
      section('Mesh', true, this.extent(), h('div', { class: 'buttons' }, fileInput, this.needs(button('Repair', () => void repairMesh(app)), () => app.work !== null)), this.command((work) => (app.problem ? repairCommand(work) : null))),
      this.surfaceSection(),
      this.lookSection(),
      this.pointSection(),
      this.sculptSection(),
      this.smoothSection(),
      this.morphSection(),
      this.fitSection(),
      this.saveSection(),
    );
    sculptor.onChange = () => this.refresh();
    morpher.onChange = () => this.refresh();
  }

  refresh(): void {
    for (const one of this.refreshers) one();
  }

  private extent(): HTMLElement {
    const note = h('p', { class: 'note' });
    let told: Float64Array | null = null;
    this.refreshers.push(() => {
      const { work } = this.app;
      note.hidden = !work;
      if (!work || work.points === told) return;
      told = work.points;
      note.textContent = extentOf(work);
    });
    return note;
  }

  /** Enabled only where `can` says so. */
  private needs<Control extends HTMLButtonElement | HTMLInputElement>(control: Control, can: () => boolean): Control {
    const set = (): void => void (control.disabled = !can());
    this.refreshers.push(set);
    set();
    return control;
  }

  /** The command that does this to the file as it was opened; null while there is none. */
  private command(text: (work: Work) => string | null): HTMLElement {
    const code = h('code', {});
    const copy = button('Copy', () => void navigator.clipboard.writeText(code.textContent ?? '').then(() => this.app.face.say('Copied.')), { title: 'Copy the command that does this to the file as it was opened' });
    const line = h('div', { class: 'command' }, code, copy);
    this.refreshers.push(() => {
      const shown = this.app.work ? text(this.app.work) : null;
      line.hidden = shown === null;
      code.textContent = shown;
    });
    return line;
  }

  private get hasFaces(): boolean {
    return this.app.work !== null && !isCloud(this.app.work);
  }

  private surfaceSection(): HTMLElement {
    const { app } = this;
    const toggle = this.needs(button('Interpolate', () => toggleInterpolation(app), { class: 'first', 'aria-pressed': 'false' }), () => this.hasFaces);
    const scheme = choice('Scheme', SCHEME_CHOICES, (word) => app.set(`scheme ${word}`, { scheme: word }));
    const boundary = choice('Boundary', BOUNDARY_CHOICES, (word) => app.set(`boundary ${word}`, { boundary: word }));
    const alpha = slider('Alpha', { min: 0, max: 1, step: 0.05, value: 0 }, { change: (value) => app.set(`alpha ${value}`, { alpha: value }) });
    const fair = tick('Fairest surface through the points', false, (checked) => app.set(checked ? 'fair' : 'not fair', { fair: checked }));
    const plot = h('div', { class: 'plot', 'aria-label': 'Residuals of the iterations' });
    const compare = this.needs(button('Compare methods', () => void this.compare(plot)), () => this.hasFaces);
    this.refreshers.push(() => {
      const settings = app.work?.settings;
      toggle.setAttribute('aria-pressed', String(settings?.interpolate ?? false));
      scheme.set(settings?.scheme ?? 'auto');
      boundary.set(settings?.boundary ?? 'edge-only');
      alpha.set(settings?.alpha ?? 0);
      fair.input.checked = settings?.fair ?? false;
    });
    return section('Surface', true, h('div', { class: 'buttons' }, toggle, compare), scheme.element, boundary.element, alpha.element, fair.element, plot, this.command((work) => commandFor(work, this.budget, app.tolerance)));
  }

  private async compare(plot: HTMLElement): Promise<void> {
    const { app } = this;
    const { work } = app;
    if (!work) return;
    const methods = await app.inOrder(() => app.withEngine<Method[]>((engine) => engine.methods(wishesOf(work)), work));
    if (!methods) return;
    plotMethods(plot, methods);
    app.face.say(methods.map((method) => (method.failure ? `${method.name}: ${method.failure}` : `${method.name}: ${method.iterations > 0 ? counted(method.iterations, 'iteration', 'iterations') : 'at once'}`)).join('. ') + '.');
  }

  private lookSection(): HTMLElement {
    const { app } = this;
    const { stage } = app;
    const coloring = choice('Colour by', COLORINGS, (word) => {
      const drawnOtherwise = app.tolerance > 0 && isTexture(word) !== isTexture(app.coloring);
      app.coloring = word;
      seed.element.hidden = !isTexture(word);
      this.refresh();
      if (drawnOtherwise) app.redraw();
      else void app.inOrder(() => app.color());
    });
    const show = (object: { visible: boolean }, label: string): HTMLElement =>
      tick(label, true, (checked) => {
        object.visible = checked;
        stage.touch();
      }).element;
    const beside = choice('Beside it', BESIDE_CHOICES, (word) => {
      app.beside = word;
      const { work } = app;
      if (work && app.report) void app.inOrder(() => app.showBeside(work));
    });
    const seed = slider('Seed', { min: 1, max: 50, step: 1, value: 1 }, {
      change: (value) => {
        app.seed = value;
        this.refresh();
        void app.inOrder(() => app.color());
      },
    });
    seed.element.hidden = true;
    const measured = fileButton('Measure points', 'Points to measure from the surface', (name, bytes) => void app.measureDistances({ name, bytes }));
    const detail = slider('Detail', { min: 0, max: 6, step: 1, value: 0, words: (value) => (value > 0 ? String(value) : 'auto') }, {
      change: (value) => {
        app.detail = value;
        app.redraw();
      },
    });
    detail.element.title = 'Steps of refinement that are drawn; 0: as many as suit the screen';
    const tolerance = choice('Tolerance', TOLERANCES, (word) => {
      app.tolerance = Number(word) / 100;
      detail.input.disabled = app.tolerance > 0;
      app.redraw();
    });
    tolerance.element.title = 'Instead of steps: as few triangles as stay so near to the surface, in % of the mesh\u2019s size';
    const spokes = show(stage.spokes.object, 'Spokes');
    this.refreshers.push(() => void (spokes.hidden = !app.work || !isMedial(app.work)));
    const flat = tick('Without perspective', false, (checked) => void (stage.isFlat = checked));
    const views = (['front', 'right', 'top', 'home'] as const).map((view) => button(view[0]?.toUpperCase() + view.slice(1), () => stage.look(view)));
    return section('Look', true, coloring.element, beside.element, seed.element, this.command((work) => (isTexture(app.coloring) ? textureCommand(work, app.coloring, app.seed) : null)), show(stage.control.group, 'Control mesh'), show(stage.points.object, 'Points'), show(stage.shadows, 'Shadow'), spokes, flat.element, detail.element, tolerance.element, h('div', { class: 'buttons' }, ...views), h('div', { class: 'buttons' }, measured.element));
  }

  private pointSection(): HTMLElement {
    const { app } = this;
    const title = h('p', { class: 'note' });
    const inputs = (['x', 'y', 'z'] as const).map((axis, i) => {
      const input = h('input', { type: 'number', step: 'any', onchange: () => this.type(i, input.valueAsNumber) });
      return { element: h('label', { class: 'row' }, h('span', {}, axis), this.needs(input, () => app.picked !== null)), input };
    });
    const wanted = (): Vec3 | null => (app.work && wantedNormals(app.work.settings).find((one) => one.vertex === app.picked)?.direction) ?? null;
    const turns = (['x', 'y', 'z'] as const).map((axis, i) => {
      const input = h('input', { type: 'number', step: '0.05', onchange: () => this.turn(wanted(), i, input.valueAsNumber) });
      return { element: h('label', { class: 'row' }, h('span', {}, `normal ${axis}`), this.needs(input, () => wanted() !== null)), input };
    });
    const normal = this.needs(button('Normal', () => toggleNormal(app), { 'aria-pressed': 'false', title: 'The surface keeps its normal at the picked point, until you drag the arrow' }), () => app.picked !== null && (app.work?.settings.interpolate ?? false) && app.drawing !== null);
    const save = this.needs(button('Download normals', () => void downloadNormals(app)), () => app.work !== null && wantedNormals(app.work.settings).length > 0);
    const sharpness = slider('Sharpness', { min: 0.5, max: 10, step: 0.5, value: 10 }, { input: (value) => void (creaseSharpness.value = value) });
    const rings = slider('Reach, rings', { min: 0, max: 6, step: 1, value: 0 }, { change: (value) => app.set(`reach ${value}`, { rings: value }) });
    const corner = this.needs(button('Corner', () => toggleCorner(app)), () => app.picked !== null);
    this.refreshers.push(() => {
      const at = app.picked === null ? null : app.pointAt(app.picked);
      title.textContent = at ? `Point ${app.picked}` : 'Click a point to pick it, or press N. Alt click an edge to crease it.';
      inputs.forEach(({ input }, i) => void (input.value = at ? String(at[i]) : ''));
      const direction = wanted();
      normal.setAttribute('aria-pressed', String(direction !== null));
      turns.forEach(({ input }, i) => void (input.value = direction ? String(Number(direction[i]?.toPrecision(4))) : ''));
      rings.set(app.work?.settings.rings ?? 0);
    });
    return section('Points and creases', false, title, ...inputs.map((one) => one.element), h('div', { class: 'buttons' }, normal, save), ...turns.map((one) => one.element), sharpness.element, h('div', { class: 'buttons' }, corner), rings.element, h('p', { class: 'note' }, 'Reach 0: a change goes as far as it must.'));
  }

  private type(axis: number, value: number): void {
    const { app } = this;
    const from = app.picked === null ? null : app.pointAt(app.picked);
    if (app.picked === null || !from || !Number.isFinite(value)) return;
    const to: Vec3 = [axis === 0 ? value : from[0], axis === 1 ? value : from[1], axis === 2 ? value : from[2]];
    void app.movePoint(app.picked, to);
  }

  private turn(from: Vec3 | null, axis: number, value: number): void {
    const { app } = this;
    if (app.picked === null || !from || !Number.isFinite(value)) return;
    const to: Vec3 = [axis === 0 ? value : from[0], axis === 1 ? value : from[1], axis === 2 ? value : from[2]];
    if (Math.hypot(...to) > 0) app.setNormal(app.picked, to);
  }

  private sculptSection(): HTMLElement {
    const { app, sculptor } = this;
    const material = { tension: 40, rigidity: 0.1, damping: 4, pressure: 0, gravity: 0, floor: false, holdBoundary: true };
    const part = (label: string, name: 'tension' | 'damping' | 'pressure' | 'gravity', min: number, max: number, step: number): HTMLElement =>
      slider(label, { min, max, step, value: material[name] }, { change: (value) => void this.remake(() => void (material[name] = value), material) }).element;
    const bending = slider('Bending, 10\u02e3', { min: -3, max: 2, step: 0.5, value: -1 }, { change: (value) => void this.remake(() => void (material.rigidity = 10 ** value), material) });
    const floor = tick('A floor to land on', false, (checked) => void this.remake(() => void (material.floor = checked), material));
    const hold = tick('Hold the boundary', true, (checked) => void this.remake(() => void (material.holdBoundary = checked), material));
    const start = this.needs(button('Sculpt', () => void sculptor.start({ ...material }), { class: 'first' }), () => this.hasFaces && !sculptor.running && app.report !== null);
    const keep = this.needs(button('Keep', () => void sculptor.end(true)), () => sculptor.running);
    const leave = this.needs(button('Leave', () => void sculptor.end(false)), () => sculptor.running);
    const pause = this.needs(button('Pause', () => void (sculptor.paused = !sculptor.paused)), () => sculptor.running);
    const step = this.needs(button('Step', () => void sculptor.step()), () => sculptor.running);
    const refine = this.needs(button('Refine', () => sculptor.refine(), { title: 'The same surface with four times the control points: it can bend more finely' }), () => sculptor.running);
    return section('Sculpt', false, h('p', { class: 'note' }, 'An elastic surface in motion: pull at it with mouse or finger, hold a place with Alt click. Lengths count in sizes of the body.'), h('div', { class: 'buttons' }, start, keep, leave, pause, step, refine), part('Tension', 'tension', 1, 500, 1), bending.element, part('Damping', 'damping', 0, 20, 0.5), part('Pressure', 'pressure', -50, 200, 5), part('Weight', 'gravity', 0, 10, 0.5), floor.element, hold.element);
  }

  /** Another material is another body. */
  private async remake(change: () => void, material: Parameters<Sculptor['start']>[0]): Promise<void> {
    change();
    if (!this.sculptor.running) return;
    await this.sculptor.end(false);
    await this.app.idle();
    await this.sculptor.start({ ...material });
  }

  private smoothSection(): HTMLElement {
    const { app } = this;
    const again = (): void => this.refresh();
    const strength = slider('Passes', { min: 1, max: 40, step: 1, value: 4 }, { input: again });
    const smooth = this.needs(button('Denoise', () => void denoise(app, strength.input.valueAsNumber)), () => this.hasFaces);
    const gains = BANDS.map((label) => slider(label, { min: 0, max: 3, step: 0.1, value: 1 }, { input: again }));
    const mixed = (): number[] => gains.map((gain) => gain.input.valueAsNumber);
    const mix = this.needs(button('Mix the bands', () => void equalize(app, mixed())), () => this.hasFaces);
    return section('Smooth and bands', false, strength.element, h('div', { class: 'buttons' }, smooth), this.command((work) => denoiseCommand(work, strength.input.valueAsNumber)), ...gains.map((gain) => gain.element), h('div', { class: 'buttons' }, mix), this.command((work) => bandsCommand(work, mixed())));
  }

  private morphSection(): HTMLElement {
    const { app, morpher } = this;
    const other = fileButton('Open the other shape', 'The shape to morph into', (name, bytes) => void morpher.open(name, bytes));
    const ball = async (): Promise<void> => {
      const url = modelUrl('creature-ball');
      if (url) await morpher.open('creature-ball.obj', new Uint8Array(await (await fetch(url)).arrayBuffer()));
    };
    const example = this.needs(button('The ball', () => void ball()), () => app.work?.source.name === 'creature.obj');
    const time = slider('Time', { min: 0, max: 1, step: 0.02, value: 0 }, { input: (value) => void morpher.preview(value), change: (value) => void morpher.keep(value) });
    this.needs(time.input, () => morpher.ready);
    const play = this.needs(button('Play', () => void morpher.play()), () => morpher.ready);
    const film = this.needs(button('Download film', () => void morpher.saveFilm(), { title: 'A GLB that viewers play' }), () => morpher.ready);
    return section('Morph', false, h('p', { class: 'note' }, 'Into a mesh of the same faces: the overall shape moves first, then the detail.'), h('div', { class: 'buttons' }, other.element, example, play, film), time.element, this.command((work) => (morpher.ready ? morphCommand(work, morpher.name, time.input.valueAsNumber) : null)));
  }

  private fitSection(): HTMLElement {
    const { app } = this;
    const vertices = slider('Vertices', { min: 50, max: 3000, step: 50, value: this.budget }, { input: (value) => { this.budget = value; this.refresh(); } });
    const plot = h('div', { class: 'plot', 'aria-label': 'Distances round by round' });
    const show = (rounds: Promise<readonly FitRound[]>): void => void rounds.then((all) => all.length > 1 && plotRounds(plot, all));
    const fit = this.needs(button('Fit', () => show(fitSurface(app, this.budget, 0))), () => app.work !== null);
    const hug = fileButton('Fit this mesh to points', 'Points or a mesh that the surface shall hug', (name, bytes) => show(fitMeshTo(app, name, bytes)));
    return section('Fit', false, h('p', { class: 'note' }, 'Draws a surface to the points; their faces, if any, do not matter.'), vertices.element, h('div', { class: 'buttons' }, fit), this.command((work) => fitCommand(work, this.budget)), h('div', { class: 'buttons' }, hug.element), plot);
  }

  private saveSection(): HTMLElement {
    const { app } = this;
    let surface = false;
    const width = h('input', { type: 'number', min: 16, max: 16384, step: 1, value: String(2 * app.stage.width) });
    const what = tick('The surface as a fine mesh, not its control mesh', false, (checked) => void (surface = checked));
    const buttons = FORMATS.map((format) => this.needs(button(`Download ${format.toUpperCase()}`, () => void download(app, format, surface ? 2 : -1)), () => this.hasFaces && !app.problem));
    const picture = this.needs(button('Download PNG', () => void downloadPicture(app, width.valueAsNumber)), () => app.work !== null);
    const link = this.needs(button('Copy a link', () => void copyLink(app)), () => this.hasFaces);
    const kept = h('p', { class: 'note' }, 'The work is kept in this browser until you press Clear. A link holds a small mesh itself; nothing is sent.');
    return section('Take it away', true, h('div', { class: 'buttons' }, ...buttons, picture, link), what.element, h('label', { class: 'row' }, h('span', {}, 'PNG, pixels wide'), width), kept);
  }

  /** Arrow keys: one step along an axis of the file. */
  nudge(direction: Vec3, share: number): void {
    void nudge(this.app, direction, share);
  }
}
