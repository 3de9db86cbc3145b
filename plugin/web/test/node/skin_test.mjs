// Skinned surfaces: weights of joints in a stream become what glTF and three.js want, at every level.
import assert from 'node:assert/strict';
import {join} from 'node:path';
import {before, test} from 'node:test';
import {Document, NodeIO} from '@gltf-transform/core';
import * as three from 'three';
import {baseParts, parseProgressive} from '../../dist/asset.js';
import {Decoder, instantiate} from '../../dist/decoder.js';
import {toLevel} from '../../dist/gltf_transform.js';
import {compile} from '../../dist/index.js';
import {baseNames, gatherWeights, spreadWeights} from '../../dist/joint_weights.js';
import {Surface} from '../../dist/surface.js';
import {decodeDraco, dracoModule, largestUlps, nativeGroups, pack, progressiveIo, readAsset, scratch} from './support.mjs';

// A torus with bumps that three of four joints move, the first of which is not used.
async function writeSkinnedTorus(path, around = 160, across = 80) {
  const document = new Document(), buffer = document.createBuffer(), positions = [], indices = [], joints = [], weights = [];
  for (let i = 0; i < around; ++i) {
    for (let j = 0; j < across; ++j) {
      const u = 2 * Math.PI * i / around, v = 2 * Math.PI * j / across, radius = 0.4 + 0.03 * Math.sin(5 * u) * Math.cos(3 * v);
      positions.push((1 + radius * Math.cos(v)) * Math.cos(u), (1 + radius * Math.cos(v)) * Math.sin(u), radius * Math.sin(v));
      const right = 0.5 + 0.5 * Math.cos(u), top = 0.25 + 0.25 * Math.sin(u);
      joints.push(1, 2, 3, 0);
      weights.push(right * (1 - top), (1 - right) * (1 - top), top, 0);
      const a = i * across + j, b = (i + 1) % around * across + j, next = (j + 1) % across - j;
      indices.push(a, b, b + next, a, b + next, a + next);
    }
  }
  const accessor = (type, array) => document.createAccessor().setType(type).setArray(array).setBuffer(buffer);
  const primitive = document.createPrimitive().setIndices(accessor('SCALAR', Uint32Array.from(indices))).setAttribute('POSITION', accessor('VEC3', Float32Array.from(positions)))
    .setAttribute('JOINTS_0', accessor('VEC4', Uint8Array.from(joints))).setAttribute('WEIGHTS_0', accessor('VEC4', Float32Array.from(weights)));
  const nodes = [[0, 0], [1, 0], [-1, 0], [0, 1]].map(([x, y]) => document.createNode().setTranslation([x, y, 0]));
  const binds = nodes.flatMap(node => [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, ...node.getTranslation().map(x => -x), 1]);
  const skin = document.createSkin().setInverseBindMatrices(accessor('MAT4', Float32Array.from(binds)));
  for (const node of nodes) skin.addJoint(node);
  const shown = document.createNode().setMesh(document.createMesh().addPrimitive(primitive)).setSkin(skin);
  document.createScene().addChild(shown);
  for (const node of nodes) document.getRoot().listScenes()[0].addChild(node);
  await new NodeIO().write(path, document);
}

let asset, io, stream, bytes;

// As a decoder of a pool, which tells how far it is after each piece.
class Telling extends Decoder {
  append(piece) {
    super.append(piece);
    return this.progress();
  }
}

before(async () => {
  const path = join(scratch, 'skinned_torus.glb');
  await writeSkinnedTorus(path);
  asset = pack('skinned_torus_packed.glb', path, '--levels', 'always', '--psnr', '60');
  io = await progressiveIo();
  ({stream, data: bytes} = readAsset(asset));
});

