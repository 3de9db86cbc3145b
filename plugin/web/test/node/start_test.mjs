// `npm start`, as one types it: it packs its assets where there are none, serves the viewer and what it loads, and ends when it is told to.
import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';
import {test} from 'node:test';
import {join} from 'node:path';
import {root, scratch} from './support.mjs';

test('npm start serves the viewer, its modules and its assets, whole and by ranges, and ends on a signal', {timeout: 600_000}, async () => {
  // Data of this machine are left out, so that the torus alone is packed.
  const server = spawn('npm', ['start', '--', join(scratch, 'viewer_assets')], {cwd: join(root, 'plugin/web'), env: {...process.env, PORT: '0', LACERTA_TEST_DATA_DIR: '/nowhere'}, detached: true,
    stdio: ['ignore', 'pipe', 'pipe']});
  let told = '';
  const ended = new Promise(resolve => server.on('close', resolve));
  try {
    const base = await new Promise((resolve, reject) => {
      for (const pipe of [server.stdout, server.stderr]) {
        pipe.on('data', text => {
          told += text;
          const found = /http:\/\/localhost:\d+\//.exec(told);
          if (found) resolve(found[0]);
        });
      }
      ended.then(code => reject(new Error(`ended with ${code}: ${told}`)));
    });
    const get = (path, headers = {}) => fetch(new URL(path, base), {headers});
    const page = await get('');
    assert.equal(page.status, 200);
    assert.match(page.headers.get('content-type'), /text\/html/);
    const html = await page.text();
    // All that the page names is there.
    const named = [...html.matchAll(/(?:src|href)="([^"#]+)"|": "(\/[^"]+\.js)"/g)].map(([, link, module]) => link ?? module);
    assert.ok(named.length >= 3, html);
    for (const path of named) assert.equal((await get(path)).status, 200, path);
    const assets = await (await get('assets.json')).json();
    assert.ok(assets.includes('torus.glb'), `${assets}`);
    const whole = new Uint8Array(await (await get('assets/torus.glb')).arrayBuffer());
    assert.equal(new TextDecoder().decode(whole.subarray(0, 4)), 'glTF');
    const part = await get('assets/torus.glb', {Range: 'bytes=100-299'});
    assert.equal(part.status, 206);
    assert.equal(part.headers.get('content-range'), `bytes 100-299/${whole.length}`);
    assert.deepEqual(new Uint8Array(await part.arrayBuffer()), whole.subarray(100, 300));
    assert.equal((await get('assets/nowhere.glb')).status, 404);
  } finally {
    if (server.exitCode === null) process.kill(-server.pid, 'SIGINT');  // as Ctrl-C does: all of its group
  }
  await ended;
  await assert.rejects(fetch(/http:\/\/localhost:\d+\//.exec(told)[0]));
});
