/** The engine as the page sees it: started in a Worker, stopped when it should stop. */
import * as Comlink from 'comlink';
import type { Engine } from './engine';
import type { Host } from './worker';
import { handedOver } from './handing';
import type { Change, Drawing, Shape } from './types';
import { EngineError } from './types';

const CANCELLED = 18;

/** An engine somewhere else. */
export interface Started {
  readonly remote: Comlink.Remote<Engine>;
  end(): void;
}
/** frame: is given each surface on the way to a result. */
export type Start = (stopFlag: Int32Array | null, progress: (done: number) => void, frame: (drawing: Drawing) => void) => Promise<Started>;

async function startWorker(stopFlag: Int32Array | null, progress: (done: number) => void, frame: (drawing: Drawing) => void): Promise<Started> {
  const worker = new Worker(new URL('./worker.ts', import.meta.url), { type: 'module' });
  const host = Comlink.wrap<Host>(worker);
  const engine = await host.start(stopFlag, Comlink.proxy(progress), Comlink.proxy(frame)).catch((error: unknown) => {
    worker.terminate();
    throw error;
  });
  return { remote: engine as unknown as Comlink.Remote<Engine>, end: () => worker.terminate() };
}

export class EngineClient {
  /** One engine, also for those who ask while it starts: each holds its own files. */
  private engine: Promise<Started> | null = null;
  private stopFlag: Int32Array | null = null;
  private rejectRunning: ((reason: Error) => void) | null = null;
  /** Arrays of the last shape, which the page has done with. */
  private room: Shape | null = null;
  onProgress: (done: number) => void = () => undefined;
  onFrame: (drawing: Drawing) => void = () => undefined;
  /** Called after a restart: the engine holds nothing any more. */
  onRestart: () => void = () => undefined;

  constructor(private readonly startEngine: Start = startWorker) {}

  private start(): Promise<Started> {
    this.stopFlag = globalThis.crossOriginIsolated ? new Int32Array(new SharedArrayBuffer(4)) : null;
    return this.startEngine(this.stopFlag, (done) => this.onProgress(done), (drawing) => this.onFrame(drawing));
  }

  /** Runs `work` on the engine. Errors of the library are thrown as EngineError. */
  async run<T>(work: (engine: Comlink.Remote<Engine>) => Promise<T>): Promise<T> {
    const engine = (this.engine ??= this.start());
    const { remote } = await engine.catch((error: unknown) => {
      if (this.engine === engine) this.engine = null; // the next run tries again
      throw asEngineError(error);
    });
    if (this.engine !== engine) return this.run(work); // ended while it started: it would never answer
    if (this.stopFlag) Atomics.store(this.stopFlag, 0, 0);
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

  /**
   * Runs `work` that answers a surface in motion, and `use`, which keeps none of its arrays: they go back with the next
   * call, and the engine fills them again, since a browser clears fresh memory before it is written.
   */
  async reshape<T extends Change>(work: (engine: Comlink.Remote<Engine>, room: Shape | null) => Promise<T>, use: (change: T) => void): Promise<T> {
    const { room } = this;
    this.room = null;
    const change = await this.run((engine) => work(engine, handedOver(room)));
    use(change);
    // Those of some vertices are of another size each time, and triangles are kept with their points.
    if (!change.vertices && !change.triangles) this.room = { points: change.points, normals: change.normals, control: change.control };
    return change;
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
    void this.engine?.then((started) => started.end(), () => undefined);
    this.engine = null;
    this.rejectRunning?.(new EngineError(reason, CANCELLED));
    this.onRestart();
  }
}

/** comlink carries an error's message and name; the code is behind the message (engine.ts throws EngineError). */
function asEngineError(error: unknown): Error {
  return error instanceof Error ? error : new Error(String(error));
}
