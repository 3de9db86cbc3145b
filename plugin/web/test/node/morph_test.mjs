// Morph targets: channels in a stream become what glTF and three.js want, at every level.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {join} from 'node:path';
import {before, test} from 'node:test';
import {Logger, NodeIO} from '@gltf-transform/core';
import * as three from 'three';
import {GLTFLoader} from 'three/addons/loaders/GLTFLoader.js';
import {baseParts} from '../../dist/asset.js';
import {Decoder, instantiate} from '../../dist/decoder.js';
import {readHead} from '../../dist/glb.js';
import {toLevel} from '../../dist/gltf_transform.js';
import {compile} from '../../dist/index.js';
import {Surface} from '../../dist/surface.js';
import {takeTargets, targetAttribute} from '../../dist/target_channels.js';
import {LacertaExtension} from '../../dist/three.js';
import {kTargets, writeMorphedTorus} from './morphed_torus.mjs';
import {decodeDraco, dracoModule, lacerta, largestUlps, pack, progressiveIo, readAsset, scratch} from './support.mjs';

let asset, io, stream, bytes;

before(async () => {
  const path = join(scratch, 'morphed_torus.glb');
  await writeMorphedTorus(path);
  asset = pack('morphed_torus_packed.glb', path, '--levels', 'always', '--psnr', '60');
  io = await progressiveIo();
  ({stream, data: bytes} = readAsset(asset));
});

// The offsets of each target as the native command unpacks them.
async function nativeTargets(path, level) {
  const out = join(scratch, 'native_morphed.glb');
  lacerta('unpack', path, '--level', String(level), '-o', out);
  return targetsOf(await new NodeIO().setLogger(new Logger(Logger.Verbosity.SILENT)).read(out));
}
const targetsOf = document => document.getRoot().listMeshes()[0].listPrimitives()[0].listTargets().map(target => target.getAttribute('POSITION').getArray());

// As a decoder of a pool, which tells how far it is after each piece.
class Telling extends Decoder {
  append(piece) {
    super.append(piece);
    return this.progress();
  }
}
const poolOf = async () => {
  const wasm = await instantiate(await compile());
  return {create: options => new Telling(wasm, options)};
};

// Draco of npm in the place of three's loader, whose workers Node has not got.
const dracoLoader = {
  async decodeDracoFile(buffer, resolve, ids, types, unused, reject) {
    try {
      const names = [];
      for (const [name, id] of Object.entries(ids)) names[id - 1] = name;
      const base = decodeDraco(await dracoModule(), new Uint8Array(buffer), names), geometry = new three.BufferGeometry();
      geometry.setAttribute('position', new three.BufferAttribute(base.positions, 3)).setIndex(new three.BufferAttribute(base.indices, 1));
      for (const [name, values] of Object.entries(base.attributes)) geometry.setAttribute(name, new three.BufferAttribute(values, 3 * values.length / base.positions.length));
      resolve(geometry);
    } catch (error) {
      reject(error);
    }
  },
  preload() { return this; },
};

test('channels become targets; those that are missing, or are not the primitive\'s, are refused', () => {
  assert.equal(targetAttribute('TARGETS_42_NORMAL'), 'NORMAL');
  assert.equal(targetAttribute('TARGET_42_NORMAL'), undefined);
  const given = {TARGETS_0_POSITION: Float32Array.from({length: 12}, (unused, i) => i), NORMAL: 1, TARGETS_2_POSITION: Float32Array.from([20, 21, 22, 23, 24, 25])};
  const {attributes, targets} = takeTargets(given, 2, 3);
  assert.deepEqual(attributes, {NORMAL: 1});
  assert.deepEqual(targets.map(target => [...target.POSITION]), [[0, 1, 2, 6, 7, 8], [3, 4, 5, 9, 10, 11], [20, 21, 22, 23, 24, 25]]);
  assert.deepEqual(takeTargets({NORMAL: 1}, 2, 0), {attributes: {NORMAL: 1}, targets: []});
  for (const count of [0, 2, 4]) assert.throws(() => takeTargets(given, 2, count), /targets/);
  assert.throws(() => takeTargets({TARGETS_1_POSITION: given.TARGETS_0_POSITION}, 2, 3), /targets/);
  assert.throws(() => takeTargets({}, 2, 1), /targets/);
});

