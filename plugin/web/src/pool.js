// Decoders in worker threads. A stream stays with the worker that began it; results are transferred, not copied.
import {LacertaError} from './decoder.js';

class Thread {
  #worker;
  #pending = new Map();
  #next = 0;
  streams = 0;

  constructor(worker, module) {
    this.#worker = worker;
    const onMessage = data => this.#settle(data);
    const onError = error => this.#failAll(error.message ?? 'the worker ended');
    if (worker.addEventListener) {
      worker.addEventListener('message', event => onMessage(event.data));
      worker.addEventListener('error', onError);
    } else {  // Node.js
      worker.on('message', onMessage);
      worker.on('error', onError);
    }
    this.ask('compiled', module).catch(() => {});
  }

  ask(call, argument, stream, transfer = []) {
    return new Promise((resolve, reject) => {
      const id = this.#next++;
      this.#pending.set(id, {resolve, reject});
      this.#worker.postMessage({id, stream, call, argument}, transfer);
    });
  }

  terminate() {
    this.#worker.terminate();
    this.#failAll('the pool was disposed');
  }

  #settle({id, value, error}) {
    const {resolve, reject} = this.#pending.get(id) ?? {};
    this.#pending.delete(id);
    if (error) reject?.(Object.assign(new LacertaError(error.code, 'stream'), {message: error.message}));
    else resolve?.(value);
  }

  #failAll(message) {
    for (const {reject} of this.#pending.values()) reject(new Error(message));
    this.#pending.clear();
  }
}

/** The functions of Decoder as promises. */
class RemoteDecoder {
  #thread;
  #stream;

  constructor(thread, stream, created) {
    this.#thread = thread;
    this.#stream = stream;
    created.catch(() => {});  // calls that follow fail, too
  }

  /** bytes: transferred where they fill their buffer, else copied. Resolves to {level, numLevels, state, ...}. */
  append(bytes) {
    const whole = bytes.byteLength === bytes.buffer.byteLength;
    return this.#thread.ask('append', bytes, this.#stream, whole ? [bytes.buffer] : []);
  }
  finish() { return this.#thread.ask('finish', undefined, this.#stream); }
  setBase(positions, indices) { return this.#thread.ask('setBase', {positions, indices}, this.#stream); }
  setBaseGroup(group, base) { return this.#thread.ask('setBaseGroup', {group, base}, this.#stream); }
  progress() { return this.#thread.ask('progress', undefined, this.#stream); }
  read(level, options) { return this.#thread.ask('read', {level, options}, this.#stream); }

  dispose() {
    if (!this.#thread) return;
    this.#thread.ask('dispose', undefined, this.#stream).catch(() => {});
    --this.#thread.streams;
    this.#thread = undefined;
  }
}

export class DecoderPool {
  #module;
  #size;
  #makeWorker;
  #threads = [];
  #count = 0;

  /** module: compiled lacerta.wasm. options: {size: number of workers, createWorker: () => Worker} */
  constructor(module, {size = Math.max(1, Math.min(4, (globalThis.navigator?.hardwareConcurrency ?? 2) - 1)), createWorker} = {}) {
    this.#module = module;
    this.#size = size;
    this.#makeWorker = createWorker ?? (() => new Worker(new URL('./worker.js', import.meta.url), {type: 'module'}));
  }

  get streams() { return this.#threads.reduce((sum, thread) => sum + thread.streams, 0); }

  /** Starts the worker of the next stream, where it is to have one of its own. */
  warm() {
    if (this.#threads.length < this.#size && this.#threads.every(thread => thread.streams > 0)) this.#threads.push(new Thread(this.#makeWorker(), this.#module));
  }

  /** options: as for Decoder. */
  create(options = {}) {
    this.warm();
    const thread = this.#threads.reduce((best, other) => other.streams < best.streams ? other : best);
    ++thread.streams;
    const stream = this.#count++;
    return new RemoteDecoder(thread, stream, thread.ask('create', options, stream));
  }

  dispose() {
    for (const thread of this.#threads) thread.terminate();
    this.#threads = [];
  }
}
