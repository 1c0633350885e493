// OBJ files as numbers, to compare two of them.
export function readObj(text) {
  const points = [];
  const faces = [];
  const tags = [];
  for (const line of text.split('\n')) {
    const words = line.trim().split(/\s+/);
    if (words[0] === 'v') points.push(words.slice(1, 4).map(Number));
    if (words[0] === 'f') faces.push(words.slice(1).map((word) => parseInt(word, 10)).join(' '));
    if (words[0] === 't') tags.push(line.trim());
  }
  return { points, faces, tags };
}

/** The largest difference of a coordinate; NaN where the meshes have other faces. */
export function difference(a, b) {
  if (a.points.length !== b.points.length || a.faces.join('/') !== b.faces.join('/') || a.tags.join('/') !== b.tags.join('/')) return NaN;
  return Math.max(...a.points.map((point, i) => Math.max(...point.map((x, k) => Math.abs(x - b.points[i][k])))));
}

/** The length of the box's diagonal. */
export function diagonal({ points }) {
  return Math.hypot(...[0, 1, 2].map((k) => Math.max(...points.map((point) => point[k])) - Math.min(...points.map((point) => point[k]))));
}
