// The Draco file that stands beside a packed one: the whole input mesh in KHR_draco_mesh_compression, with the fewest bits whose rounding is no
// larger than the error of the packed file's finest level.
import {writeFileSync} from 'node:fs';
import {join} from 'node:path';
import draco3d from 'draco3d';
import {formatGlb} from '../../src/glb.js';
import {lacerta, readAsset, readPly, scratch} from './support.mjs';

async function encode({positions, indices}, bits) {
  const module = await draco3d.createEncoderModule();
  const builder = new module.MeshBuilder(), encoder = new module.Encoder(), mesh = new module.Mesh(), out = new module.DracoInt8Array();
  builder.AddFacesToMesh(mesh, indices.length / 3, indices);
  const id = builder.AddFloatAttributeToMesh(mesh, module.POSITION, positions.length / 3, 3, positions);
  encoder.SetSpeedOptions(0, 0);
  encoder.SetAttributeQuantization(module.POSITION, bits);
  const length = encoder.EncodeMeshToDracoBuffer(mesh, out);
  const bytes = Uint8Array.from({length}, (unused, i) => out.GetValue(i));
  for (const object of [builder, encoder, mesh, out]) module.destroy(object);
  return {bytes, id};
}

/** Writes NAME.draco.glb beside the packed NAME.glb; returns {path, bits}. */
export async function writeDracoTwin(mesh, packed) {
  const ply = join(scratch, 'twin.ply'), plain = join(scratch, 'twin_plain.glb');
  lacerta('pack', mesh, '-o', plain, '--levels', '0', '--psnr', '140', '--effort', 'fast');
  lacerta('unpack', plain, '-o', ply);
  const {positions, indices} = readPly(ply);
  const {stream} = readAsset(packed);
  const min = [0, 1, 2].map(axis => positions.reduce((least, x, i) => i % 3 === axis ? Math.min(least, x) : least, Infinity));
  const max = [0, 1, 2].map(axis => positions.reduce((most, x, i) => i % 3 === axis ? Math.max(most, x) : most, -Infinity));
  const range = Math.max(...max.map((x, axis) => x - min[axis]));
  const bits = Math.ceil(Math.log2(1 + range / (stream.errors.at(-1) * Math.sqrt(12))));
  const {bytes, id} = await encode({positions, indices}, bits);
  const draco = {KHR_draco_mesh_compression: {bufferView: 0, attributes: {POSITION: id}}};
  const json = {asset: {version: '2.0'}, scene: 0, scenes: [{nodes: [0]}], nodes: [{mesh: 0}],
    extensionsUsed: Object.keys(draco), extensionsRequired: Object.keys(draco), buffers: [{byteLength: bytes.length}],
    bufferViews: [{buffer: 0, byteLength: bytes.length}],
    accessors: [{componentType: 5126, count: positions.length / 3, type: 'VEC3', min, max}, {componentType: 5125, count: indices.length, type: 'SCALAR'}],
    meshes: [{primitives: [{attributes: {POSITION: 0}, indices: 1, extensions: draco}]}]};
  const path = packed.replace(/\.glb$/, '.draco.glb');
  writeFileSync(path, Buffer.from(formatGlb(json, bytes)));
  return {path, bits};
}
