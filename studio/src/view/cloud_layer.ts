/** Other points, coloured by their number. */
import { BufferAttribute, BufferGeometry, Color, Points, PointsMaterial, SRGBColorSpace } from 'three';
import type { Field } from '../engine/types';

const PIXELS = 4;

export class CloudLayer {
  readonly object = new Points(new BufferGeometry(), new PointsMaterial({ size: PIXELS, sizeAttenuation: false, vertexColors: true }));

  constructor() {
    this.object.frustumCulled = false;
    this.object.visible = false;
  }

  draw(points: Float64Array, { positions, scale }: Field): void {
    const colors = new Float32Array(points.length);
    const color = new Color();
    positions.forEach((position, i) => {
      const at = 3 * Math.round(255 * Math.min(1, Math.max(0, position)));
      color.setRGB((scale.colors[at] ?? 0) / 255, (scale.colors[at + 1] ?? 0) / 255, (scale.colors[at + 2] ?? 0) / 255, SRGBColorSpace);
      color.toArray(colors, 3 * i);
    });
    this.object.geometry.dispose();
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(Float32Array.from(points), 3));
    geometry.setAttribute('color', new BufferAttribute(colors, 3));
    this.object.geometry = geometry;
    this.object.visible = true;
  }

  clear(): void {
    this.object.visible = false;
  }
}
