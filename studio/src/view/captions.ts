/** Words below the surfaces that stand side by side. They follow the camera. */
import * as THREE from 'three';

/** Below the middle of a surface, in radii of the sphere around it. */
const BELOW = 0.8;

export class Captions {
  private readonly labels = [document.createElement('span'), document.createElement('span')] as const;
  private readonly element = document.createElement('div');
  private readonly places = [new THREE.Vector3(), new THREE.Vector3()] as const;

  constructor(parent: HTMLElement) {
    this.element.className = 'captions';
    this.element.ariaHidden = 'true'; // what stands beside is told as a status
    this.element.append(...this.labels);
    parent.append(this.element);
    this.write(null);
  }

  write(words: readonly [string, string] | null): void {
    this.element.hidden = words === null;
    this.labels.forEach((label, i) => void (label.textContent = words?.[i as 0 | 1] ?? ''));
  }

  /** sphere: around the first surface; the other one stands `across` from it. */
  stand(sphere: THREE.Sphere, up: THREE.Vector3, across: THREE.Vector3): void {
    this.places[0].copy(sphere.center).addScaledVector(up, -BELOW * sphere.radius);
    this.places[1].copy(this.places[0]).add(across);
  }

  follow(camera: THREE.Camera): void {
    if (this.element.hidden) return;
    this.labels.forEach((label, i) => {
      const { x, y } = this.places[i as 0 | 1].clone().project(camera);
      label.style.setProperty('left', `${50 + 50 * x}%`);
      label.style.setProperty('top', `${50 - 50 * y}%`);
    });
  }
}
