// The viewer in Chromium: levels, smoothness, memory, and what happens when the network does not behave.
import assert from 'node:assert/strict';
import {copyFileSync, readFileSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {loadWhole, openViewer, pictures, scanAsset, texturedAsset} from './support.mjs';
import {example, readAsset, scratch} from '../node/support.mjs';

let viewer, page, asset;
before(async () => {
  asset = await scanAsset('horse', 85);
  viewer = await openViewer();
  page = viewer.page;
  await loadWhole(page, asset.file);  // warms the decoders up
  await page.evaluate(url => window.viewer.showDraco(url), asset.twinFile);
});
after(() => viewer?.close());

const problem = () => page.textContent('#problem');

test('each level has its picture, none is empty, and the finest differs from the base', async () => {
  await loadWhole(page, asset.file);
  const last = await page.evaluate('window.model.surfaces[0].lastPart');
  let sizes = [];
  for (let level = 0; level <= last; ++level) {
    await page.evaluate(part => window.model.setMaxLevel(part), level);
    await page.waitForFunction(part => window.model.surfaces[0].part === part, level);
    await page.waitForTimeout(150);
    const picture = await page.locator('#left canvas').screenshot({path: join(pictures, `level_${level}.png`)});
    sizes.push(picture.length);
  }
  assert.ok(last >= 3);
  assert.ok(sizes.every(size => size > 3000), `${sizes}`);
  assert.notEqual(sizes[0], sizes.at(-1));
});

test('levels go down with the distance and come back', async () => {
  await loadWhole(page, asset.file);
  const seenFrom = factor => page.evaluate(async times => {
    const {model, viewer} = window;
    const {camera} = viewer.left;
    const center = model.surfaces[0].stream.min.map((x, axis) => (x + model.surfaces[0].stream.max[axis]) / 2);
    const size = Math.hypot(...model.surfaces[0].stream.max.map((x, axis) => x - model.surfaces[0].stream.min[axis]));
    camera.position.set(center[0], center[1], center[2] + size * times);
    camera.lookAt(...center);
    camera.far = size * times * 4;
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
    model.update(camera, 480);
    for (let before; before !== model.surfaces[0].part;) {
      before = model.surfaces[0].part;
      await new Promise(resolve => setTimeout(resolve, 700));
    }
    return model.surfaces[0].part;
  }, factor);
  const near = await seenFrom(0.8), far = await seenFrom(100), again = await seenFrom(0.8);
  assert.ok(near > far, `${near} near, ${far} far`);
  assert.equal(again, near);
});

test('one request per segment gives the same levels', async () => {
  const history = await loadWhole(page, asset.file, 'range');
  assert.equal(history.at(-1).level, await page.evaluate('window.model.surfaces[0].lastPart'));
  assert.equal(await problem(), '');
});

test('no task over 50 ms on the main thread while 100k triangles refine', async () => {
  const small = await openViewer({width: 160, height: 160});
  try {
    await loadWhole(small.page, asset.file);
    await small.page.evaluate('window.viewer.clear()');
    const browser = small.page.context().browser();
    await browser.startTracing(small.page, {categories: ['toplevel', 'disabled-by-default-devtools.timeline']});
    const history = await loadWhole(small.page, `${asset.file}?kbps=40`);
    await small.page.waitForTimeout(200);
    const {traceEvents} = JSON.parse(await browser.stopTracing());
    assert.ok(history.some(({triangles}) => triangles >= 100_000), JSON.stringify(history));
    // By CPU time: what other programs take of the machine is none of ours.
    const main = traceEvents.filter(({name, args}) => name === 'thread_name' && args.name === 'CrRendererMain').map(({pid, tid}) => `${pid} ${tid}`);
    const tasks = traceEvents.filter(({name, tdur, pid, tid}) => /RunTask|ThreadControllerImpl::RunTask/.test(name) && tdur > 0 && main.includes(`${pid} ${tid}`))
      .map(({tdur}) => tdur / 1000).sort((a, b) => b - a);
    assert.ok(tasks.length > 50, `${tasks.length} tasks were traced`);
    assert.ok(tasks[0] < 50, `longest tasks: ${tasks.slice(0, 5).map(Math.round)} ms`);
  } finally {
    await small.close();
  }
});

test('100 times loaded and disposed leaves nothing behind', async () => {
  await page.evaluate('window.viewer.clear()');
  const cycle = count => page.evaluate(async ([url, times]) => {
    for (let i = 0; i < times; ++i) {
      await window.viewer.show(url, {mode: 'stream', name: 'cycle'});
      await window.model.whenLevel(2);
      window.viewer.clear();
    }
    await new Promise(resolve => setTimeout(resolve, 200));
    for (let i = 0; i < 3; ++i) {
      window.gc();
      await new Promise(resolve => setTimeout(resolve, 100));
    }
    return {heap: performance.memory.usedJSHeapSize, geometries: window.viewer.renderer.info.memory.geometries, streams: (await window.viewer.pool()).streams};
  }, [asset.file, count]);
  const first = await cycle(10), last = await cycle(100);
  assert.equal(last.geometries, 0);
  assert.equal(last.streams, 0);
  assert.ok(last.heap - first.heap < 5e6, `${first.heap} bytes after 10, ${last.heap} after 110`);
});

test('a truncated, a damaged, a missing and a stalled file each leave the last good level and one message', async () => {
  const bytes = readFileSync(asset.glb);
  writeFileSync(join(scratch, 'truncated.glb'), bytes.subarray(0, Math.floor(bytes.length * 0.6)));
  const damaged = Buffer.from(bytes);
  damaged[Math.floor(bytes.length * 0.8)] ^= 0xff;
  writeFileSync(join(scratch, 'damaged.glb'), damaged);
  const messages = () => page.evaluate(async () => {
    const told = [];
    window.model?.addEventListener('problem', ({detail}) => told.push(detail.message));
    await new Promise(resolve => setTimeout(resolve, 1500));
    return {told, part: window.model?.surfaces[0]?.part, shown: window.viewer.renderer.info.render.triangles};
  });

  await page.evaluate(() => window.viewer.show('/assets/truncated.glb', {mode: 'stream', name: 'truncated'}));
  let {part, shown} = await messages();
  assert.ok(part >= 0 && part < await page.evaluate('window.model.surfaces[0].lastPart') && shown > 0);
  assert.match(await problem(), /^the file ends early: \d+ of \d+ bytes of the surfaces are there; the last good level stays$/);

  writeFileSync(join(scratch, 'stump.glb'), bytes.subarray(0, 1500));
  await page.evaluate(() => window.viewer.show('/assets/stump.glb', {mode: 'stream', name: 'stump'}));
  assert.match(await problem(), /stump\.glb: the file ends early, after 1500 bytes, with nothing to show/);

  await page.evaluate(() => window.viewer.show('/assets/damaged.glb', {mode: 'stream', name: 'damaged'}));
  ({part, shown} = await messages());
  assert.ok(part >= 0 && part < await page.evaluate('window.model.surfaces[0].lastPart') && shown > 0);
  assert.match(await problem(), /level \d+ cannot be shown .*; level \d+ stays/);

  await page.evaluate(() => window.viewer.show('/assets/nowhere.glb', {mode: 'stream', name: 'missing'}));
  assert.match(await problem(), /nowhere\.glb: not found \(404\)/);
});

test('a download that is stopped goes on where it ended', async () => {
  await page.evaluate(url => window.viewer.show(url, {mode: 'stream', name: 'stopped'}), `${asset.file}?kbps=20`);
  await page.evaluate('window.model.abort()');
  const before = await page.evaluate('window.model.received');
  await page.waitForTimeout(500);
  assert.equal(await page.evaluate('window.model.received'), before);
  assert.equal(await problem(), '');
  await page.evaluate('window.model.resume()');
  await page.waitForFunction('window.model.surfaces[0].isComplete', null, {timeout: 20000});
});

test('textures come after the surfaces, onto the same materials; a file that ends before them is told', async () => {
  const {path, imageBytes} = await texturedAsset('textured.glb');
  for (const mode of ['stream', 'range']) {
    const seen = await page.evaluate(async ([url, how]) => {
      const gltf = await window.viewer.show(url, {mode: how, name: 'textured'}), {model} = window;
      let mesh;
      gltf.scene.traverse(object => { if (object.isMesh) mesh = object; });
      const {material} = mesh, before = Boolean(material.map), events = [];
      model.addEventListener('complete', () => events.push('complete'));
      await new Promise(resolve => model.addEventListener('textures', resolve, {once: true}));
      return {before, events, part: model.surfaces[0].part, last: model.surfaces[0].lastPart, same: mesh.material === material, width: material.map?.image.width};
    }, [`/assets/textured.glb?kbps=200&mode=${mode}`, mode]);
    assert.deepEqual(seen, {before: false, events: ['complete'], part: seen.last, last: seen.last, same: true, width: 256});
    assert.equal(await problem(), '');
  }
  writeFileSync(join(scratch, 'no_textures.glb'), readFileSync(path).subarray(0, -imageBytes));
  await page.evaluate(() => window.viewer.show('/assets/no_textures.glb', {mode: 'stream', name: 'cut'}));
  await page.waitForFunction('window.model.surfaces[0].isComplete && document.getElementById("problem").textContent !== ""');
  assert.equal(await problem(), 'the file ends early: its textures are missing');
});

test('groups of a stream with attributes refine together, each with its own attributes, and no crack opens between them', async () => {
  copyFileSync(example('torus_with_attributes.glb'), join(scratch, 'groups.glb'));
  const {triangleCounts, vertexCounts} = readAsset(example('torus_with_attributes.glb')).stream;
  for (const mode of ['stream', 'range']) {
    const history = await loadWhole(page, '/assets/groups.glb', mode);
    assert.equal(await problem(), '');
    assert.equal(history.at(-1).triangles, triangleCounts.at(-1));
    const groups = await page.evaluate(() => {
      const meshes = window.model.surfaces[0].objects;
      return meshes.map(({geometry: {attributes, index}}) => ({names: Object.keys(attributes).sort(), vertices: attributes.position.count, triangles: index.count / 3,
        uv: Array.from(attributes.uv.array), positions: Array.from(attributes.position.array), lengths: Array.from({length: attributes.normal.count},
          (unused, v) => Math.hypot(attributes.normal.getX(v), attributes.normal.getY(v), attributes.normal.getZ(v)))}));
    });
    assert.equal(groups.length, 2);
    assert.equal(groups[0].triangles + groups[1].triangles, triangleCounts.at(-1));
    assert.equal(groups[0].vertices + groups[1].vertices, vertexCounts.at(-1));
    for (const {names, uv, lengths} of groups) {
      assert.deepEqual(names, ['normal', 'position', 'uv']);
      assert.ok(Math.max(...uv) <= 1.01 && Math.min(...uv) >= -0.01 && Math.max(...uv) > 0.9);
      assert.ok(lengths.every(length => Math.abs(length - 1) < 1e-5));
    }
    const at = positions => new Set(positions.flatMap((x, i) => i % 3 === 0 ? [positions.slice(i, i + 3).join()] : []));
    const first = at(groups[0].positions), shared = [...at(groups[1].positions)].filter(place => first.has(place)).length;
    assert.ok(shared >= 32, `${shared} places on both sides of the border`);
  }
});

test('no error was thrown in the page', () => assert.deepEqual(viewer.errors, []));
