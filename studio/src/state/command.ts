/** The tool's command that does the same to a file. */
import type { Settings, Work } from './work';
import { isCloud } from './work';

function quoted(name: string): string {
  return /^[\w./-]+$/.test(name) ? name : `'${name.replaceAll("'", `'\\''`)}'`;
}

function schemeOptions(settings: Settings): string[] {
  return [
    ...(settings.scheme === 'auto' ? [] : ['--scheme', settings.scheme]),
    ...(settings.boundary === 'edge-only' ? [] : ['--boundary', settings.boundary]),
  ];
}

export function commandFor(work: Work, budget: number): string {
  const { settings, source } = work;
  const input = quoted(source.name);
  if (isCloud(work)) return `batten fit ${input} -o fit.obj --vertices ${budget}`;
  const rest = schemeOptions(settings);
  if (!settings.interpolate) return ['batten subdivide', input, '-o surface.obj --limit --levels 2', ...rest].join(' ');
  const fair = settings.fair ? ['--fair', ...(settings.smoothing > 0 ? ['--smoothing', String(settings.smoothing)] : [])] : [];
  return ['batten interpolate', input, '-o control.obj', ...rest, ...fair].join(' ');
}