test('toLevel gives the targets of the native command, and keeps weights and names', async () => {
  for (const level of [0, 1, stream.errors.length - 1]) {
    const document = await io.read(asset);
    await document.transform(toLevel({level, draco3d: await dracoModule()}));
    const mesh = document.getRoot().listMeshes()[0], found = targetsOf(document), native = await nativeTargets(asset, level);
    assert.deepEqual(mesh.getWeights(), [0.5, 0, 0]);
    assert.deepEqual(mesh.getExtras(), {targetNames: ['a', 'b', 'c']});
    assert.equal(found.length, kTargets);
    found.forEach((offsets, t) => assert.ok(largestUlps(offsets, native[t]) <= 4));
  }
});

test('glTF-Transform writes streams and the targets of their base back', async () => {
  const path = join(scratch, 'morphed_written.glb');
  await io.write(path, await io.read(asset));
  lacerta('validate', path);
  const [before, after] = [asset, path].map(name => readHead(new Uint8Array(readFileSync(name))).json);
  const describe = json => json.meshes[0].primitives[0].targets.map(({POSITION}) => {
    const {bufferView, byteOffset, sparse, ...rest} = json.accessors[POSITION];
    return {...rest, sparse: sparse?.count};
  });
  assert.deepEqual(describe(after), describe(before));
  assert.deepEqual(after.meshes[0].weights, [0.5, 0, 0]);
  const level = stream.errors.length - 1, [once, twice] = [await nativeTargets(asset, level), await nativeTargets(path, level)];
  assert.deepEqual(twice, once);
});

test('a surface of three.js gets morph attributes with every level', async () => {
  const [{begin, end}] = baseParts(stream), problems = [];
  const object = new three.Mesh(new three.BufferGeometry());
  const decodeBase = (part, names) => new Promise((resolve, reject) => dracoLoader.decodeDracoFile(part.buffer, resolve,
    {position: 0, ...Object.fromEntries(names.map((name, i) => [name.toLowerCase(), i + 1]))}, {}, undefined, reject));
  assert.equal(begin, 0);
  assert.ok(end > 0);
  const surface = new Surface({index: 0, stream, groups: [{objects: [object], hasFallback: true, attributes: {}, numTargets: kTargets}], decodeBase, pool: await poolOf(), three,
    onLevel: () => {}, onProblem: problem => problems.push(problem)});
  await surface.begin();
  stream.segments.forEach(({offset, length}, part) => surface.take(part, bytes.slice(offset, offset + length)));
  await surface.when(surface.lastPart).catch(() => {});
  assert.deepEqual(problems, []);
  const {geometry} = object, native = await nativeTargets(asset, surface.lastPart);
  assert.equal(geometry.morphTargetsRelative, true);
  assert.deepEqual(Object.keys(geometry.attributes), ['position']);
  geometry.morphAttributes.position.forEach(({array}, t) => assert.ok(largestUlps(array, native[t]) <= 4));
  assert.ok(geometry.boundingBox.max.x > stream.max[0] + 0.05 && geometry.boundingBox.max.x < stream.max[0] + 0.2);
  surface.dispose();
});

test('GLTFLoader shows the base with its targets, and they sharpen', async () => {
  const file = readFileSync(asset), loader = new GLTFLoader().setDRACOLoader(dracoLoader), problems = [], pool = await poolOf();
  loader.register(parser => new LacertaExtension(parser, {three, pool, onProblem: problem => problems.push(problem)}));
  const gltf = await loader.parseAsync(file.buffer.slice(file.byteOffset, file.byteOffset + file.length), '');
  let object;
  gltf.scene.traverse(child => { if (child.isMesh) object = child; });
  assert.equal(object.geometry.morphAttributes.position.length, kTargets);
  const model = gltf.userData.lacerta, surface = model.surfaces[0];
  surface.show(surface.lastPart);
  await surface.when(surface.lastPart);
  assert.deepEqual(problems, []);
  const native = await nativeTargets(asset, surface.lastPart);
  object.geometry.morphAttributes.position.forEach(({array}, t) => assert.ok(largestUlps(array, native[t]) <= 4));
  assert.deepEqual(object.morphTargetInfluences, [0.5, 0, 0]);
  surface.dispose();
});
