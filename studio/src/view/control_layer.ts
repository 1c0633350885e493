/** The control mesh as lines, creases thick and coloured by nothing but their presence. */
import { Color, Group, type InterleavedBufferAttribute, Vector2 } from 'three';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';
import type { Drawing } from '../engine/types';
import { putRows } from './rows';

/** Of more, only creases are drawn: lines would hide the surface. */
const MOST_EDGES = 40_000;

function lines(width: number): LineSegments2 {
  const object = new LineSegments2(new LineSegmentsGeometry(), new LineMaterial({ linewidth: width, transparent: true, depthWrite: false }));
  object.frustumCulled = false;
  object.visible = false;
  return object;
}

export class ControlLayer {
  readonly group = new Group();
  private readonly plain = lines(1.2);
  private readonly sharp = lines(3.2);
  private drawn: readonly { object: LineSegments2; ends: Uint32Array; places: Float32Array }[] = [];

  private control = new Float32Array();

  constructor() {
    this.plain.material.opacity = 0.45;
    this.group.add(this.plain, this.sharp);
  }

  colors(line: string, crease: string): void {
    this.plain.material.color = new Color(line);
    this.sharp.material.color = new Color(crease);
  }
  resize(width: number, height: number): void {
    for (const one of [this.plain, this.sharp]) one.material.resolution = new Vector2(width, height);
  }

  draw(drawing: Pick<Drawing, 'control' | 'edges' | 'sharpness'>): void {
    const smooth: number[] = [];
    const creased: number[] = [];
    const { edges, sharpness } = drawing;
    const all = sharpness.length <= MOST_EDGES;
    for (let edge = 0; edge < sharpness.length; ++edge) {
      const isSharp = (sharpness[edge] ?? 0) > 0;
      if (isSharp || all) (isSharp ? creased : smooth).push(edges[2 * edge] ?? 0, edges[2 * edge + 1] ?? 0);
    }
    this.drawn = [
      { object: this.plain, ends: Uint32Array.from(smooth), places: new Float32Array(3 * smooth.length) },
      { object: this.sharp, ends: Uint32Array.from(creased), places: new Float32Array(3 * creased.length) },
    ];
    for (const { object, ends, places } of this.drawn) {
      object.visible = ends.length > 0;
      object.geometry.dispose();
      object.geometry = new LineSegmentsGeometry();
      if (object.visible) object.geometry.setPositions(places);
    }
    this.move(drawing.control);
  }

  /** The same edges between other control points: those of `moved`, or all. */
  move(control: Float32Array, moved?: Int32Array): void {
    if (moved) putRows(this.control, control, moved);
    else this.control = control.slice();
    for (const { object, ends, places } of this.drawn) {
      if (ends.length === 0) continue;
      ends.forEach((end, i) => places.set(this.control.subarray(3 * end, 3 * end + 3), 3 * i));
      const start = object.geometry.getAttribute('instanceStart') as InterleavedBufferAttribute;
      start.data.array.set(places);
      start.data.needsUpdate = true;
    }
  }

  clear(): void {
    this.plain.visible = false;
    this.sharp.visible = false;
  }
}
