/** Numbers as people read them. */

export function grouped(count: number): string {
  return count.toLocaleString('en-US');
}

export function counted(count: number, one: string, many: string): string {
  return `${grouped(count)} ${count === 1 ? one : many}`;
}

/** Three digits; powers of ten with a superscript. */
export function short(value: number): string {
  if (!Number.isFinite(value)) return 'none';
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size >= 1e-3 && size < 1e6) return String(Number(value.toPrecision(4))).replace('-', '\u2212');
  const [digits = '', exponent = '0'] = value.toExponential(1).split('e');
  return `${digits.replace('-', '\u2212')} \u00d7 10${raised(Number(exponent))}`;
}

function raised(exponent: number): string {
  return [...String(exponent)].map((digit) => (digit === '-' ? '\u207b' : '\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079'[Number(digit)])).join('');
}

/** A power of ten. */
export function power(value: number): string {
  return `10${raised(Math.round(Math.log10(value)))}`;
}
