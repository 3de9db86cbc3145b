// Morph targets in a stream: attributes that hold one of the offsets of many targets, three components for each.
const kName = /^TARGETS_(\d+)_(POSITION|NORMAL|TANGENT)$/;

/** The attribute that TARGETS_42_NORMAL and the like hold for the targets from the 43rd on; undefined for other names. */
export const targetAttribute = name => kName.exec(name)?.[2];

/** Attributes as a decoder gives them -> {attributes: the others, targets: [{POSITION: floats, NORMAL: ...}]}. Throws where these are not `count`. */
export function takeTargets(attributes, vertices, count) {
  const others = {}, targets = Array.from({length: count}, () => ({})), next = {};
  for (const [name, values] of Object.entries(attributes)) {
    const of = targetAttribute(name);
    if (!of) {
      others[name] = values;
      continue;
    }
    const components = values.length / vertices, first = next[of] ?? 0, end = next[of] = first + components / 3;
    if (Number(kName.exec(name)[1]) !== first || !(end <= count)) throw new Error(`the morph targets of ${name} are not those of the primitive`);
    for (let t = first; t < end; ++t) {
      const offsets = targets[t][of] = new Float32Array(3 * vertices);
      for (let v = 0, at = 3 * (t - first); v < vertices; ++v, at += components) offsets.set(values.subarray(at, at + 3), 3 * v);
    }
  }
  if (Object.values(next).some(end => end !== count) || (count > 0 && Object.keys(next).length === 0)) throw new Error(`the stream has not the ${count} morph targets of the primitive`);
  return {attributes: others, targets};
}
