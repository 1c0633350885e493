import { createHash } from 'node:crypto';
import { readFileSync } from 'node:fs';
import { writeFile } from 'node:fs/promises';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { promisify } from 'node:util';
import { brotliCompress, constants } from 'node:zlib';
import type { Plugin } from 'vite';
import { defineConfig } from 'vitest/config';

// The engine is built by CMake (preset studio); ./batten studio does both.
const engine = fileURLToPath(new URL('../build/studio/studio/engine', import.meta.url));

/** The service worker, with the names of all files of this build: the page works without a network after its first load. */
function offline(): Plugin {
  return {
    name: 'offline',
    apply: 'build',
    generateBundle(_options, bundle) {
      const files = ['./', 'icon.svg', ...Object.keys(bundle).filter((name) => name !== 'index.html')];
      const version = createHash('sha256').update(files.join('\n')).digest('hex').slice(0, 12);
      const body = readFileSync(fileURLToPath(new URL('src/offline.js', import.meta.url)), 'utf8');
      const source = `const VERSION = '${version}';\nconst FILES = ${JSON.stringify(files)};\n${body}`;
      this.emitFile({ type: 'asset', fileName: 'offline.js', source });
    },
  };
}

/** Beside each large file the same packed, an eighth smaller than a server packs it while somebody waits; many hosts send these. */
function packed(): Plugin {
  const SMALL = 4096;
  const compress = promisify(brotliCompress);
  return {
    name: 'packed',
    apply: 'build',
    async writeBundle({ dir = '' }, bundle) {
      const large = Object.values(bundle).filter(({ fileName }) => /\.(wasm|js|css)$/.test(fileName)).map(({ fileName }) => join(dir, fileName));
      await Promise.all(large.map(async (path) => {
        const bytes = readFileSync(path);
        if (bytes.length < SMALL) return;
        const params = { [constants.BROTLI_PARAM_QUALITY]: 10, [constants.BROTLI_PARAM_SIZE_HINT]: bytes.length };
        await writeFile(`${path}.br`, await compress(bytes, { params }));
      }));
    },
  };
}

export default defineConfig({
  base: './',
  plugins: [offline(), packed()],
  resolve: { alias: { '@engine': engine } },
  build: { target: 'es2022', outDir: '../build/studio/page', emptyOutDir: true, assetsInlineLimit: 0, modulePreload: { polyfill: false }, chunkSizeWarningLimit: 1200 },
  worker: { format: 'es' },
  server: { fs: { allow: ['..'] } },
  test: { include: ['tests/unit/**/*.test.ts'], testTimeout: 60_000 },
});
