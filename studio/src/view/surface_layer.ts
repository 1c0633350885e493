/** The limit surface as triangles with exact normals, in one of three looks. */
import { BufferAttribute, BufferGeometry, DoubleSide, Mesh, MeshMatcapMaterial, ShaderMaterial } from 'three';
import type { Change, Drawing, Field } from '../engine/types';
import { putRows } from './rows';
import { barPlace, barTexture, EVEN, matcap, PORCELAIN, SATIN } from './matcap';

/** Stripes of light from all around: they break where the surface does. */
function zebraMaterial(): ShaderMaterial {
  return new ShaderMaterial({
    side: DoubleSide,
    vertexShader: `
      varying vec3 vNormal; varying vec3 vView;
      void main() {
        vec4 view = modelViewMatrix * vec4(position, 1.0);
        vNormal = normalMatrix * normal; vView = view.xyz;
        gl_Position = projectionMatrix * view;
      }`,
    fragmentShader: `
      varying vec3 vNormal; varying vec3 vView;
      void main() {
        vec3 n = normalize(vNormal) * (gl_FrontFacing ? 1.0 : -1.0);
        vec3 r = reflect(normalize(vView), n);
        float wave = 9.0 * asin(clamp(r.y, -1.0, 1.0));
        float width = fwidth(wave);
        float stripe = smoothstep(-width, width, sin(wave));
        float shade = 0.82 + 0.18 * n.z;
        gl_FragColor = vec4(vec3(mix(0.06, 0.94, stripe) * shade), 1.0);
      }`,
  });
}

export class SurfaceLayer {
  readonly mesh = new Mesh(new BufferGeometry());
  private readonly plain = new MeshMatcapMaterial({ matcap: matcap(PORCELAIN), side: DoubleSide });
  private readonly measured = new MeshMatcapMaterial({ matcap: matcap(EVEN), side: DoubleSide });
  private readonly textured = new MeshMatcapMaterial({ matcap: matcap(SATIN), side: DoubleSide, vertexColors: true });
  private readonly zebra = zebraMaterial();

  constructor() {
    this.mesh.material = this.plain;
    this.mesh.frustumCulled = false;
    for (const material of [this.plain, this.measured, this.textured, this.zebra]) {
      material.polygonOffset = true;
      material.polygonOffsetFactor = 1;
      material.polygonOffsetUnits = 1;
    }
  }

  /** Numbers and colours at the vertices are those of other ones, and go. */
  draw(drawing: Pick<Drawing, 'points' | 'normals' | 'triangles'>): void {
    if (this.mesh.material !== this.zebra) this.lookPlain();
    this.mesh.geometry.dispose();
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(drawing.points, 3));
    geometry.setAttribute('normal', new BufferAttribute(drawing.normals, 3));
    geometry.setIndex(new BufferAttribute(drawing.triangles, 1));
    geometry.computeBoundingSphere();
    this.mesh.geometry = geometry;
    this.mesh.visible = true;
  }

  /** The same triangles elsewhere. */
  reshape(change: Change): void {
    const { geometry } = this.mesh;
    for (const [name, numbers] of [['position', change.points], ['normal', change.normals]] as const) {
      const attribute = geometry.getAttribute(name) as BufferAttribute | undefined;
      if (!attribute) return;
      if (!putRows(attribute.array, numbers, change.vertices)) return;
      attribute.needsUpdate = true;
    }
    geometry.boundingSphere = null;
  }

  clear(): void {
    this.mesh.visible = false;
  }

  lookPlain(): void {
    this.mesh.material = this.plain;
  }
  lookZebra(): void {
    this.mesh.material = this.zebra;
  }
  /** colors: sRGB of each vertex. */
  lookTextured(colors: Float32Array): void {
    const linear = colors.map((part) => (part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4));
    this.mesh.geometry.setAttribute('color', new BufferAttribute(linear, 3));
    this.mesh.material = this.textured;
  }
  lookMeasured(field: Field): void {
    const places = new Float32Array(2 * field.positions.length);
    field.positions.forEach((position, i) => {
      places[2 * i] = barPlace(position);
      places[2 * i + 1] = 0.5;
    });
    this.mesh.geometry.setAttribute('uv', new BufferAttribute(places, 2));
    this.measured.map?.dispose();
    this.measured.map = barTexture(field.scale.colors);
    this.measured.needsUpdate = true;
    this.mesh.material = this.measured;
  }
}
