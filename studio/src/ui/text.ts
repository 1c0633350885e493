/** Numbers as people read them. */
import type { Work } from '../state/work';
import { faceCount, isMedial, vertexCount } from '../state/work';

export function grouped(count: number): string {
  return count.toLocaleString('en-US');
}

export function counted(count: number, one: string, many: string): string {
  return `${grouped(count)} ${count === 1 ? one : many}`;
}

export function sizeOf(work: Work): string {
  return `${counted(vertexCount(work), 'vertex', 'vertices')}, ${counted(faceCount(work), 'face', 'faces')}`;
}

const AXES = ['', 'x', 'y', 'z', '\u2212x', '\u2212y', '\u2212z'];

/** How large a mesh is, in which unit, and which way is up. */
export function extentOf(work: Work): string {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  work.points.forEach((number, i) => {
    low[i % 3] = Math.min(low[i % 3] ?? 0, number);
    high[i % 3] = Math.max(high[i % 3] ?? 0, number);
  });
  const unit = isMedial(work) ? 'mm (LPS)' : 'in the file\u2019s unit';
  return `${low.map((number, i) => short((high[i] ?? 0) - number)).join(' \u00d7 ')} ${unit}, ${AXES[work.up] ?? ''} is up`;
}

/** Four digits, or two and a power of ten; as the tool writes numbers, so that they can be copied and read aloud. */
export function short(value: number): string {
  if (!Number.isFinite(value)) return 'none';
  const size = Math.abs(value);
  if (value === 0 || (size >= 1e-3 && size < 1e6)) return String(Number(value.toPrecision(4)));
  return value.toExponential(1);
}

function raised(exponent: number): string {
  return [...String(exponent)].map((digit) => (digit === '-' ? '\u207b' : '\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079'[Number(digit)])).join('');
}

/** A power of ten. */
export function power(value: number): string {
  return `10${raised(Math.round(Math.log10(value)))}`;
}
