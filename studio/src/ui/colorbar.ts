/** The bar beside a surface whose colours are numbers: title, unit, ticks, the range of the numbers themselves. */
import type { Scale } from '../engine/types';
import { h } from './dom';

const HEIGHT = 256;

export function drawColorBar(place: HTMLElement, scale: Scale): void {
  const canvas = h('canvas', { width: 1, height: HEIGHT, 'aria-hidden': 'true' });
  const context = canvas.getContext('2d');
  if (context) {
    const image = context.createImageData(1, HEIGHT);
    for (let row = 0; row < HEIGHT; ++row) {
      const color = HEIGHT - 1 - row;
      for (let channel = 0; channel < 3; ++channel) image.data[4 * row + channel] = scale.colors[3 * color + channel] ?? 0;
      image.data[4 * row + 3] = 255;
    }
    context.putImageData(image, 0, 0);
  }
  const ticks = scale.ticks.map((tick) => {
    const label = h('span', {}, tick.text);
    label.style.setProperty('bottom', `${100 * tick.place}%`);
    return label;
  });
  const range = scale.low < scale.high ? `${scale.lowestText} to ${scale.highestText}` : `${scale.lowestText} everywhere`;
  place.replaceChildren(
    h('strong', {}, scale.title),
    h('small', {}, scale.unit),
    h('div', { class: 'colorbar-scale' }, canvas, h('div', { class: 'colorbar-ticks' }, ...ticks)),
    h('small', {}, range),
  );
  place.hidden = false;
}
