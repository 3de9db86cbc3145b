// The Draco file that stands beside a packed one: the whole input mesh in KHR_draco_mesh_compression, with the fewest bits whose rounding is no
// larger than the error of the packed file's finest level; its texture coordinates and picture, where it has them, likewise.
import {writeFileSync} from 'node:fs';
import {join} from 'node:path';
import draco3d from 'draco3d';
import {formatGlb} from '../../src/glb.js';
import {lacerta, readAsset, readPly, scratch} from './support.mjs';

async function encode({positions, indices, texcoords}, bits, texcoordBits) {
  const module = await draco3d.createEncoderModule();
  const builder = new module.MeshBuilder(), encoder = new module.Encoder(), mesh = new module.Mesh(), out = new module.DracoInt8Array();
  builder.AddFacesToMesh(mesh, indices.length / 3, indices);
  const attributes = {POSITION: builder.AddFloatAttributeToMesh(mesh, module.POSITION, positions.length / 3, 3, positions)};
  if (texcoords) attributes.TEXCOORD_0 = builder.AddFloatAttributeToMesh(mesh, module.TEX_COORD, texcoords.length / 2, 2, texcoords);
  encoder.SetSpeedOptions(0, 0);
  encoder.SetAttributeQuantization(module.POSITION, bits);
  encoder.SetAttributeQuantization(module.TEX_COORD, texcoordBits);
  const length = encoder.EncodeMeshToDracoBuffer(mesh, out);
  const bytes = Uint8Array.from({length}, (unused, i) => out.GetValue(i));
  for (const object of [builder, encoder, mesh, out]) module.destroy(object);
  return {bytes, attributes};
}

/** {positions, indices} of a file of any format that the command reads. */
export function readMesh(file) {
  const ply = join(scratch, 'mesh.ply'), plain = join(scratch, 'mesh_plain.glb');
  lacerta('pack', file, '-o', plain, '--levels', '0', '--psnr', '140', '--effort', 'fast');
  lacerta('unpack', plain, '-o', ply);
  return readPly(ply);
}

/** {min, max} of each of `size` components. */
export function boundsOf(values, size) {
  const min = Array(size).fill(Infinity), max = Array(size).fill(-Infinity);
  values.forEach((x, i) => {
    min[i % size] = Math.min(min[i % size], x);
    max[i % size] = Math.max(max[i % size], x);
  });
  return {min, max};
}

// The fewest bits over the longest side of the bounds whose rounding is at most `error`, root mean square of `size` components together.
const bitsFor = ({min, max}, error, size) => Math.ceil(Math.log2(1 + Math.max(...max.map((x, axis) => x - min[axis])) * Math.sqrt(size / 12) / error));

/**
 * Writes NAME.draco.glb beside the packed NAME.glb; returns {path, bits}. mesh: {positions, indices}, and of a textured one texcoords (in 0..1) and
 * image, a PNG.
 */
export async function writeDracoTwin(mesh, packed) {
  const {positions, indices, texcoords, image} = mesh, {min, max} = boundsOf(positions, 3);
  const bits = bitsFor({min, max}, readAsset(packed).stream.errors.at(-1), 1);  // of positions only what is across the surface counts
  const {bytes, attributes} = await encode(mesh, bits, texcoords ? bitsFor(boundsOf(texcoords, 2), 1 / 1024, 2) : 1);  // a texel, as the packed one has it
  const accessor = (componentType, count, type, bounds) => ({componentType, count, type, ...bounds});
  const accessors = [accessor(5126, positions.length / 3, 'VEC3', {min, max}), accessor(5125, indices.length, 'SCALAR')];
  const draco = {KHR_draco_mesh_compression: {bufferView: 0, attributes}};
  const primitive = {attributes: {POSITION: 0}, indices: 1, extensions: draco};
  const body = Buffer.concat([bytes, Buffer.alloc(-bytes.length & 3), image ?? Buffer.alloc(0)]);
  const json = {asset: {version: '2.0'}, scene: 0, scenes: [{nodes: [0]}], nodes: [{mesh: 0}],
    extensionsUsed: Object.keys(draco), extensionsRequired: Object.keys(draco), buffers: [{byteLength: body.length}],
    bufferViews: [{buffer: 0, byteLength: bytes.length}], accessors, meshes: [{primitives: [primitive]}]};
  if (texcoords) {
    primitive.attributes.TEXCOORD_0 = accessors.push(accessor(5126, texcoords.length / 2, 'VEC2')) - 1;
    primitive.material = 0;
    json.bufferViews.push({buffer: 0, byteOffset: body.length - image.length, byteLength: image.length});
    Object.assign(json, {images: [{bufferView: 1, mimeType: 'image/png'}], textures: [{source: 0}], materials: [{pbrMetallicRoughness: {baseColorTexture: {index: 0}}}]});
  }
  const path = packed.replace(/\.glb$/, '.draco.glb');
  writeFileSync(path, Buffer.from(formatGlb(json, body)));
  return {path, bits};
}
