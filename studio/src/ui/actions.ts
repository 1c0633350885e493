/** What buttons, keys and hands do: each is one step of the history. */
import type { App } from '../app';
import type { Contents, FitRound, Vec3 } from '../engine/types';
import { edgeLoop, sharpnessOf, withCreases } from '../state/creases';
import { linkOf } from '../state/link';
import type { Source, Work } from '../state/work';
import { isCloud, PLAIN, vertexCount, wantedNormals, wishesOf, workOf } from '../state/work';
import { short, sizeOf } from './text';

/** The sharpness that new creases get; the panel's slider sets it. */
export const creaseSharpness = { value: 10 };

export async function openFile(app: App, file: File): Promise<void> {
  await app.open({ name: file.name, bytes: new Uint8Array(await file.arrayBuffer()) });
}

export async function openUrl(app: App, name: string, url: string): Promise<void> {
  const answer = await fetch(url);
  await app.open({ name, bytes: new Uint8Array(await answer.arrayBuffer()) });
}

export function toggleInterpolation(app: App): void {
  const { work } = app;
  if (!work || isCloud(work)) return;
  const interpolate = !work.settings.interpolate;
  app.set(interpolate ? 'interpolate' : 'show the control mesh\u2019s surface', { interpolate });
}

function renamed(name: string, word: string, extension: string): string {
  return `${name.replace(/\.[^.]*$/, '')}-${word}.${extension}`;
}

/** A new mesh that the engine has made becomes the work. */
export async function takeMesh(app: App, label: string, word: string, contents: Contents): Promise<void> {
  const { work } = app;
  if (!work) return;
  const bytes = await app.engine.run((engine) => engine.writeMesh());
  const source: Source = { name: renamed(work.source.name, word, 'obj'), bytes };
  const settings = { ...PLAIN, scheme: work.settings.scheme, boundary: work.settings.boundary };
  app.store.run(label, { kind: 'work', work: workOf(source, contents, settings) });
}

export async function repairMesh(app: App): Promise<void> {
  const { work } = app;
  if (!work) return;
  let told = '';
  await app.inOrder(async () => {
    const { changes, contents } = await app.withEngine<{ changes: string[]; contents: Contents }>((engine) => engine.repair(0), work);
    told = changes.length > 0 ? `Repaired: ${changes.join(' ')}` : 'There is nothing to repair.';
    if (changes.length > 0) await takeMesh(app, 'repair', 'repaired', contents);
    if (app.work) told += ` ${sizeOf(app.work)}.`;
  });
  await app.idle();
  if (told) app.face.say(told);
}

interface Fitted {
  contents: Contents;
  rms: number;
  max: number;
  rounds: FitRound[];
}

async function fitAndTake(app: App, label: string, fit: (work: Work) => Promise<Fitted>): Promise<readonly FitRound[]> {
  const { work } = app;
  if (!work) return [];
  let told = '';
  let rounds: readonly FitRound[] = [];
  await app.inOrder(async () => {
    app.stage.wear('plain');
    app.face.showScale(null);
    try {
      const fitted = await fit(work);
      told = `Fitted with ${fitted.contents.points.length / 3} vertices: rms distance ${short(fitted.rms)}, max ${short(fitted.max)}.`;
      rounds = fitted.rounds;
      await takeMesh(app, label, 'fit', fitted.contents);
    } catch (error) {
      app.redraw(); // what was shown of the rounds goes
      throw error;
    }
  });
  await app.idle();
  if (told) app.face.say(told);
  return rounds;
}

/** A surface to the points of the work; the picture shows it grow. */
export async function fitSurface(app: App, vertices: number, tolerance: number): Promise<readonly FitRound[]> {
  return fitAndTake(app, 'fit a surface', (work) => app.withEngine<Fitted>((engine) => engine.fit(vertices, tolerance), work));
}

/** The mesh becomes a control mesh whose surface hugs another file's points; its faces stay. */
export async function fitMeshTo(app: App, name: string, bytes: Uint8Array): Promise<readonly FitRound[]> {
  return fitAndTake(app, `fit to ${name}`, (work) => app.withEngine<Fitted>((engine) => engine.fitTo(name, bytes, 0), work));
}

/** Moves all points to what `compute` gives. */
export async function movePoints(app: App, label: string, compute: (work: NonNullable<App['work']>) => Promise<Float64Array>): Promise<void> {
  const { work } = app;
  if (!work) return;
  await app.inOrder(async () => {
    const points = await compute(work);
    app.store.run(label, { kind: 'all-points', points });
  });
}

export async function denoise(app: App, passes: number): Promise<void> {
  await movePoints(app, `denoise, ${passes} passes`, async (work) => (await app.withEngine<{ points: Float64Array }>((engine) => engine.denoise(wishesOf(work), 2, passes), work)).points);
}

