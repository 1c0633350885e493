/** The spokes of a medial model: lines from where they start to the points, seen through the surface. */
import { BufferAttribute, BufferGeometry, LineBasicMaterial, LineSegments } from 'three';

export class SpokeLayer {
  readonly object = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ transparent: true, opacity: 0.55, depthTest: false, depthWrite: false }));

  constructor() {
    this.object.frustumCulled = false;
    this.object.renderOrder = 1;
  }

  setColor(color: string): void {
    this.object.material.color.set(color);
  }

  /** origins: three numbers for each point, or none. */
  draw(origins: Float64Array, points: Float64Array): void {
    this.object.geometry.dispose();
    this.object.geometry = new BufferGeometry();
    const ends = new Float32Array(2 * origins.length);
    for (let i = 0; i < origins.length; i += 3) {
      ends.set(origins.subarray(i, i + 3), 2 * i);
      ends.set(points.subarray(i, i + 3), 2 * i + 3);
    }
    this.object.geometry.setAttribute('position', new BufferAttribute(ends, 3));
  }

  move(vertex: number, to: readonly [number, number, number]): void {
    const attribute = this.object.geometry.getAttribute('position') as BufferAttribute | undefined;
    if (!attribute || 2 * vertex + 1 >= attribute.count) return;
    attribute.setXYZ(2 * vertex + 1, ...to);
    attribute.needsUpdate = true;
  }
}
