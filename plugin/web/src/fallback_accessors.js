// Accessors of fallbacks, as they are in a file.
const kComponentBytes = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4};
const kComponents = {SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT2: 4, MAT3: 9, MAT4: 16};

/** The bytes of a bufferView, as far as they are there. jsonDoc: of glTF-Transform. */
export function viewBytes({json, resources}, index) {
  const view = json.bufferViews[index], buffer = json.buffers[view.buffer];
  const resource = buffer.uri === undefined ? resources['@glb.bin'] : resources[buffer.uri];
  const begin = view.byteOffset ?? 0;
  return resource.subarray(begin, Math.min(begin + view.byteLength, resource.length));
}

/** {def: its JSON without bufferViews, bytes, sparse: {count, indices, values, componentType}}; bytes packed tightly, undefined where there are none. */
export function takeAccessor(jsonDoc, index) {
  const {bufferView, byteOffset, sparse, ...def} = jsonDoc.json.accessors[index], {componentType, type, count} = def;
  const accessor = {def, bytes: takeElements(jsonDoc, {bufferView, byteOffset, componentType, type, count})};
  if (sparse) {
    const {indices, values} = sparse;
    accessor.sparse = {count: sparse.count, indices: takeElements(jsonDoc, {...indices, type: 'SCALAR', count: sparse.count}),
      values: takeElements(jsonDoc, {...values, componentType, type, count: sparse.count}), componentType: indices.componentType};
  }
  return accessor;
}

function takeElements(jsonDoc, {bufferView, byteOffset = 0, componentType, type, count}) {
  if (bufferView === undefined) return undefined;
  const size = kComponentBytes[componentType] * kComponents[type], stride = jsonDoc.json.bufferViews[bufferView].byteStride ?? size;
  const from = viewBytes(jsonDoc, bufferView), bytes = new Uint8Array(4 * Math.ceil(size * count / 4));
  for (let i = 0; i < count; ++i) bytes.set(from.subarray(byteOffset + i * stride, byteOffset + i * stride + size), i * size);
  return bytes;
}

/** The object with every value changed. */
export const mapValues = (object, change) => Object.fromEntries(Object.entries(object).map(([name, value]) => [name, change(value)]));
/** All pieces of bytes of a primitive's accessors. */
export const piecesOf = ({accessors, indices, targets}) => [...[accessors, ...targets].flatMap(Object.values), indices]
  .flatMap(accessor => [accessor?.bytes, accessor?.sparse?.indices, accessor?.sparse?.values]).filter(Boolean);
