// The extension for glTF-Transform: what it reads it writes, through copy and optimize, and it decodes to a level.
import assert from 'node:assert/strict';
import {readFileSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {before, test} from 'node:test';
import {Logger, NodeIO} from '@gltf-transform/core';
import {ALL_EXTENSIONS} from '@gltf-transform/extensions';
import {dedup, flatten, join as joinMeshes, prune, quantize, simplify, weld} from '@gltf-transform/functions';
import {toLevel} from '../../dist/gltf_transform.js';
import {dracoModule, lacerta, largestUlps, nativeLevel, pack, progressiveIo, readAsset, scratch, writeTorus} from './support.mjs';

const mesh = join(scratch, 'transform_torus.obj');
const fallbacks = {draco: [], plain: ['--fallback', 'plain'], none: ['--fallback', 'none', '--form', 'custom']};
let io, assets;

before(async () => {
  writeTorus(mesh);
  io = await progressiveIo();
  assets = Object.fromEntries(Object.entries(fallbacks).map(([name, options]) => [name, pack(`transform_${name}.glb`, mesh, '--levels', 'always', ...options)]));
});

// The command finds the asset valid, the stream is what it was, and no fallback was taken for edited.
function assertKept(before, after) {
  const {data, stream} = readAsset(before);
  assert.deepEqual(readAsset(after).data, data);
  const report = JSON.parse(lacerta('validate', after, '--json').toString());
  assert.deepEqual(JSON.stringify(report).match(/"(?:error|severity)":"error"/g), null, JSON.stringify(report));
  const last = stream.errors.length - 1;
  assert.ok(last >= 2);
  assert.deepEqual(nativeLevel(after, last), nativeLevel(before, last));
}

for (const name of Object.keys(fallbacks)) {
  test(`copy keeps the stream and the fallback "${name}"`, async () => {
    const out = join(scratch, `copied_${name}.glb`);
    await io.write(out, await io.read(assets[name]));
    assertKept(assets[name], out);
  });

  test(`the transforms of optimize keep the stream and the fallback "${name}"`, async () => {
    const out = join(scratch, `optimized_${name}.glb`), document = await io.read(assets[name]);
    document.getRoot().listNodes()[0].setScale([1, 1, 1]).setName('renamed');
    await document.transform(dedup(), flatten(), joinMeshes(), weld(), simplify({ratio: 0.5, error: 0.01, simplifier: {ready: Promise.resolve()}}), quantize(), prune());
    await io.write(out, document);
    assertKept(assets[name], out);
    assert.equal(readAsset(out).json.nodes[0].name, 'renamed');
  });
}

test('toLevel makes ordinary meshes, vertex for vertex as the native command does', async () => {
  for (const name of Object.keys(fallbacks)) {
    for (const level of [0, 1, 2]) {
      const document = await io.read(assets[name]);
      await document.transform(toLevel({level, draco3d: await dracoModule()}));
      const [primitive] = document.getRoot().listMeshes()[0].listPrimitives(), native = nativeLevel(assets[name], level);
      assert.ok(largestUlps(primitive.getAttribute('POSITION').getArray(), native.positions) <= 1);
      assert.deepEqual(primitive.getIndices().getArray(), native.indices);
      const glb = await io.writeBinary(document);
      assert.ok(!new TextDecoder().decode(glb.subarray(0, 2000)).includes('LACERTA'));
    }
  }
});

test('without the extension the fallback still shows', async () => {
  const plainIo = new NodeIO().setLogger(new Logger(Logger.Verbosity.SILENT)).registerExtensions(ALL_EXTENSIONS).registerDependencies({'draco3d.decoder': await dracoModule()});
  for (const name of ['draco', 'plain']) {
    const document = await plainIo.read(assets[name]);
    const triangles = document.getRoot().listMeshes()[0].listPrimitives()[0].getIndices().getCount() / 3;
    assert.equal(triangles, readAsset(assets[name]).stream.triangleCounts[0]);
  }
});

test('a trimmed asset stays trimmed', async () => {
  const trimmed = join(scratch, 'trimmed.glb'), out = join(scratch, 'trimmed_copy.glb');
  lacerta('trim', assets.draco, '--level', '1', '-o', trimmed);
  await io.write(out, await io.read(trimmed));
  assert.deepEqual(readAsset(out).data, readAsset(trimmed).data);
  const document = await io.read(out);
  await document.transform(toLevel({draco3d: await dracoModule()}));
  assert.deepEqual(document.getRoot().listMeshes()[0].listPrimitives()[0].getIndices().getArray(), nativeLevel(trimmed, 2).indices);
});

test('a stream that contradicts itself is refused by name', async () => {
  const broken = join(scratch, 'broken.glb'), bytes = readFileSync(assets.draco);
  writeFileSync(broken, Buffer.from(bytes.toString('latin1').replace('"version":1', '"version":7'), 'latin1'));
  await assert.rejects(io.read(broken), /LACERTA_mesh_progressive: version 7 is not known/);
});
