/** The shadow as a square on the ground, which is not there from below. */
import { DataTexture, LinearFilter, Matrix4, Mesh, MeshBasicMaterial, PlaneGeometry, Vector3 } from 'three';
import type { Vec3 } from '../engine/types';
import { SHADOW_SIDE, shadowOf } from './shadow';

export class ShadowLayer {
  readonly object: Mesh<PlaneGeometry, MeshBasicMaterial>;
  private readonly texture = new DataTexture(new Uint8Array(4 * SHADOW_SIDE * SHADOW_SIDE), SHADOW_SIDE, SHADOW_SIDE);

  constructor() {
    this.texture.magFilter = LinearFilter;
    this.object = new Mesh(new PlaneGeometry(1, 1), new MeshBasicMaterial({ map: this.texture, transparent: true, depthWrite: false }));
    this.object.renderOrder = -1;
    this.object.matrixAutoUpdate = false;
    this.object.visible = false;
  }

  cast(points: ArrayLike<number>, triangles: ArrayLike<number>, up: Vec3, aside: Vector3): void {
    const shadow = shadowOf(points, triangles, up);
    this.object.visible = shadow !== null;
    if (!shadow) return;
    const pixels = this.texture.image.data as Uint8Array;
    shadow.darkness.forEach((dark, i) => void (pixels[4 * i + 3] = Math.round(255 * dark)));
    this.texture.needsUpdate = true;
    const { side, center } = shadow;
    this.object.matrix
      .makeBasis(new Vector3(...shadow.across).multiplyScalar(side), new Vector3(...shadow.along).multiplyScalar(side), new Vector3(...up))
      .premultiply(new Matrix4().makeTranslation(new Vector3(...center).add(aside)));
    this.object.matrixWorldNeedsUpdate = true;
  }

  clear(): void {
    this.object.visible = false;
  }
}
