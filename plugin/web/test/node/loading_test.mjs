// What stands between the network and the decoder: transfers that break, segments in pieces, the choice of levels.
import assert from 'node:assert/strict';
import {test} from 'node:test';
import {chooseParts, coarsestWithin, mostValuable, pixelsPerUnit} from '../../dist/level_choice.js';
import {SegmentFeed} from '../../dist/segment_feed.js';
import {transfer} from '../../dist/transfer.js';

const file = Uint8Array.from({length: 1000}, (unused, i) => i * 7);

// A server in the place of fetch. breakAfter: bytes that a connection lives for, one entry per request; ranges: whether it honours them.
function serverOf({breakAfter = [], ranges = true, status, stalls = false} = {}) {
  const requests = [];
  const get = async (url, {headers, signal}) => {
    requests.push(headers);
    if (status) return new Response(null, {status});
    const [, begin, end] = /bytes=(\d+)-(\d*)/.exec(headers.Range ?? '') ?? [];
    const isPart = ranges && begin !== undefined;
    if (isPart && Number(begin) >= file.length) return new Response(null, {status: 416});
    const part = isPart ? file.subarray(Number(begin), end ? Number(end) + 1 : undefined) : file;
    const lives = breakAfter[requests.length - 1] ?? Infinity;
    let at = 0;
    const body = new ReadableStream({
      pull(controller) {
        if (at >= lives) {
          if (stalls) return new Promise((resolve, reject) => signal.addEventListener('abort', () => reject(signal.reason), {once: true}));
          return controller.error(new Error('reset'));
        }
        if (at >= part.length) return controller.close();
        const next = Math.min(at + 64, part.length, lives);
        controller.enqueue(part.slice(at, next));
        at = next;
      },
    }, {highWaterMark: 0});
    return new Response(body, {status: isPart ? 206 : 200, headers: {'content-length': String(part.length), etag: '"one"'}});
  };
  return {get, requests};
}

async function read(server, options = {}) {
  const got = new Uint8Array(file.length), seen = new Uint8Array(file.length);
  const count = await transfer('http://host/file', (offset, bytes) => {
    got.set(bytes, offset);
    for (let i = 0; i < bytes.length; ++i) ++seen[offset + i];
  }, {fetch: server.get, ...options});
  return {got, seen, count};
}

test('a whole file comes in one request without a range, every byte once', async () => {
  const server = serverOf(), {got, seen, count} = await read(server);
  assert.deepEqual(got, file);
  assert.ok(seen.every(times => times === 1));
  assert.equal(count, 1000);
  assert.deepEqual(server.requests, [{}]);
});

test('a range brings its bytes alone, from servers that ignore ranges too', async () => {
  for (const ranges of [true, false]) {
    const server = serverOf({ranges}), {got, seen, count} = await read(server, {begin: 100, end: 300});
    assert.equal(count, 200);
    assert.deepEqual(got.subarray(100, 300), file.subarray(100, 300));
    assert.equal(seen.reduce((sum, times) => sum + times, 0), 200);
    assert.equal(server.requests[0].Range, 'bytes=100-299');
  }
});

test('a connection that breaks is taken up where it ended, and no byte comes twice', async () => {
  for (const ranges of [true, false]) {
    const server = serverOf({breakAfter: [320], ranges}), {got, seen} = await read(server);
    assert.deepEqual(got, file);
    assert.ok(seen.every(times => times === 1));
    assert.equal(server.requests.length, 2);
    assert.equal(server.requests[1].Range, 'bytes=320-');
  }
});

test('one that stalls is given up after the timeout, and taken up too', async () => {
  const server = serverOf({breakAfter: [128], stalls: true}), {got} = await read(server, {timeout: 50});
  assert.deepEqual(got, file);
  assert.equal(server.requests.length, 2);
});

