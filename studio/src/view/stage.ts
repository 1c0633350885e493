/** The picture: camera, layers, light and dark. Draws when something has changed, and not otherwise. */
import CameraControls from 'camera-controls';
import * as THREE from 'three';
import type { Change, Drawing, Field, Vec3 } from '../engine/types';
import { ArrowLayer } from './arrow_layer';
import { Captions } from './captions';
import { CloudLayer } from './cloud_layer';
import { ControlLayer } from './control_layer';
import { PointsLayer } from './points_layer';
import { ShadowLayer } from './shadow_layer';
import { SpokeLayer } from './spoke_layer';
import { SurfaceLayer } from './surface_layer';

CameraControls.install({ THREE });

export type Look = 'plain' | 'zebra' | Field | Float32Array;
export type View = 'front' | 'right' | 'top' | 'home';

const UPS: readonly Vec3[] = [[0, 0, 1], [1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0], [0, 0, -1]];
const PALETTES = {
  light: { line: '#33475b', crease: '#d9480f', point: '#1971c2', picked: '#f08c00', rim: '#ffffff' },
  dark: { line: '#6f879f', crease: '#ff922b', point: '#4dabf7', picked: '#ffd43b', rim: '#12161b' },
} as const;
const POINT_PIXELS = 9;
const MANY_POINTS = 5000;
/** Half as much again would be too far away; words stand at the foot. */
const ROOM = 1.24;
const FOOT = 0.13;
const FEW_POINTS = 30;
const BESIDE = 2;
/** Between two shadows of a surface that moves, milliseconds; and how many times as long as one takes. */
const SHADOW_PAUSE = 60;
const SHADOW_SHARE = 10;
/** About the size of a point's disc. */
const SLACK = 0.02;

export class Stage {
  readonly canvas: HTMLCanvasElement;
  readonly surface = new SurfaceLayer();
  readonly control = new ControlLayer();
  readonly points = new PointsLayer();
  readonly cloud = new CloudLayer();
  readonly arrows = new ArrowLayer();
  readonly spokes = new SpokeLayer();
  readonly shadows = new THREE.Group();
  /** A second surface, to the right of the first. */
  private readonly second = new SurfaceLayer();
  private readonly captions: Captions;
  private readonly shadow = new ShadowLayer();
  private readonly secondShadow = new ShadowLayer();
  private waiting = 0;
  private pause = SHADOW_PAUSE;
  private readonly renderer: THREE.WebGLRenderer;
  private readonly scene = new THREE.Scene();
  private readonly perspective = new THREE.PerspectiveCamera(32, 1, 0.01, 100);
  private readonly orthographic = new THREE.OrthographicCamera(-1, 1, 1, -1, -100, 100);
  private controls: CameraControls;
  private readonly clock = new THREE.Timer();
  private dirty = true;
  private up: Vec3 = [0, 0, 1];
  private sphere = new THREE.Sphere(new THREE.Vector3(), 1);
  private framed: Float64Array = new Float64Array();
  private flat = false;

