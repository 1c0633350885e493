import { createHash } from 'node:crypto';
import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
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

export default defineConfig({
  base: './',
  plugins: [offline()],
  resolve: { alias: { '@engine': engine } },
  build: { target: 'es2022', outDir: '../build/studio/page', emptyOutDir: true, assetsInlineLimit: 0, modulePreload: { polyfill: false }, chunkSizeWarningLimit: 1200 },
  worker: { format: 'es' },
  server: { fs: { allow: ['..'] } },
  test: { include: ['tests/unit/**/*.test.ts'], testTimeout: 60_000 },
});
