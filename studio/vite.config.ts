import { fileURLToPath } from 'node:url';
import { defineConfig } from 'vitest/config';

// The engine is built by CMake (preset studio); ./batten studio does both.
const engine = fileURLToPath(new URL('../build/studio/studio/engine', import.meta.url));

export default defineConfig({
  base: './',
  resolve: { alias: { '@engine': engine } },
  build: { target: 'es2022', outDir: '../build/studio/page', emptyOutDir: true, assetsInlineLimit: 0, modulePreload: { polyfill: false }, chunkSizeWarningLimit: 1200 },
  worker: { format: 'es' },
  server: { fs: { allow: ['..'] } },
  test: { include: ['tests/unit/**/*.test.ts'], testTimeout: 60_000 },
});
