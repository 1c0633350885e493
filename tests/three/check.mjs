// node check.mjs FOLDER NAME...: three.js reads NAME.usda and NAME.glb, and finds what NAME.obj and NAME-surface.obj hold.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { USDLoader } from 'three/addons/loaders/USDLoader.js';
import { USDAParser } from 'three/addons/loaders/usd/USDAParser.js';
import { AnimationMixer, Vector3 } from 'three';

function readObj(path) {
  const lines = readFileSync(path, 'utf8').split('\n').map((line) => line.split(' '));
  const rows = (keyword) => lines.filter((words) => words[0] === keyword).map((words) => words.slice(1));
  const tags = rows('t');
  return {
    points: rows('v').flatMap((words) => words.slice(0, 3).map(Number)),
    faces: rows('f').map((words) => words.map((word) => parseInt(word) - 1)),
    creases: tags.filter((words) => words[0] === 'crease').map((words) => words.slice(2).map(Number)),
    boundary: tags.filter((words) => words[0] === 'interpolateboundary').map((words) => Number(words[2]))[0],
  };
}

function theMesh(root) {
  const meshes = [];
  root.updateMatrixWorld(true);
  root.traverse((node) => node.isMesh && meshes.push(node));
  assert.equal(meshes.length, 1);
  return meshes[0];
}

/// Points of the triangles in the world, one after the other.
function trianglePoints(mesh) {
  const { position } = mesh.geometry.attributes;
  const index = mesh.geometry.index;
  const count = index ? index.count : position.count;
  return Array.from({ length: count }, (_, i) =>
    new Vector3().fromBufferAttribute(position, index ? index.getX(i) : i).applyMatrix4(mesh.matrixWorld));
}

const triangleCount = (faces) => faces.reduce((sum, face) => sum + face.length - 2, 0);

function bounds(points) {
  const low = [0, 1, 2].map((k) => points.reduce((least, p) => Math.min(least, p[k]), Infinity));
  const high = [0, 1, 2].map((k) => points.reduce((most, p) => Math.max(most, p[k]), -Infinity));
  return [...low, ...high];
}

/// The same box, to the floats that three.js computes in.
function assertSameBounds(ours, theirs, used) {
  const size = Math.hypot(...[0, 1, 2].map((k) => ours[k + 3] - ours[k]));
  ours.forEach((value, k) => assert(Math.abs(value - theirs[k]) < 1e-6 * size, `bound ${k}: ${value}, ${theirs[k]}`));
}

const usedPoints = ({ points, faces }) => faces.flat().map((v) => points.slice(3 * v, 3 * v + 3));

/// The points as they stand where y is up: in GLB files always, and three.js turns USD stages so.
const upright = (obj, axis) => ({
  ...obj,
  points: axis === 'Z' ? obj.points.map((x, i) => (i % 3 === 0 ? x : i % 3 === 1 ? obj.points[i + 1] : -obj.points[i - 1])) : obj.points,
});
const upAxis = (path) => /upAxis = "([YZ])"/.exec(readFileSync(path, 'utf8'))[1];

function checkUsda(path, obj) {
  const text = readFileSync(path, 'utf8');
  const specs = new USDAParser().parseData(text).specsByPath;
  const value = (name) => specs[`/surface.${name}`]?.fields.default;
  assert.deepEqual(value('points'), obj.points, 'every double');
  assert.deepEqual(value('faceVertexCounts'), obj.faces.map((face) => face.length));
  assert.deepEqual(value('faceVertexIndices'), obj.faces.flat());
  assert.equal(value('subdivisionScheme'), obj.faces.every((face) => face.length === 3) ? 'loop' : 'catmullClark');
  assert.equal(value('interpolateBoundary'), ['none', 'edgeAndCorner', 'edgeOnly'][obj.boundary]);
  // The polylines hold each creased edge once.
  const key = (a, b, sharpness) => `${Math.min(a, b)} ${Math.max(a, b)} ${sharpness}`;
  const edges = [];
  let place = 0;
  (value('creaseLengths') ?? []).forEach((length, chain) => {
    const vertices = value('creaseIndices').slice(place, (place += length));
    vertices.slice(1).forEach((v, i) => edges.push(key(vertices[i], v, value('creaseSharpnesses')[chain])));
  });
  assert.deepEqual(edges.sort(), obj.creases.map(([a, b, sharpness]) => key(a, b, Math.min(sharpness, 10))).sort());
  const drawn = trianglePoints(theMesh(new USDLoader().parse(text)));
  assert.equal(drawn.length, 3 * triangleCount(obj.faces));
  assertSameBounds(bounds(usedPoints(upright(obj, upAxis(path)))), bounds(drawn.map((p) => p.toArray())));
}

