// The functions of lacerta.h over an instance of lacerta.wasm. Synchronous: use pool.js to keep it off the main thread.

const kOk = 0, kNeedsBase = 7, kAllGroups = 0xffffffff;
const kNames = ['ok', 'invalid argument', 'damaged or not made for this base', 'made by a newer version', 'over the limits', 'out of memory', 'internal error',
  'the base has to be decoded by Draco'];
// Sizes of the structs of lacerta.h, with 32-bit pointers.
const kOptionsSize = 40, kProgressSize = 40, kMeshSizeSize = 16, kBuffersSize = 32, kScratchSize = 64;

export class LacertaError extends Error {
  constructor(code, what) {
    super(`${what}: ${kNames[code] ?? `error ${code}`}`);
    this.name = 'LacertaError';
    this.code = code;
  }
}

/** Makes an instance of a compiled lacerta.wasm. Each has a memory of its own; what one stream took is given back, but never shrinks it. */
export async function instantiate(module) {
  const imports = {};
  for (const {module: from, name} of WebAssembly.Module.imports(module)) {
    (imports[from] ??= {})[name] = () => {
      if (name !== 'emscripten_notify_memory_growth') throw new LacertaError(5, 'decoder');
      return 0;
    };
  }
  const instance = await WebAssembly.instantiate(module, imports);
  instance.exports._initialize();
  return instance.exports;
}

/** Decodes one stream as its bytes arrive; a twin of lacerta_decoder. */
export class Decoder {
  #wasm;
  #handle = 0;
  #scratch = 0;

  /** @param wasm what instantiate() gave. options: {maxLevel, maxVertices, maxTriangles, baseSize}, as lacerta_decoder_options */
  constructor(wasm, options = {}) {
    this.#wasm = wasm;
    this.#scratch = this.#allocate(kScratchSize);
    const view = this.#view();
    view.setUint32(this.#scratch, kOptionsSize, true);
    view.setInt32(this.#scratch + 4, options.maxLevel ?? -1, true);
    [options.maxVertices, options.maxTriangles, options.baseSize].forEach((value, i) => {
      view.setBigUint64(this.#scratch + 8 + 8 * i, BigInt(value ?? 0), true);
    });
    view.setUint32(this.#scratch + 32, 0, true);
    this.#check(wasm.lacerta_decoder_create(this.#scratch, this.#scratch + kOptionsSize), 'decoder');
    this.#handle = this.#view().getUint32(this.#scratch + kOptionsSize, true);
  }

  /** Takes the next bytes. Returns the finest complete level, -1 while there is no base. Throws a LacertaError on damage: what is there stays. */
  append(bytes) {
    const memory = this.#copyIn(bytes);
    const result = this.#wasm.lacerta_decoder_append(this.#handle, memory, bytes.length, this.#scratch);
    this.#wasm.free(memory);
    return this.#levelAfter(result);
  }

  /** Whether only setBase leads on: the base is a Draco stream, baseSection() being what Draco is to decode. */
  needsBase = false;
  baseSection() {
    const out = this.#scratch;
    this.#check(this.#wasm.lacerta_decoder_base_section(this.#handle, out, out + 4), 'base');
    const view = this.#view();
    return new Uint8Array(this.#wasm.memory.buffer, view.getUint32(out, true), view.getUint32(out + 4, true)).slice();
  }

  /** Says that no more bytes will come. */
  finish() {
    return this.#levelAfter(this.#wasm.lacerta_decoder_finish(this.#handle, this.#scratch));
  }

  /** The base as the host's Draco decoder gave it: Float32Array of 3 x vertices, integer array of 3 x triangles. */
  setBase(positions, indices) {
    const coordinates = this.#copyIn(Float32Array.from(positions));
    const corners = this.#copyIn(Uint32Array.from(indices));
    const result = this.#wasm.lacerta_decoder_set_base(this.#handle, coordinates, positions.length / 3, corners, indices.length / 3);
    this.#wasm.free(coordinates);
    this.#wasm.free(corners);
    this.#check(result, 'base');
    this.needsBase = false;
  }

  /** {level, numLevels, state, hasLayers, isComplete, bytesUsed} as lacerta_progress. */
  progress() {
    this.#view().setUint32(this.#scratch, kProgressSize, true);
    this.#check(this.#wasm.lacerta_decoder_get_progress(this.#handle, this.#scratch), 'progress');
    const view = this.#view();
    const int = offset => view.getInt32(this.#scratch + offset, true);
    return {level: int(4), numLevels: int(8), state: int(12), hasLayers: int(16) === 1, isComplete: int(20) === 1,
      bytesUsed: Number(view.getBigUint64(this.#scratch + 24, true))};
  }

  /** The mesh of a level: {positions, normals, indices} in arrays of its own. normals: whether smooth ones are wanted. */
  read(level, {normals = false} = {}) {
    const wasm = this.#wasm, size = this.#scratch, buffers = this.#scratch + kMeshSizeSize;
    this.#view().setUint32(size, kMeshSizeSize, true);
    this.#check(wasm.lacerta_decoder_get_mesh_size(this.#handle, level, kAllGroups, size), `level ${level}`);
    let view = this.#view();
    const vertices = view.getUint32(size + 4, true), triangles = view.getUint32(size + 8, true);
    const memory = this.#allocate(12 * (vertices * (normals ? 2 : 1) + triangles));
    const at = {positions: memory, indices: memory + 12 * vertices, normals: memory + 12 * (vertices + triangles)};
    view = this.#view();
    [kBuffersSize, vertices, triangles, 0, at.positions, normals ? at.normals : 0, at.indices, 0].forEach((value, i) => {
      view.setUint32(buffers + 4 * i, value, true);
    });
    try {
      this.#check(wasm.lacerta_decoder_read_mesh(this.#handle, level, kAllGroups, buffers), `level ${level}`);
      const copy = (Type, from, count) => new Type(wasm.memory.buffer, from, count).slice();
      return {
        positions: copy(Float32Array, at.positions, 3 * vertices),
        normals: normals ? copy(Float32Array, at.normals, 3 * vertices) : null,
        indices: copy(Uint32Array, at.indices, 3 * triangles),
      };
    } finally {
      wasm.free(memory);
    }
  }

  dispose() {
    if (this.#handle !== 0) this.#wasm.lacerta_decoder_destroy(this.#handle);
    if (this.#scratch !== 0) this.#wasm.free(this.#scratch);
    this.#handle = this.#scratch = 0;
  }

  #levelAfter(result) {
    this.needsBase = result === kNeedsBase;
    if (!this.needsBase) this.#check(result, 'stream');
    return this.#view().getInt32(this.#scratch, true);
  }

  #check(result, what) {
    if (result !== kOk) throw new LacertaError(result, what);
  }

  // Views are made anew each time: they go stale when the memory grows.
  #view() { return new DataView(this.#wasm.memory.buffer); }

  #allocate(size) {
    const memory = this.#wasm.malloc(size) >>> 0;
    if (memory === 0) throw new LacertaError(5, 'decoder');
    return memory;
  }

  #copyIn(array) {
    const memory = this.#allocate(array.byteLength || 1);
    new Uint8Array(this.#wasm.memory.buffer).set(new Uint8Array(array.buffer, array.byteOffset, array.byteLength), memory);
    return memory;
  }
}
