/** What is under the pointer. */
import * as THREE from 'three';
import type { Vec3 } from '../engine/types';
import type { Stage } from './stage';

const NEAR_PIXELS = 12;

interface Screen {
  x: number;
  y: number;
  depth: number;
  /** From the eye, in the mesh's unit. */
  distance: number;
}

export class Picker {
  private readonly raycaster = new THREE.Raycaster();
  private readonly at = new THREE.Vector3();

  constructor(private readonly stage: Stage) {}

  private project(x: number, y: number, z: number): Screen {
    const { clientWidth, clientHeight } = this.stage.canvas;
    const distance = -this.at.set(x, y, z).applyMatrix4(this.stage.camera.matrixWorldInverse).z;
    this.at.set(x, y, z).project(this.stage.camera);
    return { distance, x: ((this.at.x + 1) / 2) * clientWidth, y: ((1 - this.at.y) / 2) * clientHeight, depth: this.at.z };
  }

  private ray(x: number, y: number): THREE.Raycaster {
    const { clientWidth, clientHeight } = this.stage.canvas;
    this.raycaster.setFromCamera(new THREE.Vector2((2 * x) / clientWidth - 1, 1 - (2 * y) / clientHeight), this.stage.camera);
    return this.raycaster;
  }

  /** The point of the surface under a pixel of the canvas. */
  surface(x: number, y: number): Vec3 | null {
    if (!this.stage.surface.mesh.visible) return null;
    const hit = this.ray(x, y).intersectObject(this.stage.surface.mesh, false)[0];
    return hit ? [hit.point.x, hit.point.y, hit.point.z] : null;
  }

  /** True where the surface hides a point: something is clearly nearer to the eye. */
  private hidden(screen: Screen): boolean {
    const there = this.surface(screen.x, screen.y);
    return there !== null && this.project(...there).distance < screen.distance - this.stage.slack;
  }

  private near(points: Float64Array, x: number, y: number): { vertex: number; away: number; screen: Screen }[] {
    const near: { vertex: number; away: number; screen: Screen }[] = [];
    for (let vertex = 0; 3 * vertex < points.length; ++vertex) {
      const screen = this.project(points[3 * vertex] ?? 0, points[3 * vertex + 1] ?? 0, points[3 * vertex + 2] ?? 0);
      const away = Math.hypot(screen.x - x, screen.y - y);
      if (away < NEAR_PIXELS && Math.abs(screen.depth) <= 1) near.push({ vertex, away, screen });
    }
    return near.sort((a, b) => a.away - b.away);
  }

  /** Of things with a tip the one whose tip is nearest to a pixel, if it is near. */
  nearest<Tipped extends { readonly tip: Vec3 }>(things: readonly Tipped[], x: number, y: number): Tipped | null {
    const away = ({ tip }: Tipped): number => {
      const screen = this.project(...tip);
      return Math.hypot(screen.x - x, screen.y - y);
    };
    return things.filter((one) => away(one) < NEAR_PIXELS).sort((a, b) => away(a) - away(b))[0] ?? null;
  }

  /** True where a point, be it hidden, is near a pixel: quick enough for each move of the pointer. */
  isNear(points: Float64Array, x: number, y: number): boolean {
    return this.near(points, x, y).length > 0;
  }

  /** The vertex whose point is near a pixel and not hidden. */
  vertex(points: Float64Array, x: number, y: number): number | null {
    return this.near(points, x, y).slice(0, 4).find((one) => !this.hidden(one.screen))?.vertex ?? null;
  }

  /** The pair of vertices whose edge passes near a pixel, in front first. */
  edge(points: Float64Array, edges: Iterable<readonly [number, number]>, x: number, y: number): readonly [number, number] | null {
    let best: { edge: readonly [number, number]; depth: number } | null = null;
    for (const edge of edges) {
      const [a, b] = edge.map((end) => this.project(points[3 * end] ?? 0, points[3 * end + 1] ?? 0, points[3 * end + 2] ?? 0));
      if (!a || !b) continue;
      const length = (b.x - a.x) ** 2 + (b.y - a.y) ** 2;
      const t = length > 0 ? Math.min(1, Math.max(0, ((x - a.x) * (b.x - a.x) + (y - a.y) * (b.y - a.y)) / length)) : 0;
      const away = Math.hypot(a.x + t * (b.x - a.x) - x, a.y + t * (b.y - a.y) - y);
      const depth = a.depth + t * (b.depth - a.depth);
      if (away < NEAR_PIXELS && (!best || depth < best.depth)) best = { edge, depth };
    }
    return best?.edge ?? null;
  }

  /** Where a pixel's ray meets the plane through `through` that faces the eye. */
  onPlane(through: Vec3, x: number, y: number): Vec3 | null {
    const { ray } = this.ray(x, y);
    const normal = this.stage.camera.getWorldDirection(new THREE.Vector3());
    const plane = new THREE.Plane().setFromNormalAndCoplanarPoint(normal, new THREE.Vector3(...through));
    const hit = ray.intersectPlane(plane, new THREE.Vector3());
    return hit ? [hit.x, hit.y, hit.z] : null;
  }

  /** Where a point is on the canvas: for tests and labels. */
  screen(point: Vec3): { x: number; y: number } {
    return this.project(...point);
  }
}
