// Morph targets in Chromium, with three's own Draco decoder.
import assert from 'node:assert/strict';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {kTargets, writeMorphedTorus} from '../node/morphed_torus.mjs';
import {pack, readAsset, scratch} from '../node/support.mjs';
import {loadWhole, openViewer} from './support.mjs';

let viewer, asset;
before(async () => {
  const path = join(scratch, 'morphed_torus.glb');
  await writeMorphedTorus(path);
  asset = pack('morphed.glb', path, '--levels', 'always', '--psnr', '60');
  viewer = await openViewer({width: 200, height: 150});
});
after(() => viewer?.close());

test('morph targets sharpen with their surface, however the file comes in', async () => {
  const {page, errors} = viewer, {vertexCounts} = readAsset(asset).stream;
  for (const mode of ['stream', 'range']) {
    await loadWhole(page, '/assets/morphed.glb', mode);
    assert.equal(await page.textContent('#problem'), '');
    const seen = await page.evaluate(() => {
      const [{geometry, morphTargetInfluences}] = window.model.surfaces[0].objects, {position} = geometry.morphAttributes;
      return {counts: position.map(({count}) => count), highest: position.map(({array}) => Math.max(...array)), influences: morphTargetInfluences};
    });
    assert.deepEqual(seen.counts, Array(kTargets).fill(vertexCounts.at(-1)));
    assert.deepEqual(seen.influences, [0.5, 0, 0]);
    for (const height of seen.highest) assert.ok(height > 0.05 && height < 0.3, String(seen.highest));
  }
  assert.deepEqual(errors, []);
});
