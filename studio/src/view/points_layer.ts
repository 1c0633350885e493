/** Points as discs of a fixed size on the screen, one of them picked. */
import { BufferAttribute, BufferGeometry, Color, Points, ShaderMaterial } from 'three';

const VERTEX = `
  uniform float size; uniform float scale; uniform float lift; uniform float picked; attribute float number; varying float vPicked;
  void main() {
    vPicked = abs(number - picked) < 0.5 ? 1.0 : 0.0;
    vec4 view = modelViewMatrix * vec4(position, 1.0);
    gl_Position = projectionMatrix * view;
    vec4 nearer = projectionMatrix * vec4(view.xy, view.z + lift, 1.0);
    gl_Position.z = gl_Position.w * nearer.z / nearer.w;
    gl_PointSize = size * scale * (1.0 + 0.7 * vPicked);
  }`;
const FRAGMENT = `
  uniform vec3 color; uniform vec3 pickedColor; uniform vec3 rim; varying float vPicked;
  void main() {
    float r = length(2.0 * gl_PointCoord - 1.0);
    float soft = fwidth(r);
    float inside = 1.0 - smoothstep(1.0 - soft, 1.0, r);
    if (inside < 0.02) discard;
    vec3 fill = mix(color, pickedColor, vPicked);
    gl_FragColor = vec4(mix(fill, rim, smoothstep(0.62 - soft, 0.62 + soft, r)), inside);
    #include <colorspace_fragment>
  }`;

export class PointsLayer {
  readonly object = new Points(new BufferGeometry());
  private readonly material = new ShaderMaterial({
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    transparent: true,
    uniforms: { size: { value: 9 }, scale: { value: 1 }, lift: { value: 0 }, picked: { value: -1 }, color: { value: new Color() }, pickedColor: { value: new Color() }, rim: { value: new Color() } },
  });

  constructor() {
    this.object.material = this.material;
    this.object.frustumCulled = false;
    this.object.renderOrder = 2;
  }

  private uniform(name: string): { value: unknown } {
    const uniform = this.material.uniforms[name];
    if (!uniform) throw new Error(`no uniform ${name}`);
    return uniform;
  }

  /** So far the discs stand before what they lie on, which would cut them otherwise. */
  set lift(distance: number) {
    this.uniform('lift').value = distance;
  }

  colors(color: string, picked: string, rim: string): void {
    this.uniform('color').value = new Color(color);
    this.uniform('pickedColor').value = new Color(picked);
    this.uniform('rim').value = new Color(rim);
  }

  /** size: in pixels of the screen. */
  draw(points: Float64Array, size: number): void {
    this.object.geometry.dispose();
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(Float32Array.from(points), 3));
    geometry.setAttribute('number', new BufferAttribute(Float32Array.from({ length: points.length / 3 }, (_, i) => i), 1));
    this.object.geometry = geometry;
    this.uniform('size').value = size;
  }

  /** Discs so many times as large, in a picture of more pixels. */
  scale(factor: number): void {
    this.uniform('scale').value = factor;
  }

  move(vertex: number, to: readonly [number, number, number]): void {
    const attribute = this.object.geometry.getAttribute('position') as BufferAttribute | undefined;
    if (!attribute) return;
    attribute.setXYZ(vertex, ...to);
    attribute.needsUpdate = true;
  }

  pick(vertex: number | null): void {
    this.uniform('picked').value = vertex ?? -1;
  }
}
