/** The light on the surface: a picture of a lit ball, made here, and the colours of day and night. */
import { DataTexture, LinearFilter, RGBAFormat, SRGBColorSpace } from 'three';

const SIZE = 256;

/** How a ball is lit: light from above left, a soft fill from the right, a gloss. */
export interface Light {
  /** sRGB in [0, 1]. */
  readonly tint: readonly [number, number, number];
  readonly shade: number;
  readonly key: number;
  readonly fill: number;
  readonly gloss: number;
}
export const PORCELAIN: Light = { tint: [0.93, 0.925, 0.91], shade: 0.47, key: 0.47, fill: 0.15, gloss: 0.09 };
/** For colours of a material. */
export const SATIN: Light = { tint: [1, 1, 1], shade: 0.6, key: 0.4, fill: 0.12, gloss: 0.1 };
/** Nearly even, since colours are to be found on the bar. */
export const EVEN: Light = { tint: [1, 1, 1], shade: 0.78, key: 0.22, fill: 0.06, gloss: 0.02 };

export function matcap(lit: Light): DataTexture {
  const pixels = new Uint8Array(4 * SIZE * SIZE);
  for (let row = 0; row < SIZE; ++row) {
    for (let column = 0; column < SIZE; ++column) {
      const x = (2 * (column + 0.5)) / SIZE - 1;
      const y = (2 * (row + 0.5)) / SIZE - 1;
      const inside = Math.min(1, Math.hypot(x, y));
      const z = Math.sqrt(Math.max(0, 1 - inside * inside));
      const key = Math.max(0, 0.5 + 0.5 * (-0.45 * x + 0.62 * y + 0.64 * z));
      const fill = Math.max(0, 0.8 * x - 0.1 * y + 0.55 * z);
      const edge = Math.pow(1 - z, 3);
      const gloss = Math.pow(Math.max(0, -0.3 * x + 0.45 * y + 0.84 * z), 40);
      const light = lit.shade + lit.key * key * key + lit.fill * (fill - edge);
      for (let channel = 0; channel < 3; ++channel) {
        // Shadows are a little cool, as by the light of a sky.
        const cool = 1 + 0.06 * (1 - key) * (channel - 1);
        const base = (lit.tint[channel] ?? 0) * light * cool + lit.gloss * gloss;
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
