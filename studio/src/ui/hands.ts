/** Mouse and fingers on the picture. */
import type { App } from '../app';
import { edgesOf } from '../view/wireframe';
import { Picker } from '../view/pick';
import type { Sculptor } from './sculptor';
import type { Vec3 } from '../engine/types';
import { creaseEdge } from './actions';

const CLICK_PIXELS = 4;
const TAP_MS = 300;

export class Hands {
  readonly picker: Picker;
  private down: { x: number; y: number; at: number; vertex: number | null; start: Vec3 | null; moved: boolean; arrow?: Vec3 } | null = null;
  private fingers = 0;
  private twoSince = 0;

  constructor(
    private readonly app: App,
    private readonly sculptor: Sculptor,
    private readonly probe: (at: Vec3) => void,
  ) {
    this.picker = new Picker(app.stage);
    const { canvas } = app.stage;
    canvas.addEventListener('pointerdown', (event) => this.press(event), { capture: true });
    canvas.addEventListener('pointermove', (event) => this.drag(event));
    for (const end of ['pointerup', 'pointercancel'] as const) window.addEventListener(end, (event) => void this.letGo(event));
    canvas.addEventListener('dblclick', (event) => this.loop(event));
  }

  private place(event: MouseEvent): { x: number; y: number } {
    const box = this.app.stage.canvas.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  }

  private press(event: PointerEvent): void {
    if (event.pointerType === 'touch' && ++this.fingers === 2) this.twoSince = event.timeStamp;
    const { work } = this.app;
    if (event.button !== 0 || !work || this.fingers > 1) return;
    const { x, y } = this.place(event);
    if (this.sculptor.running) {
      const at = this.picker.surface(x, y);
      if (at && event.altKey) {
        this.sculptor.pin(at);
        return;
      }
      if (at) this.hold(event);
      if (at) this.sculptor.grab(at);
      this.down = { x, y, at: performance.now(), vertex: null, start: at, moved: false };
      return;
    }
    const arrow = this.picker.nearest(this.app.stage.arrows.tips(), x, y);
    if (arrow) {
      this.down = { x, y, at: performance.now(), vertex: arrow.vertex, start: arrow.tip, moved: false, arrow: arrow.at };
      this.hold(event);
      this.app.pick(arrow.vertex);
      return;
    }
    const vertex = event.altKey ? null : this.picker.vertex(work.points, x, y);
    this.down = { x, y, at: performance.now(), vertex, start: vertex === null ? null : this.app.pointAt(vertex), moved: false };
    if (vertex === null) return;
    this.hold(event);
    this.app.pick(vertex);
  }

  /** This drag is not the camera's. */
  private hold(event: PointerEvent): void {
    this.app.stage.steering = false;
    this.app.stage.canvas.setPointerCapture(event.pointerId);
  }

  private drag(event: PointerEvent): void {
    const { x, y } = this.place(event);
    const { down } = this;
    if (!down) {
      this.hover(event, x, y);
      return;
    }
    if (!down.moved && Math.hypot(x - down.x, y - down.y) < CLICK_PIXELS) return;
    down.moved = true;
    if (!down.start) return;
    const to = this.picker.onPlane(down.start, x, y);
    if (!to) return;
    if (this.sculptor.running) this.sculptor.pull(to);
    else if (down.arrow && down.vertex !== null) void this.app.turnTo(down.vertex, this.turned(down.arrow, to));
    else if (down.vertex !== null) this.app.dragTo(down.vertex, to);
  }

  private hover(event: PointerEvent, x: number, y: number): void {
    const { work } = this.app;
    if (event.buttons !== 0 || !work || work.points.length > 30_000) return;
    const over = !this.sculptor.running && this.picker.isNear(work.points, x, y);
    this.app.stage.canvas.style.setProperty('cursor', over ? 'grab' : 'default');
  }

  private async letGo(event: PointerEvent): Promise<void> {
    if (event.pointerType === 'touch') {
      this.fingers = Math.max(0, this.fingers - 1);
      if (this.twoSince > 0 && this.fingers === 0) {
        if (event.timeStamp - this.twoSince < TAP_MS) this.app.undo();
        this.twoSince = 0;
        this.down = null;
        return;
      }
    }
    const { down } = this;
    this.down = null;
    this.app.stage.steering = true;
    if (!down) return;
    if (this.sculptor.running) {
      this.sculptor.release();
      return;
    }
    if (down.arrow) {
      const to = down.moved && down.start ? this.picker.onPlane(down.start, ...this.at(event)) : null;
      if (to && down.vertex !== null) this.app.setNormal(down.vertex, this.turned(down.arrow, to));
      return;
    }
    if (down.moved) {
      await this.app.endDrag();
      return;
    }
    if (down.vertex !== null) return;
    if (event.altKey) {
      this.crease(down.x, down.y, false);
      return;
    }
    const at = this.picker.surface(down.x, down.y);
    if (at) this.probe(at);
    else this.app.pick(null);
  }

  private at(event: MouseEvent): [number, number] {
    const { x, y } = this.place(event);
    return [x, y];
  }
  private turned(from: Vec3, to: Vec3): Vec3 {
    const way = [to[0] - from[0], to[1] - from[1], to[2] - from[2]] as const;
    const length = Math.hypot(...way) || 1;
    return [way[0] / length, way[1] / length, way[2] / length];
  }

  private crease(x: number, y: number, loop: boolean): void {
    const { work } = this.app;
    if (!work) return;
    const edge = this.picker.edge(work.points, edgesOf(work), x, y);
    if (edge) creaseEdge(this.app, edge, loop);
  }

  private loop(event: MouseEvent): void {
    const { x, y } = this.place(event);
    if (event.altKey) this.crease(x, y, true);
  }
}
