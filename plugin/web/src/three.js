// LACERTA_mesh_progressive for the GLTFLoader of three.js:
//   loader.register(parser => new LacertaExtension(parser, {three: THREE}));
//   const gltf = await loader.loadAsync('model.glb');     // shows its base
//   gltf.userData.lacerta.addEventListener('level', ...);  // a ProgressiveModel
// or, to show the base before the file has arrived, LacertaLoader.
import {nameInThree} from './arrays.js';
import {extensionName, parseProgressive, progressivePrimitive} from './asset.js';
import {GrowingBytes, formatGlb, imageRanges, joined, neededRanges, readHead} from './glb.js';
import {createPool} from './inline.js';
import {putTextures, takeTextures} from './late_textures.js';
import {ProgressiveModel} from './progressive_model.js';
import {targetAttribute} from './target_channels.js';
import {transfer} from './transfer.js';

let sharedPool;
const poolOf = options => options.pool ?? (sharedPool ??= createPool({size: options.workers}));
const hasData = (json, primitive) => primitive.extensions?.KHR_draco_mesh_compression !== undefined ||
  json.accessors[primitive.attributes.POSITION]?.bufferView !== undefined;

export class LacertaExtension {
  name = extensionName;
  #parser;
  #options;
  #progressive;
  #problem;
  #materials;  // with their textures, while these are not there

  /**
   * options: {three: the module, dracoLoader (for assets without fallback; GLTFLoader's if absent), pool, workers, pixelError, maxTriangles, source, onModel,
   * images: a promise of the first buffer, where its images are not there yet}
   */
  constructor(parser, options) {
    this.#parser = parser;
    this.#options = options;
    try {
      this.#progressive = parseProgressive(parser.json);
    } catch (error) {
      this.#problem = error.message;
    }
  }