test('the four largest weights are kept, with the sum 1', () => {
  const joints = [3, 5, 8, 13, 300], spread = Float32Array.from([0.1, 0.2, 0.3, 0.2, 0.2, 0, -1, 0, 0, 0]);
  const {JOINTS_0, WEIGHTS_0} = gatherWeights(joints, {WEIGHTS_0: spread});
  assert.deepEqual(JOINTS_0, Uint16Array.from([8, 5, 13, 300, 3, 0, 0, 0]));
  assert.ok(Math.abs(WEIGHTS_0[0] - 1 / 3) < 1e-6 && Math.abs(WEIGHTS_0[3] - 0.2 / 0.9) < 1e-6);
  assert.deepEqual([...WEIGHTS_0.subarray(4)], [1, 0, 0, 0]);
  const back = spreadWeights(joints, {JOINTS_0, WEIGHTS_0, NORMAL: 1});
  assert.equal(back.NORMAL, 1);
  assert.ok(back.WEIGHTS_0[0] === 0 && back.WEIGHTS_0[2] === WEIGHTS_0[0] && back.WEIGHTS_0[5] === 1);
  assert.throws(() => spreadWeights([3, 5], {JOINTS_0, WEIGHTS_0}), /joint 8/);
});

test('a table that names a joint twice, or no weights, is refused', () => {
  const of = joints => ({bufferViews: [{}], extensions: {LACERTA_mesh_progressive: {version: 1, data: 0, segments: {stream: [0], byteLength: [4]},
    streams: [{vertexCounts: [3], triangleCounts: [1], errors: [0], min: [0, 0, 0], max: [1, 1, 1], baseLengths: [4], ...joints}]}}});
  assert.deepEqual(parseProgressive(of({attributes: ['WEIGHTS_0'], joints: [4, 2]})).streams[0].joints, [4, 2]);
  for (const joints of [[4, 4], [], [70000], ['4']]) assert.throws(() => parseProgressive(of({attributes: ['WEIGHTS_0'], joints})), /joints/);
  assert.throws(() => parseProgressive(of({attributes: ['NORMAL'], joints: [0]})), /joints/);
});

test('toLevel gives the joints and weights of the native command, and keeps the skin', async () => {
  assert.deepEqual(stream.joints, [1, 2, 3]);
  for (const level of [0, 1, stream.errors.length - 1]) {
    const document = await io.read(asset);
    await document.transform(toLevel({level, draco3d: await dracoModule()}));
    const [native] = await nativeGroups(asset, level), node = document.getRoot().listNodes().find(node => node.getMesh());
    const primitive = node.getMesh().listPrimitives()[0];
    assert.equal(node.getSkin().listJoints().length, 4);
    assert.deepEqual(primitive.getAttribute('JOINTS_0').getArray(), native.attributes.JOINTS_0);
    assert.ok(largestUlps(primitive.getAttribute('WEIGHTS_0').getArray(), native.attributes.WEIGHTS_0) <= 4);
  }
});

test('a surface of three.js gets skinIndex and skinWeight with every level', async () => {
  const wasm = await instantiate(await compile()), [{begin, end}] = baseParts(stream), base = decodeDraco(await dracoModule(), bytes.slice(begin, end), baseNames(stream));
  const geometry = new three.BufferGeometry().setAttribute('position', new three.BufferAttribute(base.positions, 3)).setIndex(new three.BufferAttribute(base.indices, 1));
  geometry.setAttribute('skinIndex', new three.BufferAttribute(Uint8Array.from(base.attributes.JOINTS_0), 4));
  geometry.setAttribute('skinWeight', new three.BufferAttribute(base.attributes.WEIGHTS_0, 4));
  const object = new three.SkinnedMesh(geometry), problems = [];
  const surface = new Surface({index: 0, stream, groups: [{objects: [object], hasFallback: true, attributes: {}}], pool: {create: options => new Telling(wasm, options)}, three,
    onLevel: () => {}, onProblem: problem => problems.push(problem)});
  await surface.begin();
  stream.segments.forEach(({offset, length}, part) => surface.take(part, bytes.subarray(offset, offset + length)));
  await surface.when(surface.lastPart).catch(() => {});
  assert.deepEqual(problems, []);
  const {skinIndex, skinWeight} = object.geometry.attributes, [native] = await nativeGroups(asset, surface.lastPart);
  assert.deepEqual(skinIndex.array, native.attributes.JOINTS_0);
  assert.ok(largestUlps(skinWeight.array, native.attributes.WEIGHTS_0) <= 4);
  surface.dispose();
});
