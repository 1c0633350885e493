/** Arrays that change hands between page and Worker instead of being copied. */
import * as Comlink from 'comlink';

/** The memory of all typed arrays in a result. */
function buffersOf(result: unknown): ArrayBuffer[] {
  if (ArrayBuffer.isView(result)) return result.buffer instanceof ArrayBuffer ? [result.buffer] : [];
  return typeof result === 'object' && result !== null ? Object.values(result).flatMap(buffersOf) : [];
}

/** Marks the arrays in it as given away with the message that it goes into. */
export function handedOver<T>(result: T): T {
  return typeof result === 'object' && result !== null ? Comlink.transfer(result, [...new Set(buffersOf(result))]) : result;
}
