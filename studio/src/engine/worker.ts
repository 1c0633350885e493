/** The Worker: loads the engine and answers by comlink. */
import * as Comlink from 'comlink';
import createEngine from '@engine/engine.js';
import wasmUrl from '@engine/engine.wasm?url';
import { Engine } from './engine';
import { handedOver } from './handing';
import type { EngineModule } from './module';
import type { Drawing } from './types';

/** Stop is written by the page where memory can be shared; elsewhere the page ends this Worker. */
let stop: Int32Array | null = null;
let tell: ((done: number) => void) | null = null;
let show: ((drawing: Drawing) => void) | null = null;
let told = 0;

function report(done: number): boolean {
  const now = performance.now();
  if (tell && now - told > 100) {
    told = now;
    tell(done);
  }
  return !stop || Atomics.load(stop, 0) === 0;
}

function watch(drawing: Drawing): void {
  show?.(handedOver(drawing));
}

/** The engine, whose results are handed over instead of copied: they are nobody else's. */
function handingOver(engine: Engine): Engine {
  return new Proxy(engine, {
    get(target, name) {
      const member: unknown = Reflect.get(target, name);
      if (typeof member !== 'function') return member;
      return (...words: unknown[]) => handedOver(Reflect.apply(member, target, words) as unknown);
    },
  });
}

const host = {
  async start(shared: Int32Array | null, progress: (done: number) => void, frame: (drawing: Drawing) => void): Promise<Engine & Comlink.ProxyMarked> {
    stop = shared;
    tell = progress;
    show = frame;
    const module = (await createEngine({ locateFile: () => wasmUrl })) as EngineModule;
    return Comlink.proxy(handingOver(new Engine(module, report, watch)));
  },
};
export type Host = typeof host;
Comlink.expose(host);