async function checkGlb(path, obj) {
  const bytes = readFileSync(path);
  const gltf = await new GLTFLoader().parseAsync(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), '');
  const mesh = theMesh(gltf.scene);
  const points = trianglePoints(mesh);
  assert.equal(points.length, 3 * triangleCount(obj.faces));
  assertSameBounds(bounds(usedPoints(obj)), bounds(points.map((p) => p.toArray())));
  const { normal } = mesh.geometry.attributes;
  for (let i = 0; i < normal.count; ++i) {
    assert(Math.abs(new Vector3().fromBufferAttribute(normal, i).length() - 1) < 2e-7);
  }
}

/// Played to a time, the vertices and normals are those of the surface at that time.
async function checkMorph(folder, times, axis) {
  const bytes = readFileSync(`${folder}/morph.glb`);
  const gltf = await new GLTFLoader().parseAsync(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), '');
  const mesh = theMesh(gltf.scene);
  assert.equal(gltf.animations.length, 1);
  assert.equal(gltf.animations[0].duration, 2);
  const mixer = new AnimationMixer(gltf.scene);
  const action = mixer.clipAction(gltf.animations[0]).play();
  action.clampWhenFinished = true;
  action.setLoop(2200, 1);  // LoopOnce
  for (const time of times) {
    mixer.setTime(2 * time);
    const obj = upright(readObj(`${folder}/morph-${time}.obj`), axis);
    const theirs = usedPoints(obj);
    const index = mesh.geometry.index;
    const corners = obj.faces.flatMap((f) => f.slice(2).flatMap((v, i) => [f[0], f[i + 1], v]));
    assert.equal(index.count, corners.length);
    // Triangles may be cut along either diagonal; so every drawn vertex is looked for among the surface's.
    const known = new Set(theirs.map((p) => p.map((x) => Math.round(x * 1e4)).join()));
    let missed = 0;
    for (let i = 0; i < mesh.geometry.attributes.position.count; ++i) {
      const at = mesh.getVertexPosition(i, new Vector3()).applyMatrix4(mesh.matrixWorld);
      const near = [0, 1, -1].some((a) => [0, 1, -1].some((b) => [0, 1, -1].some((c) =>
        known.has([at.x, at.y, at.z].map((x, k) => Math.round(x * 1e4) + [a, b, c][k]).join()))));
      if (!near) ++missed;
    }
    assert.equal(missed, 0, `${missed} vertices off the surface at ${time}`);
  }
  console.log('morph: three.js plays the animation through the surfaces');
}

const [folder, ...names] = process.argv.slice(2);
for (const name of names) {
  checkUsda(`${folder}/${name}.usda`, readObj(`${folder}/${name}.obj`));
  await checkGlb(`${folder}/${name}.glb`, upright(readObj(`${folder}/${name}-surface.obj`), upAxis(`${folder}/${name}.usda`)));
  console.log(`${name}: three.js reads the control mesh from USDA and the surface from GLB`);
}
await checkMorph(folder, [0, 0.5, 0.75, 1], upAxis(`${folder}/creature.usda`));
