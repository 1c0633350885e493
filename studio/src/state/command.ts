/** The tool's commands that do the same to a file. */
import type { Settings, Work } from './work';
import { isCloud, isMedial, schemeNumber, wantedNormals } from './work';

function quoted(name: string): string {
  return /^[\w./-]+$/.test(name) ? name : `'${name.replaceAll("'", `'\\''`)}'`;
}

/** What differs from the tool's defaults. */
function schemeOptions(work: Work): string[] {
  const { settings } = work;
  return [
    ...(settings.scheme === 'auto' ? [] : ['--scheme', settings.scheme]),
    ...(settings.boundary === 'edge-only' ? [] : ['--boundary', settings.boundary]),
    ...(settings.alpha > 0 && schemeNumber(work) === 0 ? ['--alpha', String(settings.alpha)] : []),
  ];
}

function fairOptions(settings: Settings): string[] {
  return settings.fair ? ['--fair'] : [];
}

function command(verb: string, work: Work, output: string, ...options: string[]): string {
  return ['batten', verb, quoted(work.source.name), '-o', output, ...options].join(' ');
}

/** The medial verb has one surface: Catmull-Clark's through the spokes' ends. */
function medialCommand(work: Work): string | null {
  const { settings } = work;
  const isPlain = settings.interpolate && !settings.fair && settings.scheme === 'auto' && settings.alpha === 0 && wantedNormals(settings).length === 0;
  return isPlain ? command('medial', work, 'control.obj') : null;
}

/** tolerance: App.tolerance. Null where the tool has no such command. */
export function commandFor(work: Work, budget: number, tolerance: number): string | null {
  const { settings } = work;
  if (isCloud(work)) return fitCommand(work, budget);
  if (isMedial(work)) return medialCommand(work);
  const scheme = schemeOptions(work);
  const fine = tolerance > 0 ? ['--chord', `${Number((100 * tolerance).toPrecision(6))}%`] : ['--limit', '--levels', '2'];
  if (!settings.interpolate) return command('subdivide', work, 'surface.obj', ...fine, ...scheme);
  const normals = wantedNormals(settings).length > 0 ? ['--normals', 'normals.ply'] : [];
  return command('interpolate', work, 'control.obj', ...scheme, ...fairOptions(settings), ...normals);
}

export function fitCommand(work: Work, vertices: number): string {
  return command('fit', work, 'fit.obj', '--vertices', String(vertices));
}
export function denoiseCommand(work: Work, passes: number): string {
  return command('denoise', work, 'smooth.obj', '--passes', String(passes), ...schemeOptions(work));
}
export function bandsCommand(work: Work, gains: readonly number[]): string {
  return command('bands', work, 'mixed.obj', '--gains', gains.join(','), ...schemeOptions(work));
}
export function textureCommand(work: Work, preset: string, seed: number): string {
  return command('texture', work, 'texture.ply', '--preset', preset, '--seed', String(seed), ...schemeOptions(work));
}
export function morphCommand(work: Work, other: string, time: number): string {
  return ['batten morph', quoted(work.source.name), quoted(other), '--at', String(time), '-o', 'morph.obj', ...schemeOptions(work)].join(' ');
}
export function repairCommand(work: Work): string {
  return command('repair', work, 'repaired.obj');
}
