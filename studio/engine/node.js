// Emscripten 3.1.6 loads by fetch wherever there is one; Node has one that reads no files.
if (typeof process === 'object' && process.versions && process.versions.node) delete globalThis.fetch;
