// The functions of lacerta.h over an instance of lacerta.wasm. Synchronous: use pool.js to keep it off the main thread.

const kOk = 0, kNeedsBase = 7, kAllGroups = 0xffffffff;
const kNames = [, 'invalid argument', 'damaged or not made for this base', 'made by a newer version', 'over the limits', 'out of memory', 'internal error'];
// Sizes of the structs of lacerta.h, with 32-bit pointers.
const kOptionsSize = 56, kProgressSize = 40, kAttributeSize = 72, kGroupSize = 32, kMeshSizeSize = 16, kBuffersSize = 32, kScratchSize = 80;

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
  #names;  // of attributes

  /**
   * wasm: what instantiate() gave. options: {maxLevel, maxVertices, maxTriangles, baseSize, baseLengths, attributes}, as lacerta_decoder_options;
   * the last two as in the stream's JSON.
   */
  constructor(wasm, options = {}) {
    const {baseLengths = [], attributes = []} = options;
    this.#wasm = wasm;
    this.#names = baseLengths.length > 0 ? attributes : [];
    this.#scratch = this.#allocate(kScratchSize);
    const lengths = this.#copyIn(new BigUint64Array(baseLengths.map(BigInt)));
    const texts = this.#names.map(name => this.#copyIn(new TextEncoder().encode(`${name}\0`))), names = this.#copyIn(Uint32Array.from(texts));
    this.#put(this.#scratch, [kOptionsSize, options.maxLevel ?? -1]);
    [options.maxVertices, options.maxTriangles, options.baseSize].forEach((value, i) => {
      this.#view().setBigUint64(this.#scratch + 8 + 8 * i, BigInt(value ?? 0), true);
    });
    this.#put(this.#scratch + 32, [0, lengths, baseLengths.length, this.#names.length, names]);
    const result = wasm.lacerta_decoder_create(this.#scratch, this.#scratch + kOptionsSize);
    this.#free(lengths, names, ...texts);
    this.#check(result, 'decoder');
    this.#handle = this.#view().getUint32(this.#scratch + kOptionsSize, true);
  }

  /** Takes the next bytes. Returns the finest complete level, -1 while there is no base. Throws a LacertaError on damage: what is there stays. */
  append(bytes) {
    const memory = this.#copyIn(bytes);
    const result = this.#wasm.lacerta_decoder_append(this.#handle, memory, bytes.length, this.#scratch);
    this.#free(memory);
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
    const coordinates = this.#copyIn(Float32Array.from(positions)), corners = this.#copyIn(Uint32Array.from(indices));
    const result = this.#wasm.lacerta_decoder_set_base(this.#handle, coordinates, positions.length / 3, corners, indices.length / 3);
    this.#free(coordinates, corners);
    this.#check(result, 'base');
    this.needsBase = false;
  }

  /** The same of one group of a stream with attributes. attributes: {name: Float32Array}, those that the group has. */
  setBaseGroup(group, {positions, indices, attributes = {}}) {
    const given = this.#names.map(name => attributes[name]);
    const values = given.map(array => array ? this.#copyIn(Float32Array.from(array)) : 0);
    const memory = [Float32Array.from(positions), Uint32Array.from(indices), Uint32Array.from(values),
      Uint32Array.from(given, array => array ? 3 * array.length / positions.length : 0)].map(array => this.#copyIn(array));
    this.#put(this.#scratch, [kGroupSize, positions.length / 3, indices.length / 3, given.length, ...memory]);
    const result = this.#wasm.lacerta_decoder_set_base_group(this.#handle, group, this.#scratch);
    this.#free(...memory, ...values);
    this.#check(result, `base of group ${group}`);
    this.needsBase = false;
  }

  /** {level, numLevels, state, hasLayers, isComplete, bytesUsed, numGroups} as lacerta_progress. */
  progress() {
    this.#put(this.#scratch, [kProgressSize]);
    this.#check(this.#wasm.lacerta_decoder_get_progress(this.#handle, this.#scratch), 'progress');
    const view = this.#view();
    const int = offset => view.getInt32(this.#scratch + offset, true);
    return {level: int(4), numLevels: int(8), state: int(12), hasLayers: int(16) === 1, isComplete: int(20) === 1,
      bytesUsed: Number(view.getBigUint64(this.#scratch + 24, true)), numGroups: int(32)};
  }

  /**
   * The mesh of a level, or of one group of it: {positions, normals, indices, attributes: {name: Float32Array}} in arrays of its own. normals: whether
   * smooth ones, which follow from the shape, are wanted.
   */
  read(level, {normals = false, group = kAllGroups} = {}) {
    const wasm = this.#wasm, size = this.#scratch, buffers = size + kMeshSizeSize, what = `level ${level}`;
    this.#put(size, [kMeshSizeSize]);
    this.#check(wasm.lacerta_decoder_get_mesh_size(this.#handle, level, group, size), what);
    const view = this.#view();
    const vertices = view.getUint32(size + 4, true), triangles = view.getUint32(size + 8, true), has = view.getUint32(size + 12, true);
    const components = this.#names.map((name, i) => has >>> i & 1 ? this.#componentsOf(i) : 0);
    const floats = [3 * vertices, 3 * triangles, normals ? 3 * vertices : 0, ...components.map(count => count * vertices)];
    const memory = this.#allocate(4 * (floats.reduce((sum, count) => sum + count, 0) + components.length) || 4);
    let end = memory;
    const at = floats.map(count => (end += 4 * count) - 4 * count);
    this.#put(end, at.slice(3).map((place, i) => components[i] > 0 ? place : 0));
    this.#put(buffers, [kBuffersSize, vertices, triangles, components.length, at[0], normals ? at[2] : 0, at[1], end]);
    try {
      this.#check(wasm.lacerta_decoder_read_mesh(this.#handle, level, group, buffers), what);
      const copy = (Type, i) => new Type(wasm.memory.buffer, at[i], floats[i]).slice();
      const attributes = {};
      this.#names.forEach((name, i) => { if (components[i] > 0) attributes[name] = copy(Float32Array, i + 3); });
      return {positions: copy(Float32Array, 0), normals: normals ? copy(Float32Array, 2) : null, indices: copy(Uint32Array, 1), attributes};
    } finally {
      this.#free(memory);
    }
  }

  dispose() {
    if (this.#handle !== 0) this.#wasm.lacerta_decoder_destroy(this.#handle);
    this.#free(this.#scratch);
    this.#handle = this.#scratch = 0;
  }

  #componentsOf(attribute) {
    this.#put(this.#scratch, [kAttributeSize]);
    this.#check(this.#wasm.lacerta_decoder_get_attribute(this.#handle, attribute, this.#scratch), 'attribute');
    return this.#view().getUint32(this.#scratch + 4, true);
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

  #put(at, numbers) { new Uint32Array(this.#wasm.memory.buffer, at, numbers.length).set(numbers); }
  #free(...memory) { memory.forEach(at => this.#wasm.free(at)); }

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
