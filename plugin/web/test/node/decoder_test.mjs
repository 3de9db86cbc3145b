// The decoder in WebAssembly: as native, whole, in pieces, cut short, damaged, misused.
import assert from 'node:assert/strict';
import {existsSync, readFileSync} from 'node:fs';
import {join} from 'node:path';
import {test} from 'node:test';
import {Decoder, LacertaError, compile, createDecoder} from '../../dist/index.js';
import {loadBinary} from '../../dist/binary_inline.js';
import {instantiate} from '../../dist/decoder.js';
import {dataFolder, decodeDraco, dracoModule, golden, goldenForms, largestUlps, nativeLevel, pack, root, scratch, writeTorus} from './support.mjs';

// A base in Draco form is decoded by draco3d, as a page would do it.
async function decodeAll(bytes) {
  const decoder = await createDecoder();
  decoder.append(bytes);
  if (decoder.needsBase) {
    const base = decodeDraco(await dracoModule(), decoder.baseSection());
    decoder.setBase(base.positions, base.indices);
  }
  decoder.finish();
  return decoder;
}

function assertAsNative(decoder, path) {
  const {level, isComplete} = decoder.progress();
  assert.ok(isComplete);
  for (let shown = level; shown >= 0; --shown) {
    const native = nativeLevel(path, shown), mesh = decoder.read(shown, {normals: true});
    assert.deepEqual(mesh.indices, native.indices, `triangles of level ${shown}`);
    assert.ok(largestUlps(mesh.positions, native.positions) <= 1, `positions of level ${shown}: ${largestUlps(mesh.positions, native.positions)} ulp`);
    for (let i = 0; i < mesh.normals.length; i += 3) assert.ok(Math.abs(Math.hypot(...mesh.normals.subarray(i, i + 3)) - 1) < 1e-6);
  }
}

for (const form of goldenForms) {
  test(`${form} decodes as native`, async () => {
    const decoder = await decodeAll(golden(form));
    assert.equal(decoder.progress().level, 2);
    assertAsNative(decoder, join(root, 'tests/golden/v1', form));
    decoder.dispose();
  });
}

test('a packed torus decodes as native, in both forms, with quality layers too', async () => {
  const mesh = join(scratch, 'torus.obj');
  writeTorus(mesh);
  for (const options of [['--form', 'custom'], ['--form', 'draco'], ['--form', 'custom', '--quality-layers', '2']]) {
    const path = pack(`torus_${options.join('')}.drc`, mesh, '--levels', 'always', ...options);
    const decoder = await decodeAll(new Uint8Array(readFileSync(path)));
    assert.ok(decoder.progress().level >= 2);
    assert.equal(decoder.progress().hasLayers, options.includes('2'));
    assertAsNative(decoder, path);
    decoder.dispose();
  }
});

for (const name of ['horse', 'bunny_zipper', 'fandisk']) {
  const mesh = join(dataFolder, `${name}.ply`);
  test(`${name} decodes as native`, {skip: !existsSync(mesh) && `no ${name}.ply`}, async () => {
    const path = pack(`${name}.drc`, mesh, '--form', 'custom', '--levels', 'always');
    const decoder = await decodeAll(new Uint8Array(readFileSync(path)));
    assertAsNative(decoder, path);
    decoder.dispose();
  });
}

test('bytes may arrive one by one', async () => {
  const bytes = golden('custom_form_compact.drc'), decoder = await createDecoder();
  const first = [];
  for (let i = 0, before = -1; i < bytes.length; ++i) {
    const level = decoder.append(bytes.subarray(i, i + 1));
    assert.ok(level === before || level === before + 1);
    if (level !== before) first.push(i + 1);
    before = level;
  }
  assert.equal(first.length, 3);
  assert.equal(first[2], decoder.progress().bytesUsed);
  assert.ok(first[0] < first[1] && first[1] < first[2]);
});

test('a damaged segment leaves the levels before it, and says so', async () => {
  const bytes = golden('custom_form_compact.drc');
  bytes[bytes.length - 1] ^= 1;
  const decoder = await createDecoder();
  assert.throws(() => decoder.append(bytes), error => error instanceof LacertaError && error.code === 2 && /damaged/.test(error.message));
  assert.equal(decoder.progress().level, 1);
  assert.equal(decoder.read(1).indices.length, 3 * 240);
});

test('every flipped byte is refused or harmless, and the instance lives on', async () => {
  const wasm = await instantiate(await compile()), bytes = golden('custom_form_compact.drc');
  let refused = 0;
  for (let i = 0; i < bytes.length; ++i) {
    const damaged = bytes.slice();
    damaged[i] ^= 0x55;
    const decoder = new Decoder(wasm, {maxVertices: 100_000, maxTriangles: 200_000});
    try {
      decoder.append(damaged);
      decoder.finish();
    } catch (error) {
      assert.ok(error instanceof LacertaError, String(error));
      ++refused;
    }
    decoder.dispose();
  }
  assert.ok(refused > bytes.length / 2 && refused <= bytes.length, `${refused} of ${bytes.length}`);
  assert.ok(wasm.memory.buffer.byteLength < 64 << 20);
});

test('100 decoders in turn take no more memory than one', async () => {
  const wasm = await instantiate(await compile()), bytes = golden('custom_form_compact.drc');
  let first = 0;
  for (let i = 0; i < 100; ++i) {
    const decoder = new Decoder(wasm);
    decoder.append(bytes);
    decoder.read(2, {normals: true});
    decoder.dispose();
    if (i === 0) first = wasm.memory.buffer.byteLength;
  }
  assert.equal(wasm.memory.buffer.byteLength, first);
});

test('the inline build holds the same bytes as the file', async () => {
  const file = readFileSync(join(root, 'plugin/web/dist/lacerta.wasm'));
  assert.deepEqual(Buffer.from(await loadBinary()), file);
});

test('misuse is named', async () => {
  const decoder = await createDecoder();
  assert.throws(() => decoder.read(0), /level 0: invalid argument/);
  assert.throws(() => decoder.append(new TextEncoder().encode('no stream')), {code: 2});
  const limited = await createDecoder({maxTriangles: 100});
  assert.throws(() => limited.append(golden('custom_form_compact.drc')), {code: 4});
  assert.equal(limited.progress().level, 0);
});