  constructor(canvas: HTMLCanvasElement) {
    this.canvas = canvas;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    this.scene.add(this.surface.mesh, this.control.group, this.points.object, this.cloud.object, this.arrows.group, this.spokes.object, this.second.mesh, this.shadows);
    this.shadows.add(this.shadow.object, this.secondShadow.object);
    this.second.clear();
    this.captions = new Captions(canvas.parentElement ?? document.body);
    this.controls = this.steer(this.perspective);
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement ?? canvas);
    this.resize();
    const frame = (): void => {
      requestAnimationFrame(frame);
      this.clock.update();
      const moved = this.controls.update(this.clock.getDelta());
      if (!moved && !this.dirty) return;
      this.dirty = false;
      this.renderer.render(this.scene, this.camera);
      this.captions.follow(this.camera);
    };
    frame();
  }

  private steer(camera: THREE.PerspectiveCamera | THREE.OrthographicCamera): CameraControls {
    const controls = new CameraControls(camera, this.canvas);
    controls.smoothTime = 0.08;
    controls.draggingSmoothTime = 0.03;
    controls.dollyToCursor = true;
    controls.mouseButtons.right = CameraControls.ACTION.TRUCK;
    controls.mouseButtons.wheel = camera instanceof THREE.PerspectiveCamera ? CameraControls.ACTION.DOLLY : CameraControls.ACTION.ZOOM;
    controls.touches.two = camera instanceof THREE.PerspectiveCamera ? CameraControls.ACTION.TOUCH_DOLLY_TRUCK : CameraControls.ACTION.TOUCH_ZOOM_TRUCK;
    return controls;
  }

  get camera(): THREE.PerspectiveCamera | THREE.OrthographicCamera {
    return this.flat ? this.orthographic : this.perspective;
  }
  set steering(enabled: boolean) {
    this.controls.enabled = enabled;
  }

  /** A length that counts as nothing. */
  get slack(): number {
    return SLACK * this.sphere.radius;
  }

  touch(): void {
    this.dirty = true;
  }

  /** At once, or soon where the surface moves on and on. */
  private castShadows(): void {
    window.clearTimeout(this.waiting);
    this.waiting = 0;
    const begin = performance.now();
    for (const [layer, shadow] of [[this.surface, this.shadow], [this.second, this.secondShadow]] as const) {
      const { geometry, position, visible } = layer.mesh;
      const points = geometry.getAttribute('position') as THREE.BufferAttribute | undefined;
      if (visible && points && geometry.index) shadow.cast(points.array, geometry.index.array, this.up, position);
      else shadow.clear();
    }
    this.pause = Math.max(SHADOW_PAUSE, SHADOW_SHARE * (performance.now() - begin));
    this.touch();
  }
  private castShadowsSoon(): void {
    if (this.waiting === 0) this.waiting = window.setTimeout(() => this.castShadows(), this.pause);
  }

  private resize(): void {
    const frame = this.canvas.parentElement ?? this.canvas;
    const width = Math.max(1, frame.clientWidth);
    const height = Math.max(1, frame.clientHeight);
    this.renderer.setSize(width, height, false);
    this.control.resize(width, height);
    this.perspective.aspect = width / height;
    this.perspective.updateProjectionMatrix();
    const half = this.sphere.radius * ROOM;
    this.orthographic.top = half;
    this.orthographic.bottom = -half;
    this.orthographic.left = (-half * width) / height;
    this.orthographic.right = (half * width) / height;
    this.orthographic.updateProjectionMatrix();
    this.touch();
  }

  theme(dark: boolean): void {
    const palette = dark ? PALETTES.dark : PALETTES.light;
    this.control.colors(palette.line, palette.crease);
    this.points.colors(palette.point, palette.picked, palette.rim);
    this.arrows.setColor(palette.picked);
    this.spokes.setColor(palette.crease);
    this.touch();
  }

  /** Looks at what is within this box. up: UpAxis. */
  frame(points: Float64Array, up: number): void {
    this.up = UPS[up] ?? [0, 0, 1];
    this.framed = points;
    const box = new THREE.Box3();
    const at = new THREE.Vector3();
    for (let i = 0; i + 2 < points.length; i += 3) box.expandByPoint(at.set(points[i] ?? 0, points[i + 1] ?? 0, points[i + 2] ?? 0));
    box.getCenter(this.sphere.center);
    let farthest = 0;
    for (let i = 0; i + 2 < points.length; i += 3)
      farthest = Math.max(farthest, at.set(points[i] ?? 0, points[i + 1] ?? 0, points[i + 2] ?? 0).distanceToSquared(this.sphere.center));
    this.sphere.radius = Math.sqrt(farthest);
    if (!(this.sphere.radius > 0)) this.sphere.radius = 1;
    this.points.lift = this.slack;
    for (const camera of [this.perspective, this.orthographic]) camera.up.set(...this.up);
    this.perspective.near = this.sphere.radius / 100;
    this.perspective.far = this.sphere.radius * 100;
    this.orthographic.near = -this.sphere.radius * 100;
    this.orthographic.far = this.sphere.radius * 100;
    this.controls.updateCameraUp();
    this.resize();
    this.castShadows();
    this.look('home', false);
  }

  /** The direction from the middle to the eye. */
  private away(view: View): THREE.Vector3 {
    const up = new THREE.Vector3(...this.up);
    const front = Math.abs(up.y) > 0.5 ? new THREE.Vector3(0, 0, 1) : new THREE.Vector3(0, -1, 0);
    const right = new THREE.Vector3().crossVectors(up, front).normalize();
    const directions: Record<View, THREE.Vector3> = {
      front,
      right,
      top: up.clone().addScaledVector(front, 1e-3),
      home: front.clone().addScaledVector(right, 0.75).addScaledVector(up, 0.55),
    };
    return directions[view].normalize();
  }

  look(view: View, smoothly = true): void {
    const up = new THREE.Vector3(...this.up);
    const away = this.away(view);
    const { target, half } = this.extent(away, up);
    const distance = half / Math.tan(THREE.MathUtils.degToRad(this.perspective.fov / 2)) + this.sphere.radius / 2;
    const eye = away.multiplyScalar(distance).add(target);
    void this.controls.setLookAt(eye.x, eye.y, eye.z, target.x, target.y, target.z, smoothly);
    if (this.flat) void this.controls.zoomTo((ROOM * this.sphere.radius) / half, smoothly);
    this.touch();
  }

  /** The middle of what is seen from a direction, and half of the height that it needs. */
  private extent(away: THREE.Vector3, up: THREE.Vector3): { target: THREE.Vector3; half: number } {
    const across = new THREE.Vector3().crossVectors(up, away).normalize();
    const upward = new THREE.Vector3().crossVectors(away, across);
    const low = new THREE.Vector2(Infinity, Infinity);
    const high = new THREE.Vector2(-Infinity, -Infinity);
    const at = new THREE.Vector3();
    const seen = new THREE.Vector2();
    for (let i = 0; i + 2 < this.framed.length; i += 3) {
      at.set(this.framed[i] ?? 0, this.framed[i + 1] ?? 0, this.framed[i + 2] ?? 0).sub(this.sphere.center);
      seen.set(at.dot(across), at.dot(upward));
      low.min(seen);
      high.max(seen);
    }
    if (this.second.mesh.visible) {
      const aside = this.second.mesh.position;
      seen.set(aside.dot(across), aside.dot(upward));
      low.min(low.clone().add(seen));
      high.max(high.clone().add(seen));
    }
    const middle = low.clone().add(high).multiplyScalar(0.5);
    const size = high.clone().sub(low);
    // The surface of a few points may be much larger than they are.
    const least = this.framed.length < 3 * FEW_POINTS ? 2 * this.sphere.radius : 0.2 * this.sphere.radius;
    const half = (ROOM / 2) * Math.max(size.y, size.x / this.perspective.aspect, least);
    const target = this.sphere.center.clone().addScaledVector(across, middle.x).addScaledVector(upward, middle.y - FOOT * half);
    return { target, half };
  }

  set isFlat(flat: boolean) {
    if (flat === this.flat) return;
    const position = this.controls.getPosition(new THREE.Vector3());
    const target = this.controls.getTarget(new THREE.Vector3());
    this.controls.dispose();
    this.flat = flat;
    this.controls = this.steer(this.camera);
    this.controls.updateCameraUp();
    void this.controls.setLookAt(position.x, position.y, position.z, target.x, target.y, target.z, false);
    this.resize();
  }

  nearer(factor: number): void {
    if (this.flat) void this.controls.zoomTo(this.orthographic.zoom * factor, true);
    else void this.controls.dollyTo(this.controls.distance / factor, true);
    this.touch();
  }

  draw(drawing: Drawing): void {
    this.surface.draw(drawing);
    this.control.draw(drawing);
    this.castShadows();
  }
  /** Shows another surface beside the first, and what the two are; or with null none. */
  drawBeside(drawing: Drawing | null, words: readonly [string, string] | null = null): void {
    const was = this.second.mesh.visible;
    if (drawing) this.second.draw(drawing);
    else this.second.clear();
    const across = new THREE.Vector3().crossVectors(new THREE.Vector3(...this.up), this.away('home')).normalize();
    this.second.mesh.position.copy(across.multiplyScalar(BESIDE * this.sphere.radius));
    this.captions.stand(this.sphere, new THREE.Vector3(...this.up), this.second.mesh.position);
    this.captions.write(drawing ? words : null);
    if (was !== this.second.mesh.visible) this.look('home');
    this.castShadows();
  }

  /** Keeps none of the arrays, but with triangles all. */
  reshape(change: Change): void {
    if (change.triangles) this.surface.draw({ ...change, triangles: change.triangles });
    else this.surface.reshape(change);
    this.control.move(change.control, change.moved);
    this.castShadowsSoon();
    this.touch();
  }
  /** origins: Work.origins. */
  drawPoints(points: Float64Array, origins: Float64Array = new Float64Array()): void {
    this.spokes.draw(origins, points);
    this.points.draw(points, (points.length / 3 > MANY_POINTS ? 3 : POINT_PIXELS) * this.renderer.getPixelRatio());
    this.touch();
  }
  wear(look: Look): void {
    if (look === 'plain') this.surface.lookPlain();
    else if (look === 'zebra') this.surface.lookZebra();
    else if (look instanceof Float32Array) this.surface.lookTextured(look);
    else this.surface.lookMeasured(look);
    this.touch();
  }
  clearSurface(): void {
    this.surface.clear();
    this.control.clear();
    this.second.clear();
    this.castShadows();
  }

  /** In pixels of the page. */
  get width(): number {
    return this.renderer.getSize(new THREE.Vector2()).x;
  }

  /** The picture as a PNG file, without its background, so many pixels wide: as on the screen, lines and points too. */
  async png(width: number): Promise<{ blob: Blob; size: { width: number; height: number } }> {
    const most = this.renderer.getContext().getParameter(this.renderer.getContext().MAX_RENDERBUFFER_SIZE) as number;
    const shown = this.renderer.getSize(new THREE.Vector2());
    const height = Math.round((width * shown.y) / shown.x);
    if (!(width >= 16 && Math.max(width, height) <= most)) throw new Error(`this browser draws pictures 16 to ${most} pixels wide`);
    const ratio = this.renderer.getPixelRatio();
    this.renderer.setPixelRatio(1);
    this.renderer.setSize(width, height, false);
    this.points.scale(width / shown.x / ratio);
    this.renderer.render(this.scene, this.camera);
    const { drawingBufferWidth, drawingBufferHeight } = this.renderer.getContext();
    const blob = await new Promise<Blob | null>((resolve) => this.canvas.toBlob(resolve, 'image/png'));
    this.renderer.setPixelRatio(ratio);
    this.points.scale(1);
    this.resize();
    if (!blob || drawingBufferWidth !== width || drawingBufferHeight !== height) throw new Error('the browser gives no picture of this size');
    return { blob, size: { width, height } };
  }
}
