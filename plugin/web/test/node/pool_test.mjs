// Decoders in worker threads, here those of Node.js.
import assert from 'node:assert/strict';
import {test} from 'node:test';
import {Worker} from 'node:worker_threads';
import {createPool} from '../../dist/index.js';
import {golden} from './support.mjs';

const createWorker = () => new Worker(new URL('../../dist/worker.js', import.meta.url));

test('streams in several workers, each with its own progress and failure', async () => {
  const pool = await createPool({size: 2, createWorker});
  const damaged = golden('custom_form_compact.drc');
  damaged[damaged.length - 1] ^= 1;
  const decoders = Array.from({length: 5}, () => pool.create());
  assert.equal(pool.streams, 5);
  const results = await Promise.allSettled(decoders.map((decoder, i) => decoder.append((i === 3 ? damaged : golden('custom_form_compact.drc')).slice())));
  results.forEach((result, i) => assert.equal(result.status, i === 3 ? 'rejected' : 'fulfilled'));
  assert.equal(results[0].value.level, 2);
  assert.match(results[3].reason.message, /damaged/);
  assert.equal((await decoders[3].progress()).level, 1);
  const mesh = await decoders[0].read(2, {normals: true});
  assert.equal(mesh.indices.length, 3 * 960);
  assert.equal(mesh.normals.length, mesh.positions.length);
  for (const decoder of decoders) decoder.dispose();
  assert.equal(pool.streams, 0);
  pool.dispose();
});

test('a warm pool has the worker of the next stream, and no more workers than streams want', async () => {
  let made = 0;
  const pool = await createPool({size: 2, createWorker: () => (++made, createWorker())});
  pool.warm();
  pool.warm();
  assert.equal(made, 1);
  const first = pool.create();
  assert.equal(made, 1);
  pool.create();
  assert.equal(made, 2);
  pool.create();
  first.dispose();
  pool.create();
  assert.equal(made, 2);
  assert.equal(pool.streams, 3);
  pool.dispose();
});

test('appended bytes that fill their buffer are transferred', async () => {
  const pool = await createPool({size: 1, createWorker});
  const bytes = golden('custom_form_compact.drc').slice(), decoder = pool.create();
  const appended = decoder.append(bytes);
  assert.equal(bytes.length, 0);
  assert.equal((await appended).level, 2);
  pool.dispose();
});