  beforeRoot() {
    // Accessors without data describe the finest level; nobody needs its zeros.
    const {json} = this.#parser;
    if (this.#options.images) this.#materials = takeTextures(json);
    for (const mesh of json.meshes ?? []) {
      for (const primitive of mesh.primitives) {
        if (primitive.extensions?.[extensionName] === undefined || hasData(json, primitive)) continue;
        for (const accessor of [...Object.values(primitive.attributes), primitive.indices]) json.accessors[accessor].count = 3;
      }
    }
    return null;
  }

  async afterRoot(gltf) {
    if (!this.#progressive) {
      if (this.#problem) (this.#options.onProblem ?? console.warn)(`${this.#problem}; the fallback is shown`);
      return;
    }
    const model = new ProgressiveModel(this.#progressive, this.#options);
    gltf.userData.lacerta = model;
    this.#options.onModel?.(model);
    const descriptions = this.#collect(gltf);
    await model.begin(await poolOf(this.#options), descriptions, this.#options.three, this.#options);
    this.#options.images?.then(body => model.addTextures(putTextures(gltf, this.#materials, body)));
    const reading = model.read(this.#options.source ?? (target => this.#readParsed(target)));
    // Objects without a fallback have nothing to show before.
    const hidden = model.surfaces.filter((surface, i) => descriptions[i].groups.some(group => group.objects.length > 0 && !group.hasFallback));
    await Promise.race([Promise.allSettled(hidden.map(surface => surface.when(0))), reading.then(() => new Promise(resolve => setTimeout(resolve, 2000)))]);
  }

  // Objects by stream and group. Streams that no object shows are left out.
  #collect(gltf) {
    const {json, associations} = this.#parser, byStream = new Map();
    const add = (primitive, object) => {
      const found = progressivePrimitive(primitive, this.#progressive);
      if (!found) return;
      const {stream, group} = found, {baseLengths = [0]} = this.#progressive.streams[stream];
      if (!byStream.has(stream)) {
        byStream.set(stream, {index: stream, groups: baseLengths.map(() => ({objects: [], hasFallback: false, attributes: {}, numTargets: 0}))});
      }
      const entry = byStream.get(stream).groups[group];
      const {attributes, targets = []} = primitive, {attributes: names = []} = this.#progressive.streams[stream];
      const ofTargets = names.filter(name => targets.some(target => targetAttribute(name) in target));
      entry.attributes = {...(primitive.extensions.KHR_draco_mesh_compression?.attributes ?? attributes), ...Object.fromEntries(ofTargets.map(name => [name]))};
      entry.numTargets = targets.length;
      if (!object) return;
      entry.hasFallback ||= hasData(json, primitive);
      entry.objects.push(object);
    };
    // Bases of groups that are not in the scene are wanted, too.
    for (const mesh of json.meshes ?? []) for (const primitive of mesh.primitives) add(primitive);
    for (const scene of gltf.scenes) {
      scene.traverse(object => {
        const {meshes, primitives} = associations.get(object) ?? {};
        const primitive = object.isMesh && json.meshes[meshes]?.primitives[primitives ?? 0];
        if (primitive) add(primitive, object);
      });
    }
    const dracoLoader = this.#options.dracoLoader ?? this.#parser.extensions?.KHR_draco_mesh_compression?.dracoLoader;
    // attributes: those that the group has; their ids in the stream follow from their place among the names.
    const decodeBase = dracoLoader && ((bytes, names, attributes) => new Promise((resolve, reject) => {
      const present = names.filter(name => name in attributes), types = {position: 'Float32Array'}, ids = {position: 0};
      for (const name of present) [types[nameInThree(name)], ids[nameInThree(name)]] = ['Float32Array', names.indexOf(name) + 1];
      if (names.length === 0) dracoLoader.parse(bytes.buffer, resolve, reject);
      else dracoLoader.decodeDracoFile(bytes.buffer, resolve, ids, types, undefined, reject);
    }));
    const shown = [...byStream.values()].filter(({groups}) => groups.some(group => group.objects.length > 0));
    for (const {index, groups} of shown) if (this.#progressive.streams[index].normals === 'smooth') this.#smooth(groups[0].objects);
    return shown.map(description => ({...description, decodeBase}));
  }

  // GLTFLoader shades meshes without normals flat; these have normals that follow from their shape.
  #smooth(objects) {
    const smoothed = new Map();
    for (const object of objects) {
      if (!object.geometry.attributes.normal && object.geometry.attributes.position.count > 3) object.geometry.computeVertexNormals();
      if (!object.material.flatShading) continue;
      if (!smoothed.has(object.material)) smoothed.set(object.material, Object.assign(object.material.clone(), {flatShading: false}));
      object.material = smoothed.get(object.material);
    }
  }

  // The data of a file that is there as a whole; refinements in a file of their own come over the network.
  async #readParsed(model) {
    const {data, refinements} = this.#progressive, {json} = this.#parser;
    const bytes = new Uint8Array(await this.#parser.getDependency('bufferView', data));
    model.push(0, bytes);
    if (refinements === undefined) return;
    const view = json.bufferViews[refinements], begin = view.byteOffset ?? 0;
    const url = new URL(json.buffers[view.buffer].uri, new URL(this.#parser.options.path || '.', globalThis.location?.href ?? 'file:///')).href;
    await transfer(url, (offset, piece) => model.push(bytes.length + offset - begin, piece), {begin, end: begin + view.byteLength, signal: model.signal});
  }
}

/** Loads GLB files so that their base is on the screen as soon as its bytes are there. */
export class LacertaLoader {
  #makeLoader;
  #options;

  /** makeLoader: () => a GLTFLoader with whatever it needs (DRACOLoader, ...). options: as for LacertaExtension. */
  constructor(makeLoader, options) {
    this.#makeLoader = makeLoader;
    this.#options = options;
  }

  /**
   * Resolves to the glTF when its base can be shown. mode: 'stream', one request read as it arrives, or 'range', a request per segment, most valuable
   * first. Rejects where there is not even a base. gltf.userData.lacerta is undefined for assets without our extension.
   */
  load(url, {mode = 'stream', signal, ...transferOptions} = {}) {
    Promise.resolve(poolOf(this.#options)).then(pool => pool.warm()).catch(() => {});  // while the first bytes come; failures are told when it is needed
    return mode === 'range' ? this.#loadRanges(url, {signal, ...transferOptions}) : this.#loadStream(url, {signal, ...transferOptions});
  }

  #parse(buffer, url, options) {
    const loader = this.#makeLoader();
    loader.register(parser => new LacertaExtension(parser, {...this.#options, ...options}));
    return loader.parseAsync(buffer, new URL('.', new URL(url, globalThis.location?.href)).href);
  }

  async #loadStream(url, options) {
    const body = new GrowingBytes();
    let head, needed = Infinity, dataAt = 0, end = 0, model, started, resolveStarted, resolveImages;
    const isStarted = new Promise(resolve => { resolveStarted = resolve; });
    const images = new Promise(resolve => { resolveImages = resolve; });
    const stop = new AbortController();
    options.signal?.addEventListener('abort', () => { stop.abort(options.signal.reason); model?.abort(); });
    const giveImages = () => { if (end > needed && body.length >= end) resolveImages(body.bytes.slice(head.binOffset).buffer); };
    const onBytes = (offset, bytes) => {
      model?.push(offset - dataAt, bytes);
      if (model && body.length >= end) return;
      body.append(bytes);
      if (model) giveImages();
      head ??= readHead(body.bytes);
      if (!head || started) return;
      const progressive = safely(() => parseProgressive(head.json));
      if (!progressive || head.json.bufferViews[progressive.data].buffer !== 0) return;  // loaded as a whole
      dataAt = head.binOffset + (head.json.bufferViews[progressive.data].byteOffset ?? 0);
      needed = head.binOffset + Math.max(...neededRanges(head.json, progressive).map(range => range.end));
      end = head.binOffset + Math.max(0, ...imageRanges(head.json).map(range => range.end));
      if (body.length >= needed) resolveStarted(started = true);
    };
    const read = transfer(url, onBytes, {...options, signal: stop.signal});
    await Promise.race([isStarted, read]);
    if (!started && (head === undefined || needed < Infinity)) throw new Error(`${url}: the file ends early, after ${body.length} bytes, with nothing to show`);
    if (!started) return this.#parse(body.bytes.slice().buffer, url);
    const source = async (target, signal) => {
      if (model) {
        await transfer(url, onBytes, {...options, begin: body.length < end ? body.length : dataAt + firstGap(target), signal});
      } else {
        model = target;
        model.push(0, body.bytes.subarray(dataAt));
        giveImages();
        signal.addEventListener('abort', () => stop.abort(signal.reason), {once: true});
        await read;
      }
      if (body.length < end && target.feed.isWhole) throw new Error(missingTextures);
    };
    return this.#parse(formatGlb(head.json, body.bytes.slice(head.binOffset, needed)), url, {source, images: end > needed ? images : undefined});
  }

  async #loadRanges(url, options) {
    const body = new GrowingBytes();
    const get = (begin, end, onBytes, signal = options.signal) => transfer(url, onBytes, {...options, begin, end, signal});
    await get(0, 16384, (offset, bytes) => body.append(bytes));
    while (readHead(body.bytes) === undefined && body.length > 0) {
      const before = body.length;
      await get(before, before * 4, (offset, bytes) => body.append(bytes));
      if (body.length === before) break;
    }
    const head = readHead(body.bytes), progressive = head && safely(() => parseProgressive(head.json));
    if (!progressive || head.json.bufferViews[progressive.data].buffer !== 0) {
      await get(body.length, undefined, (offset, bytes) => body.append(bytes));
      return this.#parse(body.bytes.slice().buffer, url);
    }
    const {binOffset} = head, ranges = neededRanges(head.json, progressive);
    const front = new Uint8Array(Math.max(...ranges.map(range => range.end)));
    const fill = (offset, bytes) => front.set(bytes.subarray(0, Math.max(0, front.length - offset)), offset);
    fill(0, body.bytes.subarray(binOffset));
    for (const {begin, end} of joined(ranges)) {
      const from = Math.max(begin, body.length - binOffset);
      if (from < end) await get(binOffset + from, binOffset + end, (offset, bytes) => fill(offset - binOffset, bytes));
    }
    const view = head.json.bufferViews[progressive.data], dataAt = binOffset + (view.byteOffset ?? 0);
    const bases = progressive.order.filter(segment => segment.part === 0).reduce((end, base) => Math.max(end, base.offset + base.length), 0);
    const late = joined(imageRanges(head.json));
    let resolveImages, isLate = late.length > 0;
    const images = new Promise(resolve => { resolveImages = resolve; });
    const readImages = async signal => {
      const whole = new Uint8Array(Math.max(front.length, late.at(-1).end));
      whole.set(front);
      for (const {begin, end} of late) {
        const got = await get(binOffset + begin, binOffset + end, (offset, bytes) => whole.set(bytes, offset - binOffset), signal);
        if (got < end - begin) throw new Error(missingTextures);
      }
      isLate = false;
      resolveImages(whole.buffer);
    };
    const source = async (model, signal) => {
      model.push(0, front.subarray(dataAt - binOffset, dataAt - binOffset + bases));
      model.push(0, body.bytes.subarray(dataAt));
      for (let next; !signal.aborted && !model.feed.isWhole; ) {
        next = model.nextSegment();
        if (!next && isLate) await readImages(signal);
        if (!next) {  // nothing is worth it until the view changes
          await new Promise(resolve => setTimeout(resolve, 100));
          continue;
        }
        const begin = dataAt + next.offset + model.feed.received(next);
        const got = await get(begin, dataAt + next.offset + next.length, (offset, bytes) => model.push(offset - dataAt, bytes), signal);
        if (got === 0 && next.length > 0) break;  // the file was trimmed
      }
      if (isLate && !signal.aborted) await readImages(signal);
    };
    return this.#parse(formatGlb(head.json, front), url, {source, images: isLate ? images : undefined});
  }
}

const missingTextures = 'the file ends early: its textures are missing';
const safely = call => { try { return call(); } catch { return undefined; } };

// Where the first segment that is not whole goes on.
function firstGap(model) {
  const {feed} = model;
  let gap = Infinity;
  for (const surface of model.surfaces) {
    for (const segment of surface.stream.segments) if (!feed.isComplete(segment)) gap = Math.min(gap, segment.offset + feed.received(segment));
  }
  return gap === Infinity ? 0 : gap;
}
