/** Work as the end of a link: settings and mesh, packed. Nothing is sent: what stands behind # stays in the browser. */
import type { Settings, Source } from './work';

/** Longer links are cut by some programs. */
const MOST_LETTERS = 32_000;

interface Shared {
  readonly name: string;
  readonly settings: Settings;
  readonly text: string;
}

async function through(bytes: Uint8Array<ArrayBuffer>, stream: CompressionStream | DecompressionStream): Promise<Uint8Array<ArrayBuffer>> {
  return new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer());
}

/** text: the mesh as OBJ. Throws where it is too large for a link. */
export async function linkOf(name: string, settings: Settings, text: string): Promise<string> {
  const shared: Shared = { name, settings, text };
  const packed = await through(new TextEncoder().encode(JSON.stringify(shared)), new CompressionStream('deflate-raw'));
  const letters = btoa(Array.from(packed, (byte) => String.fromCharCode(byte)).join('')).replaceAll('+', '-').replaceAll('/', '_').replaceAll('=', '');
  if (letters.length > MOST_LETTERS) throw new Error('this mesh is too large for a link: download it instead');
  return `#work=${letters}`;
}

/** The other way; null where the link holds no work. */
export async function workOfLink(hash: string): Promise<{ source: Source; settings: Settings } | null> {
  const letters = /^#work=([\w-]+)$/.exec(hash)?.[1];
  if (!letters) return null;
  const bytes = Uint8Array.from(atob(letters.replaceAll('-', '+').replaceAll('_', '/')), (letter) => letter.charCodeAt(0));
  const shared = JSON.parse(new TextDecoder().decode(await through(bytes, new DecompressionStream('deflate-raw')))) as Shared;
  return { source: { name: shared.name, bytes: new TextEncoder().encode(shared.text) }, settings: shared.settings };
}
