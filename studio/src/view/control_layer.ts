/** The control mesh as lines, creases thick and coloured by nothing but their presence. */
import { Color, Group, Vector2 } from 'three';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';
import type { Drawing } from '../engine/types';

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
  private edges: Uint32Array = new Uint32Array();
  private sharpness: Float32Array = new Float32Array();

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
    this.edges = drawing.edges;
    this.sharpness = drawing.sharpness;
    this.move(drawing.control);
  }

  move(control: Float32Array): void {
    const smooth: number[] = [];
    const creased: number[] = [];
    for (let edge = 0; edge < this.sharpness.length; ++edge) {
      const into = (this.sharpness[edge] ?? 0) > 0 ? creased : smooth;
      for (const end of [this.edges[2 * edge] ?? 0, this.edges[2 * edge + 1] ?? 0])
        into.push(control[3 * end] ?? 0, control[3 * end + 1] ?? 0, control[3 * end + 2] ?? 0);
    }
    for (const [object, ends] of [[this.plain, smooth], [this.sharp, creased]] as const) {
      object.visible = ends.length > 0;
      if (!object.visible) continue;
      object.geometry.dispose();
      object.geometry = new LineSegmentsGeometry().setPositions(ends);
    }
  }

  clear(): void {
    this.plain.visible = false;
    this.sharp.visible = false;
  }
}
