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

const kNames = {POSITION: 'position', NORMAL: 'normal', TANGENT: 'tangent', TEXCOORD_0: 'uv', COLOR_0: 'color', WEIGHTS_0: 'skinWeight', JOINTS_0: 'skinIndex'};
/** What three.js calls an attribute of glTF. */
export const nameInThree = name => kNames[name] ?? name.toLowerCase().replace(/^texcoord_(\d+)$/, 'uv$1');

/** {positions, indices, attributes: {name: floats}} of a geometry; names: those of glTF that are wanted, if they are there. */
export function toBase({attributes, index}, names) {
  const present = names.filter(name => attributes[nameInThree(name)]);
  return {positions: toFloats(attributes.position), indices: index.array,
    attributes: Object.fromEntries(present.map(name => [name, toFloats(attributes[nameInThree(name)])]))};
}
