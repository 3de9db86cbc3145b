// LACERTA_mesh_progressive for glTF-Transform:
//   const io = new NodeIO().registerExtensions([...ALL_EXTENSIONS, LacertaMeshProgressive]);
// Progressive meshes hang on their nodes as ProgressiveMesh, out of sight of transforms that edit vertices, which would tear stream and
// fallback apart; nodes, materials and all else can be edited. Writing puts the same bytes back. toLevel() makes ordinary meshes of them.
import {Extension, ExtensionProperty, PropertyType, RefMap} from '@gltf-transform/core';
import {baseParts, extensionName, parseProgressive, progressivePrimitive} from './asset.js';
import {Decoder, instantiate} from './decoder.js';
import {mapValues, piecesOf, takeAccessor, viewBytes} from './fallback_accessors.js';
import {compile} from './index.js';
import {baseNames, gatherWeights, spreadWeights} from './joint_weights.js';
import {takeTargets} from './target_channels.js';

const kDraco = 'KHR_draco_mesh_compression';
const kTypes = {1: 'SCALAR', 2: 'VEC2', 3: 'VEC3', 4: 'VEC4'};

/** All streams of a document: on its root. */
export class ProgressiveStreams extends ExtensionProperty {
  init() {
    this.extensionName = extensionName;
    this.propertyType = 'ProgressiveStreams';
    this.parentTypes = [PropertyType.ROOT];
  }
  getDefaults() { return Object.assign(super.getDefaults(), {extension: null, data: null}); }
  /** The extension's JSON, without bufferViews. */
  getExtensionJson() { return this.get('extension'); }
  setExtensionJson(json) { return this.set('extension', json); }
  /** The segments of all streams. */
  getData() { return this.get('data'); }
  setData(bytes) { return this.set('data', bytes); }
}

/** A mesh whose primitives show streams: on a node, in the place of a Mesh. */
export class ProgressiveMesh extends ExtensionProperty {
  init() {
    this.extensionName = extensionName;
    this.propertyType = 'ProgressiveMesh';
    this.parentTypes = [PropertyType.NODE];
  }
  getDefaults() { return Object.assign(super.getDefaults(), {primitives: [], materials: new RefMap(), weights: []}); }
  /** [{stream, group, def: the primitive's JSON, accessors: its fallback, targets: those of its morph targets}] */
  getPrimitives() { return this.get('primitives'); }
  setPrimitives(primitives) { return this.set('primitives', primitives); }
  /** Of morph targets. */
  getWeights() { return this.get('weights'); }
  setWeights(weights) { return this.set('weights', weights); }
  getMaterial(primitive) { return this.getRefMap('materials', String(primitive)); }
  setMaterial(primitive, material) { return this.setRefMap('materials', String(primitive), material); }
}

export class LacertaMeshProgressive extends Extension {
  extensionName = extensionName;
  prereadTypes = [PropertyType.BUFFER];
  prewriteTypes = [PropertyType.BUFFER];
  static EXTENSION_NAME = extensionName;
  #taken;     // between preread and read

