// A thread that decodes streams. Requests: {id, stream, call, arguments}; answers: {id, value} or {id, error: {code, message}}.
import {Decoder, instantiate} from './decoder.js';

const port = typeof self === 'undefined' ? (await import('node:worker_threads')).parentPort : self;
const streams = new Map();
let module, wasm;

const calls = {
  compiled: given => { module = given; },
  async create(options, stream) {
    wasm ??= await instantiate(module);
    streams.set(stream, new Decoder(wasm, options));
  },
  append: (bytes, stream) => ({level: streams.get(stream).append(bytes), ...streams.get(stream).progress()}),
  finish: (unused, stream) => ({level: streams.get(stream).finish(), ...streams.get(stream).progress()}),
  setBase: ({positions, indices}, stream) => streams.get(stream).setBase(positions, indices),
  setBaseGroup: ({group, base}, stream) => streams.get(stream).setBaseGroup(group, base),
  progress: (unused, stream) => streams.get(stream).progress(),
  read: ({level, options}, stream) => streams.get(stream).read(level, options),
  dispose(unused, stream) {
    streams.get(stream)?.dispose();
    streams.delete(stream);
    if (streams.size === 0) wasm = undefined;  // the only way to give memory of WebAssembly back
  },
};

async function answer({id, stream, call, argument}) {
  try {
    const value = await calls[call](argument, stream);
    const buffers = call === 'read' ? [value.positions, value.normals, value.indices, ...Object.values(value.attributes)].filter(Boolean).map(array => array.buffer) : [];
    port.postMessage({id, value}, buffers);
  } catch (error) {
    if (error instanceof WebAssembly.RuntimeError || error instanceof RangeError) {
      streams.clear();  // out of memory: what this instance holds is lost
      wasm = undefined;
    }
    port.postMessage({id, error: {code: error.code ?? 6, message: error.message}});
  }
}

// One after the other, so that no call overtakes the one that makes its stream.
let queue = Promise.resolve();
const take = request => { queue = queue.then(() => answer(request)); };
if (port.addEventListener && typeof self !== 'undefined') port.addEventListener('message', event => take(event.data));
else port.on('message', take);
