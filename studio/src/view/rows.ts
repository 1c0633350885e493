/** Rows of three numbers. */

/** Puts rows in their places; without places, all rows. False, and nothing is done, where there are others than these. */
export function putRows(into: { set(numbers: ArrayLike<number>, offset?: number): void; readonly length: number }, rows: Float32Array, places?: Int32Array): boolean {
  if (!places) {
    if (rows.length !== into.length) return false;
    into.set(rows);
    return true;
  }
  if (places.some((place) => 3 * place + 3 > into.length)) return false;
  places.forEach((place, i) => into.set(rows.subarray(3 * i, 3 * i + 3), 3 * place));
  return true;
}
