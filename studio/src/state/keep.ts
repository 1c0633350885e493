/** Keeps the work in the browser, so that a reload loses nothing. */
import { openDB } from 'idb';
import type { Kept, Store } from './store';

const STORE = 'work';
const KEY = 'current';
const PAUSE_MS = 400;

async function database() {
  return openDB('batten-studio', 1, { upgrade: (db) => void db.createObjectStore(STORE) });
}

export async function restore(): Promise<Kept | null> {
  try {
    return ((await (await database()).get(STORE, KEY)) as Kept | undefined) ?? null;
  } catch {
    return null; // private windows have no database; the page works without
  }
}

export async function clear(): Promise<void> {
  await (await database()).delete(STORE, KEY);
}

/** Saves a little after each change. */
export function keepIn(store: Store, told: (kept: boolean) => void): void {
  let timer: ReturnType<typeof setTimeout> | undefined;
  store.subscribe((kept) => {
    clearTimeout(timer);
    timer = setTimeout(() => {
      void database()
        .then((db) => db.put(STORE, kept, KEY))
        .then(() => told(true), () => told(false));
    }, PAUSE_MS);
  });
}
