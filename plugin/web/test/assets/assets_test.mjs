// Every asset of the data folder, packed at default, as stock three.js and stock glTF-Transform open it: npm run test:assets. Packs what out/packed does not have
// yet, some minutes. LACERTA_ASSETS=NAME,NAME: these alone.
import assert from 'node:assert/strict';
import {existsSync, mkdirSync, readFileSync, readdirSync} from 'node:fs';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {fileURLToPath} from 'node:url';
import {Logger, NodeIO, getBounds} from '@gltf-transform/core';
import {ALL_EXTENSIONS} from '@gltf-transform/extensions';
import {viewerRoots} from '../../../../samples/viewer/serve.mjs';
import {openPage} from '../browser/support.mjs';
import {readHead} from '../../dist/glb.js';
import {dataFolder, dracoModule, lacerta, root} from '../node/support.mjs';

// Beyond the default ones, of which few have levels: with levels always, whose bases are what stock readers show.
const withLevels = ['WaterBottle'];
const packed = process.env.LACERTA_PACKED ?? join(root, 'out/packed');
const wanted = process.env.LACERTA_ASSETS?.split(',');
const names = existsSync(dataFolder) ? readdirSync(dataFolder).filter(name => name.endsWith('.glb')).map(name => name.slice(0, -4))
  .filter(name => !wanted || wanted.includes(name)) : [];
const outputs = [...names.map(name => ({name, file: `${name}.glb`, options: []})),
  ...withLevels.filter(name => names.includes(name)).map(name => ({name, file: `${name}_levels.glb`, options: ['--levels', 'always', '--effort', 'fast']}))];

let browser, io;
before(async () => {
  mkdirSync(packed, {recursive: true});
  const here = fileURLToPath(new URL('.', import.meta.url));
  browser = await openPage('/', [['/originals/', dataFolder], ['/packed/', packed], ...viewerRoots.slice(2, -1), ['/', here]]);
  io = new NodeIO().setLogger(new Logger(Logger.Verbosity.ERROR)).registerExtensions(ALL_EXTENSIONS)
    .registerDependencies({'draco3d.decoder': await dracoModule()});
});
after(() => browser?.close());

const diagonal = ([min, max]) => Math.hypot(...max.map((x, axis) => x - min[axis]));
function assertSameBox(box, original, share) {
  const far = Math.max(...box.flatMap((corner, end) => corner.map((x, axis) => Math.abs(x - original[end][axis]))));
  assert.ok(far <= share * diagonal(original), `${far} off, the diagonal is ${diagonal(original)}`);
}

// What the accessors of the file say, which is what stock readers have to find.
function trianglesInScenes(document) {
  const root = document.getRoot(), scene = root.getDefaultScene() ?? root.listScenes()[0];
  let triangles = 0;
  scene.traverse(node => {
    for (const primitive of node.getMesh()?.listPrimitives() ?? []) triangles += (primitive.getIndices() ?? primitive.getAttribute('POSITION')).getCount() / 3;
  });
  return {triangles, bounds: getBounds(scene)};
}

for (const {name, file, options} of outputs) {
  test(`${file}: stock three.js and stock glTF-Transform show it`, async () => {
    const original = join(dataFolder, `${name}.glb`), path = join(packed, file);
    try {
      lacerta('pack', original, '-o', path, '--resume', ...options);
    } catch (error) {
      assert.equal(error.status, 5, String(error.stderr));  // misses its target: opens all the same
    }
    const {json} = readHead(new Uint8Array(readFileSync(path))), isBase = json.extensions?.LACERTA_mesh_progressive !== undefined;
    assert.ok(isBase || options.length === 0);
    const share = isBase ? 0.05 : 0.005;  // of the diagonal; bases are coarse
    const transformed = trianglesInScenes(await io.read(path)), before = trianglesInScenes(await io.read(original));
    assert.ok(transformed.triangles > 0 && transformed.triangles <= before.triangles, `${transformed.triangles} triangles of ${before.triangles}`);
    assertSameBox([transformed.bounds.min, transformed.bounds.max], [before.bounds.min, before.bounds.max], share);
    const errors = browser.errors.length, [seen, seenBefore] = [await browser.page.evaluate(url => window.look(url), `/packed/${file}`),
      await browser.page.evaluate(url => window.look(url), `/originals/${name}.glb`)];
    assert.equal(browser.errors.length, errors, browser.errors.slice(errors).join('\n'));
    assert.ok(seen.finite);
    assert.equal(seen.triangles, transformed.triangles);
    assertSameBox(seen.box, seenBefore.box, share);
    assert.ok(seenBefore.covered > 0.01 && Math.abs(seen.covered - seenBefore.covered) <= (isBase ? 0.05 : 0.01),
      `covers ${seen.covered} of the picture, the original ${seenBefore.covered}`);
  });
}

test('the data folder is there', {skip: names.length > 0 ? false : `${dataFolder} is not`}, () => assert.ok(names.length > 0));
