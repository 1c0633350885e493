/** The engine's client with an engine of the test's own. */
import type * as Comlink from 'comlink';
import { describe, expect, it } from 'vitest';
import { EngineClient, type Started } from '../../src/engine/client';
import type { Engine } from '../../src/engine/engine';
import type { Change, Shape } from '../../src/engine/types';

/** Starts engines that are numbers, each later than the one before where `late` says so. */
function counting(waits: readonly number[]) {
  const ended: number[] = [];
  let count = 0;
  const client = new EngineClient(async () => {
    const number = count++;
    await new Promise((resolve) => setTimeout(resolve, waits[number] ?? 0));
    return { remote: { number } as unknown as Comlink.Remote<Engine>, end: () => ended.push(number) } satisfies Started;
  });
  const number = () => client.run(async (engine) => (engine as unknown as { number: number }).number);
  return { client, number, ended, started: () => count };
}

describe('EngineClient', () => {
  it('starts one engine, also for those who ask while it starts', async () => {
    const { number, started } = counting([20, 1]);
    expect(await Promise.all([number(), number()])).toEqual([0, 0]);
    expect(await number()).toBe(0);
    expect(started()).toBe(1);
  });

  it('ends an engine that still starts when it is started again', async () => {
    const { client, number, ended } = counting([20]);
    const first = number();
    client.restart('cleared');
    expect(await number()).toBe(1);
    expect(await first).toBe(1);
    expect(ended).toEqual([0]);
  });

  it('tries again after a start that failed', async () => {
    let tries = 0;
    const client = new EngineClient(async () => {
      if (tries++ === 0) throw new Error('no memory');
      return { remote: {} as Comlink.Remote<Engine>, end: () => undefined };
    });
    await expect(client.run(async () => 1)).rejects.toThrow('no memory');
    expect(await client.run(async () => 1)).toBe(1);
  });

  it('hands the arrays of a shape back once it is drawn, unless they are kept or of some vertices', async () => {
    const client = new EngineClient(async () => ({ remote: {} as Comlink.Remote<Engine>, end: () => undefined }));
    const shape = (): Shape => ({ points: new Float32Array(6), normals: new Float32Array(6), control: new Float32Array(3) });
    const first = shape();
    const rooms: (Shape | null)[] = [];
    const drawn: Change[] = [];
    const answers: Change[] = [first, { ...shape(), vertices: Int32Array.of(1) }, { ...shape(), triangles: new Uint32Array(3) }, shape()];
    for (const answer of answers)
      await client.reshape<Change>(
        async (_, room) => {
          rooms.push(room);
          return answer;
        },
        (change) => drawn.push(change),
      );
    expect(drawn).toEqual(answers);
    expect(rooms[1]?.points).toBe(first.points);
    expect(rooms[1]?.normals).toBe(first.normals);
    expect(rooms[1]?.control).toBe(first.control);
    expect([rooms[0], rooms[2], rooms[3]]).toEqual([null, null, null]);
  });
});
