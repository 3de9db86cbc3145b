// Between attributes of three.js and plain arrays.
export function toFloats(attribute) {
  const {count, itemSize} = attribute;
  if (attribute.array instanceof Float32Array && !attribute.isInterleavedBufferAttribute) return attribute.array;
  const floats = new Float32Array(count * itemSize);
  for (let i = 0; i < count; ++i) {
    for (let k = 0; k < itemSize; ++k) floats[i * itemSize + k] = attribute.getComponent(i, k);
  }
  return floats;
}
