// Draco's own decoder, in Node.js and in browsers.

/** What Draco's own WebAssembly decoder makes of a stream: {positions, indices, attributes}. names: of the attributes with the ids 1, 2, ... */
export function decodeDraco(module, bytes, names = []) {
  const decoder = new module.Decoder(), buffer = new module.DecoderBuffer(), mesh = new module.Mesh();
  buffer.Init(new Int8Array(bytes.buffer, bytes.byteOffset, bytes.length), bytes.length);
  const status = decoder.DecodeBufferToMesh(buffer, mesh);
  if (!status.ok()) throw new Error(status.error_msg());
  const points = mesh.num_points(), faces = mesh.num_faces();
  const memory = module._malloc(12 * Math.max(points, faces));
  decoder.GetTrianglesUInt32Array(mesh, 12 * faces, memory);
  const indices = new Uint32Array(module.HEAPU8.buffer, memory, 3 * faces).slice();
  const floats = attribute => {
    const size = 4 * attribute.num_components() * points, at = module._malloc(size);
    decoder.GetAttributeDataArrayForAllPoints(mesh, attribute, module.DT_FLOAT32, size, at);
    const array = new Float32Array(module.HEAPU8.buffer, at, size / 4).slice();
    module._free(at);
    return array;
  };
  const positions = floats(decoder.GetAttribute(mesh, decoder.GetAttributeId(mesh, module.POSITION))), attributes = {};
  for (let i = 0; i < mesh.num_attributes() && names.length > 0; ++i) {
    const attribute = decoder.GetAttribute(mesh, i), name = names[attribute.unique_id() - 1];
    if (name !== undefined) attributes[name] = floats(attribute);
  }
  module._free(memory);
  for (const object of [mesh, buffer, decoder]) module.destroy(object);
  return {positions, indices, attributes};
}