  // Takes progressive meshes out of the JSON before anybody else sees it.
  preread(context) {
    const {jsonDoc} = context, {json} = jsonDoc;
    const progressive = parseProgressive(json);
    if (!progressive) return this;
    const taken = this.#taken = {meshes: new Map(), nodes: new Map()};
    const pieces = [progressive.data, progressive.refinements].filter(view => view !== undefined).map(view => viewBytes(jsonDoc, view));
    taken.data = new Uint8Array(pieces.reduce((sum, piece) => sum + piece.length, 0));
    pieces.reduce((at, piece) => (taken.data.set(piece, at), at + piece.length), 0);
    const {data, refinements, ...extension} = json.extensions[extensionName];
    taken.extension = extension;
    delete json.extensions[extensionName];
    (json.meshes ?? []).forEach((mesh, m) => {
      const primitives = mesh.primitives.map(def => ({def, ...progressivePrimitive(def, progressive)}));
      const marked = primitives.filter(({stream}) => stream !== undefined);
      if (marked.length === 0) return;
      if (marked.length < primitives.length) {
        this.document.getLogger().warn(`[${extensionName}] mesh ${m} has other primitives beside progressive ones; it keeps its fallback alone.`);
        for (const {def} of marked) delete def.extensions[extensionName];
        return;
      }
      for (const primitive of primitives) {
        const {attributes, indices, targets = []} = primitive.def, take = index => takeAccessor(jsonDoc, index);
        primitive.accessors = mapValues(attributes, take);
        primitive.targets = targets.map(target => mapValues(target, take));
        if (indices !== undefined) primitive.indices = take(indices);
      }
      taken.meshes.set(m, {name: mesh.name, extras: mesh.extras, weights: mesh.weights, primitives});
      mesh.primitives = [];
    });
    (json.nodes ?? []).forEach((node, n) => {
      if (!taken.meshes.has(node.mesh)) return;
      taken.nodes.set(n, node.mesh);
      delete node.mesh;
    });
    return this;
  }

  read(context) {
    const taken = this.#taken;
    if (!taken) return this;
    const root = new ProgressiveStreams(this.document.getGraph(), 'streams').setExtensionJson(taken.extension).setData(taken.data);
    this.document.getRoot().setExtension(extensionName, root);
    const made = new Map();
    for (const [m, {name, extras, weights = [], primitives}] of taken.meshes) {
      const mesh = new ProgressiveMesh(this.document.getGraph(), name ?? '').setPrimitives(primitives).setWeights(weights);
      if (extras) mesh.setExtras(extras);
      primitives.forEach(({def}, i) => { if (def.material !== undefined) mesh.setMaterial(i, context.materials[def.material]); });
      made.set(m, mesh);
      context.meshes[m].dispose();
    }
    for (const [n, m] of taken.nodes) context.nodes[n].setExtension(extensionName, made.get(m));
    // What no other primitive wants needs no encoder when it is written.
    const stillUsed = context.jsonDoc.json.meshes.some(({primitives}) => primitives.some(def => def.extensions?.[kDraco]));
    for (const extension of this.document.getRoot().listExtensionsUsed()) {
      if (extension.extensionName === kDraco && !stillUsed) extension.dispose();
    }
    this.#taken = undefined;
    return this;
  }

