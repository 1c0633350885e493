// Serves the built page on this machine: node serve.mjs FOLDER [PORT]. Prints its address. Static hosts need nothing of
// this; with these headers the page may share memory with its Worker, so that Stop is heard at once.
import { createServer } from 'node:http';
import { readFile } from 'node:fs/promises';
import { extname, join, normalize, resolve } from 'node:path';
import { promisify } from 'node:util';
import { brotliCompress, constants } from 'node:zlib';

const TYPES = {
  '.css': 'text/css',
  '.html': 'text/html; charset=utf-8',
  '.js': 'text/javascript',
  '.json': 'application/json',
  '.obj': 'text/plain',
  '.svg': 'image/svg+xml',
  '.wasm': 'application/wasm',
  '.webp': 'image/webp',
  '.webmanifest': 'application/manifest+json',
};
const HEADERS = {
  'Cross-Origin-Opener-Policy': 'same-origin',
  'Cross-Origin-Embedder-Policy': 'require-corp',
  'X-Content-Type-Options': 'nosniff',
  'Referrer-Policy': 'no-referrer',
};
const compress = promisify(brotliCompress);
const packed = new Map();

/** As the build has packed it, or packed now. */
async function pack(path, bytes) {
  const ready = await readFile(`${path}.br`).catch(() => null);
  if (ready) return ready;
  if (!packed.has(path)) packed.set(path, await compress(bytes, { params: { [constants.BROTLI_PARAM_QUALITY]: 5 } }));
  return packed.get(path);
}

export function serve(folder, port = 0) {
  const root = resolve(folder);
  const server = createServer(async (request, response) => {
    try {
      const name = decodeURIComponent(new URL(request.url, 'http://x').pathname);
      const path = normalize(join(root, name.endsWith('/') ? `${name}index.html` : name));
      if (!path.startsWith(root)) throw new Error('outside');
      const type = TYPES[extname(path)] ?? 'application/octet-stream';
      let bytes = await readFile(path);
      const headers = { ...HEADERS, 'Content-Type': type, 'Cache-Control': path.includes('/assets/') ? 'max-age=31536000, immutable' : 'no-cache' };
      if (type !== 'image/webp' && /\bbr\b/.test(request.headers['accept-encoding'] ?? '')) {
        bytes = await pack(path, bytes);
        headers['Content-Encoding'] = 'br';
      }
      response.writeHead(200, headers).end(bytes);
    } catch {
      response.writeHead(404, HEADERS).end('not found');
    }
  });
  return new Promise((done, fail) => {
    server.on('error', fail);
    server.listen(port, '127.0.0.1', () => done({ server, url: `http://127.0.0.1:${server.address().port}/` }));
  });
}

if (process.argv[1] && import.meta.url.endsWith(process.argv[1].split('/').pop())) {
  const { url } = await serve(process.argv[2] ?? '.', Number(process.argv[3] ?? 0));
  process.stdout.write(`${url}\n`);
}