test('what does not mend ends in one error that names the file', async () => {
  await assert.rejects(read(serverOf({status: 404})), /http:\/\/host\/file: not found \(404\)/);
  await assert.rejects(read(serverOf({status: 503}), {retries: 1}), /http:\/\/host\/file: the server answered 503/);
  await assert.rejects(read(serverOf({breakAfter: [64, 0, 0]}), {retries: 1}), /http:\/\/host\/file: the connection broke off after 64 bytes \(.*reset/);
  const server = serverOf({status: 404});
  await read(server).catch(() => {});
  assert.equal(server.requests.length, 1);
  assert.equal((await read(serverOf(), {begin: 1000, end: 1100})).count, 0);
});

test('an abort ends a transfer at once, with its reason', async () => {
  const stop = new AbortController();
  await assert.rejects(transfer('http://host/file', () => stop.abort(new Error('enough')), {fetch: serverOf().get, signal: stop.signal}), /enough/);
});

const twoStreams = () => {
  const order = [[0, 0, 30], [1, 0, 20], [0, 1, 50], [1, 1, 0], [1, 2, 40], [0, 2, 60]];
  let offset = 0;
  const streams = [{segments: []}, {segments: []}];
  const segments = order.map(([stream, part, length]) => {
    const segment = {stream, part, offset, length};
    streams[stream].segments.push(segment);
    offset += length;
    return segment;
  });
  return {streams, order: segments, length: offset};
};

test('segments are handed over whole and in the order of their stream, however their bytes come', () => {
  for (const step of [1, 7, 64, 200]) {
    for (const backwards of [false, true]) {
      const progressive = twoStreams(), given = [];
      const feed = new SegmentFeed(progressive, (stream, part, bytes) => given.push({stream, part, bytes}));
      const order = backwards ? [...progressive.order].reverse() : progressive.order;
      for (const {offset, length} of order) {
        for (let at = 0; at < length; at += step) feed.push(offset + at, file.subarray(offset + at, offset + Math.min(at + step, length)));
      }
      assert.ok(feed.isWhole);
      assert.equal(feed.bytes, 200);
      for (const stream of [0, 1]) {
        const own = given.filter(entry => entry.stream === stream);
        assert.deepEqual(own.map(({part}) => part), [0, 1, 2]);
        own.forEach(({part, bytes}) => {
          const {offset, length} = progressive.streams[stream].segments[part];
          assert.deepEqual(bytes, file.slice(offset, offset + length));
        });
      }
    }
  }
});

test('bytes that come twice count once, and a gap within a segment is refused', () => {
  const progressive = twoStreams(), given = [], feed = new SegmentFeed(progressive, (stream, part) => given.push([stream, part]));
  feed.push(0, file.subarray(0, 20));
  feed.push(10, file.subarray(10, 25));
  assert.equal(feed.bytes, 25);
  feed.push(27, file.subarray(27, 30));
  assert.equal(feed.bytes, 25);
  assert.deepEqual(given, []);
  feed.push(25, file.subarray(25, 30));
  assert.deepEqual(given, [[0, 0]]);
  assert.ok(feed.isComplete(progressive.order[0]) && !feed.isComplete(progressive.order[1]) && !feed.isWhole);
});

test('levels are chosen by their error on the screen, within the budget of triangles', () => {
  assert.ok(Math.abs(pixelsPerUnit(10, Math.PI / 2, 1000) - 50) < 1e-9);
  assert.equal(coarsestWithin([8, 4, 2, 1], 2), 2);
  assert.equal(coarsestWithin([8, 4, 2, 1], 0.5), 3);
  const item = scale => ({errors: [8, 4, 2, 1], triangleCounts: [10, 40, 160, 640], scale});
  assert.deepEqual(chooseParts([item(1), item(0.25), item(0)], {pixelError: 1}), [3, 1, 0]);
  // 640 + 40 + 10 triangles; the first loses 1 pixel for 480 of them, the second 1 for 30.
  assert.deepEqual(chooseParts([item(1), item(0.25), item(0)], {pixelError: 1, maxTriangles: 600}), [2, 1, 0]);
  assert.deepEqual(chooseParts([item(1), item(1)], {pixelError: 1, maxTriangles: 1}), [0, 0]);
});

test('the next segment is the one with most pixels for its bytes, of those that are wanted', () => {
  const streams = [{segments: [0, 100, 100].map((length, part) => ({stream: 0, part, length}))}, {segments: [0, 10, 1000].map((length, part) => ({stream: 1, part, length}))}];
  const items = [{errors: [8, 4, 2], scale: 1}, {errors: [8, 4, 2], scale: 0.5}];
  assert.deepEqual(mostValuable(items, [0, 0], [2, 2], {streams}), streams[1].segments[1]);
  assert.deepEqual(mostValuable(items, [0, 1], [2, 2], {streams}), streams[0].segments[1]);
  assert.deepEqual(mostValuable(items, [2, 1], [2, 2], {streams}), streams[1].segments[2]);
  assert.equal(mostValuable(items, [2, 1], [2, 1], {streams}), undefined);
});
