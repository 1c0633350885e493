/** Wanted normals as arrows. */
import { ArrowHelper, Color, Group, Vector3 } from 'three';
import type { Vec3 } from '../engine/types';

export interface Arrow {
  readonly vertex: number;
  readonly at: Vec3;
  /** Of any length. */
  readonly direction: Vec3;
}

const HEAD = 0.28;
const HEAD_WIDTH = 0.14;

export class ArrowLayer {
  readonly group = new Group();
  private readonly drawn = new Map<number, { arrow: Arrow; object: ArrowHelper }>();
  private color = new Color();
  private length = 1;

  setColor(color: string): void {
    this.color = new Color(color);
    for (const { object } of this.drawn.values()) object.setColor(this.color);
  }

  /** length: of each arrow. */
  draw(arrows: readonly Arrow[], length: number): void {
    for (const { object } of this.drawn.values()) object.dispose();
    this.group.clear();
    this.drawn.clear();
    this.length = length;
    for (const arrow of arrows) this.put(arrow);
  }

  private put(arrow: Arrow): void {
    const object = new ArrowHelper(new Vector3(...arrow.direction).normalize(), new Vector3(...arrow.at), this.length, this.color, HEAD * this.length, HEAD_WIDTH * this.length);
    this.drawn.set(arrow.vertex, { arrow, object });
    this.group.add(object);
  }

  /** The arrow of a vertex with another foot or direction; nothing where it has none. */
  change(vertex: number, to: Partial<Pick<Arrow, 'at' | 'direction'>>): void {
    const one = this.drawn.get(vertex);
    if (!one) return;
    one.arrow = { ...one.arrow, ...to };
    one.object.position.set(...one.arrow.at);
    one.object.setDirection(new Vector3(...one.arrow.direction).normalize());
  }

  /** Where the arrows end. */
  tips(): { vertex: number; at: Vec3; tip: Vec3 }[] {
    return [...this.drawn.values()].map(({ arrow: { vertex, at, direction } }) => {
      const tip = new Vector3(...direction).setLength(this.length).add(new Vector3(...at));
      return { vertex, at, tip: [tip.x, tip.y, tip.z] };
    });
  }
}
