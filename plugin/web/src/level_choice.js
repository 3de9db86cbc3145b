// Which part of each stream is worth showing: by its error on the screen, within a budget of triangles.

/** Pixels that an error of one unit of length covers at `distance`, for a perspective camera of that vertical field of view (radians). */
export function pixelsPerUnit(distance, fieldOfView, viewportHeight) {
  return viewportHeight / (2 * Math.tan(fieldOfView / 2) * Math.max(distance, 1e-9));
}

/** The first part whose error is at most `allowed`; the last one where none is. */
export function coarsestWithin(errors, allowed) {
  const part = errors.findIndex(error => error <= allowed);
  return part < 0 ? errors.length - 1 : part;
}

/**
 * Parts for several streams. items: [{errors, triangleCounts, scale: pixels per unit of the stream's errors, 0 where it is not seen}].
 * Each gets the coarsest part within pixelError; while all together exceed maxTriangles, the one that loses least per triangle goes back a part.
 */
export function chooseParts(items, {pixelError, maxTriangles = Infinity}) {
  const parts = items.map(item => item.scale > 0 ? coarsestWithin(item.errors, pixelError / item.scale) : 0);
  const triangles = () => parts.reduce((sum, part, i) => sum + items[i].triangleCounts[part], 0);
  for (let total = triangles(); total > maxTriangles; total = triangles()) {
    let best = -1, least = Infinity;
    items.forEach((item, i) => {
      const part = parts[i];
      if (part === 0) return;
      const loss = item.scale * (item.errors[part - 1] - item.errors[part]) / Math.max(1, item.triangleCounts[part] - item.triangleCounts[part - 1]);
      if (loss < least) [best, least] = [i, loss];
    });
    if (best < 0) break;
    --parts[best];
  }
  return parts;
}

/** The order in which segments are worth their bytes: most pixels of error less per byte first. wanted: part per stream. */
export function mostValuable(items, available, wanted, progressive) {
  let best, most = -1;
  items.forEach((item, s) => {
    const part = available[s] + 1;
    if (part > wanted[s]) return;
    const {length} = progressive.streams[s].segments[part];
    const value = Math.max(item.scale, 1e-30) * (item.errors[part - 1] - item.errors[part]) / Math.max(length, 1);
    if (value > most) [best, most] = [progressive.streams[s].segments[part], value];
  });
  return best;
}
