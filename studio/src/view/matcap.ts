/** The light on the surface: a picture of a lit ball, made here, and the colours of day and night. */
import { DataTexture, LinearFilter, RGBAFormat, SRGBColorSpace } from 'three';

const SIZE = 256;

/** Light from above left, a soft fill from the right, a faint rim: as in a photo studio. `tint`: sRGB in [0, 1]. */
export function matcap(tint: readonly [number, number, number]): DataTexture {
  const pixels = new Uint8Array(4 * SIZE * SIZE);
  for (let row = 0; row < SIZE; ++row) {
    for (let column = 0; column < SIZE; ++column) {
      const x = (2 * (column + 0.5)) / SIZE - 1;
      const y = (2 * (row + 0.5)) / SIZE - 1;
      const inside = Math.min(1, Math.hypot(x, y));
      const z = Math.sqrt(Math.max(0, 1 - inside * inside));
      const key = Math.max(0, -0.45 * x + 0.62 * y + 0.64 * z);
      const fill = Math.max(0, 0.8 * x - 0.1 * y + 0.55 * z);
      const rim = Math.pow(1 - z, 3);
      const gloss = Math.pow(Math.max(0, -0.3 * x + 0.45 * y + 0.84 * z), 40);
      const light = 0.3 + 0.6 * key + 0.14 * fill - 0.12 * rim;
      for (let channel = 0; channel < 3; ++channel) {
        const base = (tint[channel] ?? 0) * light + 0.13 * gloss;
        pixels[4 * (SIZE * row + column) + channel] = Math.round(255 * Math.min(1, Math.max(0, base)));
      }
      pixels[4 * (SIZE * row + column) + 3] = 255;
    }
  }
  const texture = new DataTexture(pixels, SIZE, SIZE, RGBAFormat);
  texture.colorSpace = SRGBColorSpace;
  texture.magFilter = LinearFilter;
  texture.minFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

/** The colours of a bar, 256 sRGB triples, for u = 0.5 ... 1; grey, for what has no number, below. */
export function barTexture(colors: Uint8Array): DataTexture {
  const count = colors.length / 3;
  const pixels = new Uint8Array(8 * count).fill(110);
  for (let i = 0; i < count; ++i) {
    for (let channel = 0; channel < 3; ++channel) pixels[4 * (count + i) + channel] = colors[3 * i + channel] ?? 0;
    pixels[4 * (count + i) + 3] = 255;
    pixels[4 * i + 3] = 255;
  }
  const texture = new DataTexture(pixels, 2 * count, 1, RGBAFormat);
  texture.colorSpace = SRGBColorSpace;
  texture.magFilter = LinearFilter;
  texture.minFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

/** Where in barTexture a position on the bar is; -1 for none. */
export function barPlace(position: number): number {
  return position < 0 ? 0.25 : 0.5 + (0.5 + 255 * position) / 512;
}
