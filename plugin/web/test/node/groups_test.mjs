// Streams with attributes and groups of faces: as native, group by group, and cut short.
import assert from 'node:assert/strict';
import {join} from 'node:path';
import {test} from 'node:test';
import {Worker} from 'node:worker_threads';
import {baseParts, parseProgressive, progressivePrimitive} from '../../dist/asset.js';
import {toLevel} from '../../dist/gltf_transform.js';
import {LacertaError, createDecoder, createPool} from '../../dist/index.js';
import {decodeDraco, dracoModule, example, lacerta, largestUlps, nativeGroups, progressiveIo, readAsset, scratch} from './support.mjs';

const asset = example('torus_with_attributes.glb');

const {json, progressive, stream, data} = readAsset(asset);
const finest = stream.vertexCounts.length - 1;
const options = {baseLengths: stream.baseLengths, attributes: stream.attributes};
const basesOf = async section => {
  const module = await dracoModule();
  return baseParts(stream).map(({begin, end}) => decodeDraco(module, section.subarray(begin, end), stream.attributes));
};

async function decode(bytes) {
  const decoder = await createDecoder(options);
  decoder.append(bytes);
  assert.ok(decoder.needsBase);
  assert.deepEqual(decoder.baseSection(), data.subarray(0, stream.segments[0].length));
  for (const [group, base] of (await basesOf(decoder.baseSection())).entries()) decoder.setBaseGroup(group, base);
  return decoder;
}

function assertNear(mesh, native) {
  assert.deepEqual(mesh.indices, native.indices);
  assert.ok(largestUlps(mesh.positions, native.positions) <= 1);
  assert.deepEqual(Object.keys(mesh.attributes).sort(), Object.keys(native.attributes).sort());
  for (const name of Object.keys(native.attributes)) assert.ok(largestUlps(mesh.attributes[name], native.attributes[name]) <= 1, name);
}

test('every level of every group is that of the native command, within one ulp', async () => {
  const decoder = await decode(data);
  assert.equal(decoder.progress().level, finest);
  assert.equal(decoder.progress().numGroups, 2);
  assert.ok(decoder.progress().isComplete);
  assert.ok(finest >= 2);
  for (const level of [finest, 1, 0, finest]) {
    const native = await nativeGroups(asset, level), meshes = native.map((unused, group) => decoder.read(level, {group}));
    native.forEach((expected, group) => assertNear(meshes[group], expected));
    assert.deepEqual(Object.keys(meshes[0].attributes).sort(), ['NORMAL', 'TEXCOORD_0']);
    assert.equal(meshes.reduce((sum, mesh) => sum + mesh.positions.length / 3, 0), stream.vertexCounts[level]);
    const all = decoder.read(level);
    assert.equal(all.indices.length, 3 * stream.triangleCounts[level]);
    assert.deepEqual(all.attributes.TEXCOORD_0.subarray(0, meshes[0].attributes.TEXCOORD_0.length), meshes[0].attributes.TEXCOORD_0);
  }
  decoder.dispose();
});

test('no level has a crack between the groups', async () => {
  const decoder = await decode(data);
  for (let level = 0; level <= finest; ++level) {
    const borders = [0, 1].map(group => {
      const {positions, indices} = decoder.read(level, {group}), at = v => positions.subarray(3 * v, 3 * v + 3).join(), once = new Set();
      for (let i = 0; i < indices.length; ++i) {
        const a = at(indices[i]), b = at(indices[i % 3 === 2 ? i - 2 : i + 1]), back = `${b} ${a}`;
        if (!once.delete(back)) once.add(`${a} ${b}`);
      }
      return once;  // directed edges that the group has on one side only
    });
    assert.equal(borders[0].size, borders[1].size);
    assert.ok(borders[0].size >= 2 * 3 << level);  // two circles of three edges or more, split
    for (const edge of borders[0]) assert.ok(borders[1].has(edge.split(' ').reverse().join(' ')), edge);
  }
});

test('bytes cut short leave the level before, and other names leave the base', async () => {
  const ends = stream.segments.map(({offset, length}) => offset + length);
  for (const [bytes, level] of [[data.subarray(0, ends[0]), 0], [data.subarray(0, ends[1] - 1), 0], [data.subarray(0, ends[2] - 1), 1]]) {
    const decoder = await decode(bytes);
    decoder.finish();
    assert.equal(decoder.progress().level, level);
    const native = await nativeGroups(asset, level);
    native.forEach((expected, group) => assertNear(decoder.read(level, {group}), expected));
  }
  const renamed = await createDecoder({...options, attributes: ['TEXCOORD_0', 'TANGENT']});
  const bases = await basesOf(data);
  renamed.setBaseGroup(0, bases[0]);
  renamed.setBaseGroup(1, bases[1]);
  assert.throws(() => renamed.append(data), error => error instanceof LacertaError && error.code === 2);
  assert.equal(renamed.progress().level, 0);
});

test('a worker hands every group over', async () => {
  const pool = await createPool({size: 1, createWorker: () => new Worker(new URL('../../dist/worker.js', import.meta.url))});
  const decoder = pool.create(options);
  for (const [group, base] of (await basesOf(data)).entries()) await decoder.setBaseGroup(group, base);
  assert.equal((await decoder.append(data.slice())).level, finest);
  const native = await nativeGroups(asset, finest);
  for (const group of [0, 1]) assertNear(await decoder.read(finest, {group}), native[group]);
  pool.dispose();
});

test('glTF-Transform keeps the groups, and makes ordinary primitives of a level', async () => {
  const io = await progressiveIo();
  const copy = join(scratch, 'groups_copy.glb');
  await io.write(copy, await io.read(asset));
  assert.deepEqual(readAsset(copy).data, data);
  assert.ok(!/"(?:error|severity)":"error"/.test(lacerta('validate', copy, '--json').toString()));
  assert.deepEqual(await nativeGroups(copy, 2), await nativeGroups(asset, 2));
  for (let level = 0; level <= finest; ++level) {
    const document = await io.read(copy);
    await document.transform(toLevel({level, draco3d: await dracoModule()}));
    const primitives = document.getRoot().listMeshes()[0].listPrimitives(), native = await nativeGroups(asset, level);
    assert.equal(primitives.length, 2);
    primitives.forEach((primitive, group) => {
      const attributes = Object.fromEntries(['NORMAL', 'TEXCOORD_0'].map(name => [name, primitive.getAttribute(name).getArray()]));
      assertNear({positions: primitive.getAttribute('POSITION').getArray(), indices: primitive.getIndices().getArray(), attributes}, native[group]);
    });
  }
});

test('groups that contradict themselves are refused by name', () => {
  const primitive = json.meshes[0].primitives[1];
  assert.deepEqual(progressivePrimitive(primitive, progressive), {stream: 0, group: 1});
  const other = structuredClone(json);
  other.meshes[0].primitives[1].extensions.LACERTA_mesh_progressive.group = 2;
  assert.throws(() => progressivePrimitive(other.meshes[0].primitives[1], progressive), /group 2 of stream 0 does not exist/);
  other.extensions.LACERTA_mesh_progressive.streams[0].baseLengths[0] += 1;
  assert.throws(() => parseProgressive(other), /the attributes or groups of stream 0 are malformed/);
});