  prewrite(context) {
    const streams = this.document.getRoot().getExtension(extensionName);
    if (!streams) return this;
    const buffer = this.document.getRoot().listBuffers()[0] ?? this.document.createBuffer();
    const views = context.otherBufferViews.get(buffer) ?? [];
    context.otherBufferViews.set(buffer, views);
    const add = bytes => { if (bytes && !views.includes(bytes)) views.push(bytes); };
    // Last, so that the front of the file shows everything coarsely.
    for (const mesh of this.#meshes()) for (const primitive of mesh.getPrimitives()) piecesOf(primitive).forEach(add);
    add(streams.getData());
    return this;
  }

  write(context) {
    const streams = this.document.getRoot().getExtension(extensionName), {json} = context.jsonDoc;
    if (!streams) return this;
    const data = context.otherBufferViewsIndexMap.get(streams.getData());
    json.extensions = {...json.extensions, [extensionName]: {...streams.getExtensionJson(), data}};
    const progressive = parseProgressive(json);
    const addAccessor = accessor => {
      if (!accessor) return undefined;
      json.accessors ??= [];
      const {bytes, sparse, def} = accessor, at = piece => ({bufferView: context.otherBufferViewsIndexMap.get(piece)});
      json.accessors.push({...(bytes && at(bytes)), ...def,
        ...(sparse && {sparse: {count: sparse.count, indices: {...at(sparse.indices), componentType: sparse.componentType}, values: at(sparse.values)}})});
      return json.accessors.length - 1;
    };
    const baseViews = new Map();
    const baseView = (stream, group) => {
      const key = `${stream} ${group}`;
      if (!baseViews.has(key)) {
        const part = baseParts(progressive.streams[stream])[group], view = json.bufferViews[data];
        const byteOffset = (view.byteOffset ?? 0) + progressive.streams[stream].segments[0].offset + part.begin;
        json.bufferViews.push({buffer: view.buffer, byteOffset, byteLength: part.end - part.begin});
        baseViews.set(key, json.bufferViews.length - 1);
      }
      return baseViews.get(key);
    };
    const written = new Map(), uses = new Set();
    for (const node of this.document.getRoot().listNodes()) {
      const mesh = node.getExtension(extensionName);
      if (!mesh) continue;
      if (!written.has(mesh)) {
        const primitives = mesh.getPrimitives().map(({def, stream, group, accessors, indices, targets}, i) => {
          const material = mesh.getMaterial(i), extensions = {...def.extensions};
          if (extensions[kDraco]) {
            extensions[kDraco] = {...extensions[kDraco], bufferView: baseView(stream, group)};
            uses.add(kDraco);
          }
          const {material: unused, ...rest} = def;
          return {...rest, attributes: mapValues(accessors, addAccessor), ...(targets.length > 0 && {targets: targets.map(target => mapValues(target, addAccessor))}),
            indices: addAccessor(indices), ...(material ? {material: context.materialIndexMap.get(material)} : {}), extensions};
        });
        json.meshes = [...(json.meshes ?? []), {...(mesh.getName() ? {name: mesh.getName()} : {}), primitives,
          ...(mesh.getWeights().length > 0 ? {weights: mesh.getWeights()} : {}), ...(Object.keys(mesh.getExtras()).length > 0 ? {extras: mesh.getExtras()} : {})}];
        written.set(mesh, json.meshes.length - 1);
      }
      const def = json.nodes[context.nodeIndexMap.get(node)];
      def.mesh = written.get(mesh);
      delete def.extensions?.[extensionName];
      if (def.extensions && Object.keys(def.extensions).length === 0) delete def.extensions;
    }
    for (const name of uses) {
      for (const list of ['extensionsUsed', 'extensionsRequired']) json[list] = [...new Set([...(json[list] ?? []), name])];
    }
    return this;
  }

  #meshes() {
    return new Set(this.document.getRoot().listNodes().map(node => node.getExtension(extensionName)).filter(Boolean));
  }
}

// A Draco stream as the host's Draco decodes it: {positions, indices, attributes}. module: of npm draco3d or draco3dgltf; names: of the attributes
// with the ids 1, 2, ...
function decodeBase(module, bytes, names) {
  const decoder = new module.Decoder(), mesh = new module.Mesh(), buffer = new module.DecoderBuffer();
  try {
    buffer.Init(new Int8Array(bytes.buffer, bytes.byteOffset, bytes.length), bytes.length);
    const status = decoder.DecodeBufferToMesh(buffer, mesh);
    if (!status.ok()) throw new Error(`the base: ${status.error_msg()}`);
    const points = mesh.num_points(), faces = mesh.num_faces();
    const take = (Type, count, fill) => {
      const memory = module._malloc(4 * count);
      fill(4 * count, memory);
      const array = new Type(module.HEAPU8.buffer, memory, count).slice();
      module._free(memory);
      return array;
    };
    const floats = attribute => take(Float32Array, attribute.num_components() * points, (size, memory) => {
      decoder.GetAttributeDataArrayForAllPoints(mesh, attribute, module.DT_FLOAT32, size, memory);
    });
    const indices = take(Uint32Array, 3 * faces, (size, memory) => decoder.GetTrianglesUInt32Array(mesh, size, memory));
    const positions = floats(decoder.GetAttribute(mesh, decoder.GetAttributeId(mesh, module.POSITION))), attributes = {};
    for (let i = 0; i < mesh.num_attributes(); ++i) {
      const attribute = decoder.GetAttribute(mesh, i), name = names[attribute.unique_id() - 1];
      if (name !== undefined) attributes[name] = floats(attribute);
    }
    return {positions, indices, attributes};
  } finally {
    for (const object of [buffer, mesh, decoder]) module.destroy(object);
  }
}