export async function equalize(app: App, gains: readonly number[]): Promise<void> {
  await movePoints(app, `bands ${gains.join(', ')}`, async (work) => (await app.withEngine<{ points: Float64Array }>((engine) => engine.bands(wishesOf(work), gains), work)).points);
}

export function creaseEdge(app: App, edge: readonly [number, number], loop: boolean): void {
  const { work } = app;
  if (!work) return;
  const edges = loop ? edgeLoop(work, edge[0], edge[1]) : [edge];
  // A double click comes after two clicks, which have undone each other.
  const sharpness = sharpnessOf(work.creases, edge[0], edge[1]) > 0 && !loop ? 0 : creaseSharpness.value;
  const creases = withCreases(work.creases, edges, sharpness);
  app.store.run(sharpness > 0 ? 'crease' : 'smooth edge', { kind: 'tags', creases, corners: work.corners });
}

/** The whole boundary rule aside: a corner keeps its point sharp. */
export function toggleCorner(app: App): void {
  const { work, picked } = app;
  if (!work || picked === null) return;
  const there = work.corners.some((corner) => corner.vertex === picked);
  const others = work.corners.filter((corner) => corner.vertex !== picked);
  const corners = there ? others : [...others, { vertex: picked, sharpness: creaseSharpness.value }];
  app.store.run(there ? 'smooth corner' : 'corner', { kind: 'tags', creases: work.creases, corners });
}

/** The picked point keeps the surface's normal of now, until it is turned; or any again. */
export function toggleNormal(app: App): void {
  const { work, picked, drawing } = app;
  if (!work || picked === null || !drawing) return;
  const there = wantedNormals(work.settings).some((one) => one.vertex === picked);
  const [x = 0, y = 0, z = 0] = drawing.normals.subarray(3 * picked, 3 * picked + 3);
  app.setNormal(picked, there ? null : [x, y, z]);
}

/** For the tool's --normals. */
export async function downloadNormals(app: App): Promise<void> {
  const { work } = app;
  if (!work) return;
  await app.inOrder(async () => {
    const bytes = await app.withEngine<Uint8Array<ArrayBuffer>>((engine) => engine.writeNormals(wishesOf(work).normals), work);
    save('normals.ply', new Blob([bytes]));
    app.face.say('Saved normals.ply, which the command takes.');
  });
}

export function pickNext(app: App, by: number): void {
  const { work } = app;
  if (!work) return;
  const count = vertexCount(work);
  app.pick(count === 0 ? null : ((app.picked ?? (by > 0 ? -1 : 0)) + by + count) % count);
}

export async function nudge(app: App, direction: Vec3, share: number): Promise<void> {
  const { work, picked } = app;
  const from = picked === null ? null : app.pointAt(picked);
  if (!work || picked === null || !from) return;
  const step = share * work.diagonal;
  await app.movePoint(picked, [from[0] + step * direction[0], from[1] + step * direction[1], from[2] + step * direction[2]]);
}

/** Hands a file to the person. */
export function save(name: string, blob: Blob): void {
  const url = URL.createObjectURL(blob);
  const link = document.createElement('a');
  link.href = url;
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

/** levels below 0: the control mesh, which keeps creases; otherwise the surface as a fine mesh, or as fine as the tolerance asks. */
export async function download(app: App, format: string, levels: number): Promise<void> {
  const { work } = app;
  if (!work) return;
  await app.inOrder(async () => {
    const { bytes, losses } = await app.withEngine<{ bytes: Uint8Array<ArrayBuffer>; losses: string[] }>((engine) => engine.write(format, levels, levels >= 0 ? app.tolerance * work.diagonal : 0), work);
    const name = renamed(work.source.name, levels >= 0 ? 'surface' : 'control', format);
    save(name, new Blob([bytes]));
    app.face.say(`Saved ${name}${losses.length > 0 ? `, without ${losses.join(', ')}` : ''}.`);
  });
}

/** width: in pixels. */
export async function downloadPicture(app: App, width: number): Promise<void> {
  const { work } = app;
  if (!work) return;
  await app.inOrder(async () => {
    const { blob, size } = await app.stage.png(width);
    const name = renamed(work.source.name, 'picture', 'png');
    save(name, blob);
    app.face.say(`Saved ${name}, ${size.width} \u00d7 ${size.height} pixels.`);
  });
}

/** The address of this work: its mesh, with what was moved and tagged, and its settings. */
export async function copyLink(app: App): Promise<void> {
  const { work } = app;
  if (!work) return;
  await app.inOrder(async () => {
    const bytes = await app.withEngine<Uint8Array<ArrayBuffer>>((engine) => engine.writeMesh(), work);
    const link = new URL(await linkOf(work.source.name, work.settings, new TextDecoder().decode(bytes)), location.href).href;
    history.replaceState(null, '', link);
    await navigator.clipboard?.writeText(link).catch(() => undefined);
    app.face.say('The address of this page now holds the work; it is copied.');
  });
}
