// What the tests share: the native command, golden streams, meshes and their comparison.
import {execFileSync} from 'node:child_process';
import {existsSync, mkdtempSync, readFileSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {Logger, NodeIO} from '@gltf-transform/core';
import {ALL_EXTENSIONS} from '@gltf-transform/extensions';
import draco3d from 'draco3d';
import {parseProgressive} from '../../dist/asset.js';
import {readHead} from '../../dist/glb.js';
import {LacertaMeshProgressive} from '../../dist/gltf_transform.js';

export {decodeDraco} from './decode_draco.mjs';

export const root = fileURLToPath(new URL('../../../../', import.meta.url));
export const dataFolder = process.env.LACERTA_TEST_DATA_DIR ?? join(root, '../shared/data');
export const golden = name => new Uint8Array(readFileSync(join(root, 'tests/golden/v1', name)));
export const example = name => join(root, 'gltf/LACERTA_mesh_progressive/examples', name);
export const goldenForms = ['draco_form.drc', 'custom_form.drc', 'custom_form_compact.drc'];
export const scratch = mkdtempSync(join(tmpdir(), 'lacerta-web-'));

const builds = [process.env.LACERTA_COMMAND, join(root, 'build/release/bin/lacerta'), join(root, 'build/bin/lacerta')];
const command = builds.find(path => path && existsSync(path));
if (!command) throw new Error('the native command is not built: cmake --preset release && cmake --build --preset release');
export const lacerta = (...args) => execFileSync(command, args, {stdio: ['ignore', 'pipe', 'pipe'], maxBuffer: 1 << 28});

/** A packed file: {json, progressive, stream: the first one, data: the bytes of all}. */
export function readAsset(path) {
  const bytes = new Uint8Array(readFileSync(path)), {json, binOffset} = readHead(bytes), progressive = parseProgressive(json);
  const view = json.bufferViews[progressive.data], begin = binOffset + (view.byteOffset ?? 0);
  return {json, progressive, stream: progressive.streams[0], data: bytes.slice(begin, begin + view.byteLength)};
}

/** The positions and indices of a level as the native command unpacks them. */
export function nativeLevel(path, level) {
  const out = join(scratch, 'native.ply');
  lacerta('unpack', path, '--level', String(level), '-o', out);
  return readPly(out);
}

/** The primitives of the first mesh of a level as the native command unpacks them: [{positions, indices, attributes: {name: Float32Array}}]. */
export async function nativeGroups(path, level) {
  const out = join(scratch, 'native.glb');
  lacerta('unpack', path, '--level', String(level), '-o', out);
  const document = await new NodeIO().setLogger(new Logger(Logger.Verbosity.SILENT)).read(out);
  return document.getRoot().listMeshes()[0].listPrimitives().map(primitive => ({
    positions: primitive.getAttribute('POSITION').getArray(), indices: Uint32Array.from(primitive.getIndices().getArray()),
    attributes: Object.fromEntries(primitive.listSemantics().filter(name => name !== 'POSITION').map(name => [name, primitive.getAttribute(name).getArray()])),
  }));
}

/** {positions, indices} of a binary PLY as the native command writes it. */
export function readPly(path) {
  const bytes = readFileSync(path);
  const end = bytes.indexOf('end_header\n') + 11;
  const header = bytes.subarray(0, end).toString('latin1');
  const vertices = Number(/element vertex (\d+)/.exec(header)[1]), faces = Number(/element face (\d+)/.exec(header)[1]);
  if (!header.includes('binary_little_endian') || !/property float x\nproperty float y\nproperty float z\nelement/.test(header)) throw new Error(header);
  const positions = new Float32Array(bytes.buffer.slice(bytes.byteOffset + end, bytes.byteOffset + end + 12 * vertices));
  const indices = new Uint32Array(3 * faces);
  for (let f = 0, at = end + 12 * vertices; f < faces; ++f, at += 13) {
    if (bytes[at] !== 3) throw new Error('not a triangle');
    for (let k = 0; k < 3; ++k) indices[3 * f + k] = bytes.readUInt32LE(at + 1 + 4 * k);
  }
  return {positions, indices};
}

/** The largest difference of two arrays of floats in units of the last place. */
export function largestUlps(a, b) {
  if (a.length !== b.length) return Infinity;
  const ordered = array => new Int32Array(array.buffer, array.byteOffset, array.length).map(bits => bits < 0 ? -(bits & 0x7fffffff) : bits);
  const x = ordered(a), y = ordered(b);
  let most = 0;
  for (let i = 0; i < x.length; ++i) most = Math.max(most, Math.abs(x[i] - y[i]));
  return most;
}

let draco;
export const dracoModule = async () => draco ??= await draco3d.createDecoderModule();

/** glTF-Transform with our extension and Draco. */
export async function progressiveIo() {
  return new NodeIO().setLogger(new Logger(Logger.Verbosity.ERROR)).registerExtensions([...ALL_EXTENSIONS, LacertaMeshProgressive])
    .registerDependencies({'draco3d.decoder': await dracoModule()});
}

/** A torus with bumps as OBJ, closed and smooth: something that becomes a stream of several levels in a second. */
export function writeTorus(path, around = 120, across = 60) {
  const lines = [];
  for (let i = 0; i < around; ++i) {
    for (let j = 0; j < across; ++j) {
      const u = 2 * Math.PI * i / around, v = 2 * Math.PI * j / across;
      const radius = 0.4 + 0.03 * Math.sin(5 * u) * Math.cos(3 * v);
      lines.push(`v ${(1 + radius * Math.cos(v)) * Math.cos(u)} ${(1 + radius * Math.cos(v)) * Math.sin(u)} ${radius * Math.sin(v)}`);
    }
  }
  const at = (i, j) => (i % around) * across + j % across + 1;
  for (let i = 0; i < around; ++i) {
    for (let j = 0; j < across; ++j) lines.push(`f ${at(i, j)} ${at(i + 1, j)} ${at(i + 1, j + 1)}`, `f ${at(i, j)} ${at(i + 1, j + 1)} ${at(i, j + 1)}`);
  }
  writeFileSync(path, lines.join('\n'));
}

/** A stream of `mesh` in the custom form and a GLB, packed once per run. */
const packed = new Map();
export function pack(name, mesh, ...options) {
  const key = [name, ...options].join(' ');
  if (!packed.has(key)) {
    const path = join(scratch, name);
    lacerta('pack', mesh, '-o', path, '--effort', 'fast', ...options);
    packed.set(key, path);
  }
  return packed.get(key);
}