/**
 * A transform that decodes all progressive meshes to a level (default: the finest that is there) and makes ordinary meshes of them; the extension
 * is gone afterwards. draco3d: a decoder module, for bases in Draco form.
 */
export function toLevel({level = Infinity, draco3d} = {}) {
  return async document => {
    const root = document.getRoot(), streams = root.getExtension(extensionName);
    if (!streams) return;
    const wasm = await instantiate(await compile()), data = streams.getData();
    const views = [{}], progressive = parseProgressive({bufferViews: views, extensions: {[extensionName]: {...streams.getExtensionJson(), data: 0}}});
    const decoded = progressive.streams.map(stream => decodeStream(wasm, stream, data, level, draco3d));
    const buffer = root.listBuffers()[0] ?? document.createBuffer(), made = new Map();
    for (const node of root.listNodes()) {
      const progressiveMesh = node.getExtension(extensionName);
      if (!progressiveMesh) continue;
      if (!made.has(progressiveMesh)) {
        const mesh = document.createMesh(progressiveMesh.getName()).setExtras(progressiveMesh.getExtras()).setWeights(progressiveMesh.getWeights());
        progressiveMesh.getPrimitives().forEach(({stream, group, targets: announced}, i) => {
          const {positions, normals, indices} = decoded[stream][group];
          const {attributes, targets} = takeTargets(decoded[stream][group].attributes ?? {}, positions.length / 3, announced.length);
          const accessor = (type, array) => document.createAccessor().setType(type).setArray(array).setBuffer(buffer);
          const primitive = document.createPrimitive().setMaterial(progressiveMesh.getMaterial(i)).setIndices(accessor('SCALAR', indices))
            .setAttribute('POSITION', accessor('VEC3', positions));
          if (normals) primitive.setAttribute('NORMAL', accessor('VEC3', normals));
          for (const [name, values] of Object.entries(gatherWeights(progressive.streams[stream].joints, attributes))) {
            primitive.setAttribute(name, accessor(kTypes[3 * values.length / positions.length], values));
          }
          for (const [t, target] of targets.entries()) {
            const added = document.createPrimitiveTarget(mesh.getExtras().targetNames?.[t]);
            for (const [name, offsets] of Object.entries(target)) added.setAttribute(name, accessor('VEC3', offsets));
            primitive.addTarget(added);
          }
          mesh.addPrimitive(primitive);
        });
        made.set(progressiveMesh, mesh);
      }
      node.setExtension(extensionName, null).setMesh(made.get(progressiveMesh));
    }
    streams.dispose();
    for (const extension of root.listExtensionsUsed()) if (extension.extensionName === extensionName) extension.dispose();
  };
}

// The meshes of a stream's groups.
function decodeStream(wasm, stream, data, level, draco3d) {
  const {baseLengths, attributes = []} = stream;
  const decoder = new Decoder(wasm, {baseSize: stream.segments[0].length, baseLengths, attributes, maxLevel: Number.isFinite(level) ? level : -1});
  try {
    for (const {offset, length} of stream.segments) {
      if (offset + length > data.length) break;  // trimmed
      decoder.append(data.subarray(offset, offset + length));
      if (!decoder.needsBase) continue;
      if (!draco3d) throw new Error(`${extensionName}: the base is in Draco form; give a draco3d decoder module`);
      const section = decoder.baseSection();
      for (const [g, {begin, end}] of baseParts(stream).entries()) {
        const base = decodeBase(draco3d, baseLengths ? section.subarray(begin, end) : section, baseNames(stream));
        base.attributes = spreadWeights(stream.joints, base.attributes);
        if (baseLengths) decoder.setBaseGroup(g, base);
        else decoder.setBase(base.positions, base.indices);
      }
    }
    const {level: finest} = decoder.progress();
    return baseLengths ? baseLengths.map((unused, group) => decoder.read(finest, {group})) : [decoder.read(finest, {normals: stream.normals === 'smooth'})];
  } finally {
    decoder.dispose();
  }
}
