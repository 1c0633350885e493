/** The engine as the page sees it: started in a Worker, stopped when it should stop. */
import * as Comlink from 'comlink';
import type { Engine } from './engine';
import type { Host } from './worker';
import { EngineError } from './types';

const CANCELLED = 18;

export class EngineClient {
  private worker: Worker | null = null;
  private remote: Comlink.Remote<Engine> | null = null;
  private stopFlag: Int32Array | null = null;
  private rejectRunning: ((reason: Error) => void) | null = null;
  onProgress: (done: number) => void = () => undefined;
  /** Called after a restart: the engine holds nothing any more. */
  onRestart: () => void = () => undefined;

  private async start(): Promise<Comlink.Remote<Engine>> {
    this.worker = new Worker(new URL('./worker.ts', import.meta.url), { type: 'module' });
    this.stopFlag = globalThis.crossOriginIsolated ? new Int32Array(new SharedArrayBuffer(4)) : null;
    const host = Comlink.wrap<Host>(this.worker);
    const engine = await host.start(this.stopFlag, Comlink.proxy((done: number) => this.onProgress(done)));
    return engine as unknown as Comlink.Remote<Engine>;
  }

  /** Runs `work` on the engine. Errors of the library are thrown as EngineError. */
  async run<T>(work: (engine: Comlink.Remote<Engine>) => Promise<T>): Promise<T> {
    this.remote ??= await this.start();
    if (this.stopFlag) Atomics.store(this.stopFlag, 0, 0);
    const remote = this.remote;
    try {
      return await new Promise<T>((resolve, reject) => {
        this.rejectRunning = reject;
        work(remote).then(resolve, reject);
      });
    } catch (error) {
      throw asEngineError(error);
    } finally {
      this.rejectRunning = null;
    }
  }

  /** Stops what is running: by the library's own callback where memory is shared, otherwise with the Worker. */
  stop(): void {
    if (this.stopFlag) {
      Atomics.store(this.stopFlag, 0, 1);
      return;
    }
    if (this.rejectRunning) this.restart('stopped');
  }

  /** Ends the Worker, whatever it does. The next run starts another. */
  restart(reason: string): void {
    this.worker?.terminate();
    this.worker = null;
    this.remote = null;
    this.rejectRunning?.(new EngineError(reason, CANCELLED));
    this.onRestart();
  }
}

/** comlink carries an error's message and name; the code is behind the message (engine.ts throws EngineError). */
function asEngineError(error: unknown): Error {
  return error instanceof Error ? error : new Error(String(error));
}
