// One stream on the screen: its decoder in a worker, the part that is shown, and the objects of three.js that show it.
import {nameInThree, toBase} from './arrays.js';
import {baseParts} from './asset.js';
import {baseNames, gatherWeights, spreadWeights} from './joint_weights.js';
import {takeTargets, targetAttribute} from './target_channels.js';

const isCompact = bytes => bytes.length > 11 && bytes[8] === 0x4c && bytes[11] >> 4 === 1;
// At most one new geometry per frame, but frames that take long, or none in a hidden page, hold nothing up.
const nextFrame = () => new Promise(resolve => {
  globalThis.requestAnimationFrame?.(resolve);
  setTimeout(resolve, 30);
});

export class Surface {
  part = -1;           // shown; -1: the fallback
  receivedPart = -1;   // the last one whose bytes are there
  #options;
  #decoder;
  #available = -1;     // decoded
  #wanted = Infinity;
  #busy = false;
  #disposed = false;
  #failed = false;
  #queue = Promise.resolve();  // of calls to the decoder that carry bytes
  #waiting = [];

  /**
   * options: {index, stream (of parseProgressive), groups: [{objects: meshes, hasFallback, attributes: names in glTF, numTargets}] by group, decodeBase, pool, three,
   * onLevel, onProblem}. A stream without attributes has one group.
   */
  constructor(options) {
    this.#options = options;
    this.index = options.index;
    this.stream = options.stream;
    this.objects = options.groups.flatMap(group => group.objects);
  }

  get name() { return this.objects[0]?.name || `surface ${this.index}`; }
  get lastPart() { return this.stream.errors.length - 1; }
  get isComplete() { return this.part === this.lastPart; }

  async begin() {
    const {baseLengths, attributes} = this.stream;
    this.#decoder = this.#options.pool.create({baseSize: this.stream.segments[0].length, baseLengths, attributes,
      maxVertices: this.#options.options?.maxVertices, maxTriangles: this.#options.options?.maxTriangles});
  }

  /** The bytes of a part; parts come in order. */
  take(part, bytes) {
    if (this.#disposed || this.#failed) return;
    this.receivedPart = part;
    this.#queue = this.#queue.then(async () => {
      if (this.#disposed || this.#failed) return;
      if (part === 0 && !isCompact(bytes)) await this.#setBase(bytes);
      const progress = await this.#decoder.append(bytes);
      if (progress.level < 0) return;
      this.#checkCounts(progress);
      this.#available = progress.state;
      this.#refresh();
    }).catch(error => this.#fail(error, part));
  }

  /** Shows `part`, or the best one so far until it is there. */
  show(part) {
    this.#wanted = part;
    this.#refresh();
  }

  /** Resolves when this part, or a better one, is on the screen; rejects where that cannot be. */
  when(part) {
    const wanted = Math.min(part, this.lastPart);
    if (this.part >= wanted) return Promise.resolve();
    if (this.#failed) return Promise.reject(new Error(`${this.name} stays at level ${this.part}`));
    return new Promise((resolve, reject) => this.#waiting.push({wanted, resolve, reject}));
  }

  /** {distance of the nearest point of the bounds, stretch: length of a unit of the stream in the world, visible}. */
  seenFrom(camera) {
    const {Box3, Frustum, Matrix4, Vector3} = this.#options.three;
    const frustum = new Frustum().setFromProjectionMatrix(new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse));
    const eye = new Vector3().setFromMatrixPosition(camera.matrixWorld);
    let distance = Infinity, stretch = 0, visible = false;
    for (const object of this.objects) {
      const bounds = new Box3(new Vector3(...this.stream.min), new Vector3(...this.stream.max)).applyMatrix4(object.matrixWorld);
      distance = Math.min(distance, bounds.distanceToPoint(eye));
      stretch = Math.max(stretch, object.matrixWorld.getMaxScaleOnAxis());
      visible ||= object.visible && (!object.frustumCulled || object.isSkinnedMesh || frustum.intersectsBox(bounds));
    }
    return {distance: Math.max(distance, camera.near ?? 0), stretch, visible};
  }

  dispose() {
    this.#disposed = true;
    this.#decoder?.dispose();
    for (const {reject} of this.#waiting.splice(0)) reject(new Error('disposed'));
  }

  get #isGrouped() { return this.stream.baseLengths !== undefined; }

  async #setBase(bytes) {
    const {groups, decodeBase} = this.#options, parts = baseParts(this.stream);
    for (const [g, {objects, hasFallback, attributes}] of groups.entries()) {
      const names = baseNames(this.stream), {begin, end} = parts[g];
      const isEnough = hasFallback && !names.some(targetAttribute);  // a fallback has its morph targets beside the base
      if (!isEnough && !decodeBase) throw new Error('its base is a Draco stream, and no dracoLoader was given');
      const geometry = isEnough ? objects[0].geometry : await decodeBase(bytes.slice(begin, end), names, attributes);
      const base = toBase(geometry, names);
      base.attributes = spreadWeights(this.stream.joints, base.attributes);
      if (this.#isGrouped) await this.#decoder.setBaseGroup(g, base);
      else await this.#decoder.setBase(base.positions, base.indices);
    }
  }

  // A mesh for each group.
  async #read(level) {
    if (!this.#isGrouped) return [await this.#decoder.read(level, {normals: this.stream.normals === 'smooth'})];
    return Promise.all(this.#options.groups.map(async ({numTargets = 0}, group) => {
      const mesh = await this.#decoder.read(level, {group});
      return {...mesh, ...takeTargets(mesh.attributes, mesh.positions.length / 3, numTargets)};
    }));
  }

  // Levels are equal in their counts, states of quality layers are several per level.
  #levelOf(part) { return new Set(this.stream.vertexCounts.slice(0, part + 1)).size - 1; }

  #checkCounts({level, state}) {
    if (state > this.lastPart || level !== this.#levelOf(state)) throw new Error('its levels are not those that the asset announces');
  }

  async #refresh() {
    if (this.#busy || this.#disposed) return;
    const target = Math.min(this.#wanted, this.#available);
    if (target < 0 || target === this.part) return;
    this.#busy = true;
    try {
      const meshes = await this.#read(this.#levelOf(target));
      const count = name => meshes.reduce((sum, mesh) => sum + mesh[name].length / 3, 0), triangles = count('indices');
      if (count('positions') !== this.stream.vertexCounts[target] || triangles !== this.stream.triangleCounts[target]) {
        throw new Error('its levels are not those that the asset announces');
      }
      await nextFrame();
      if (this.#disposed) return;
      meshes.forEach((mesh, group) => this.#replace(this.#options.groups[group].objects, mesh));
      this.part = target;
      this.#options.onLevel({surface: this, level: target, error: this.stream.errors[target], triangles});
      this.#waiting = this.#waiting.filter(({wanted, resolve}) => wanted > target || resolve());
    } catch (error) {
      this.#fail(error, target);
    } finally {
      this.#busy = false;
    }
    if (!this.#failed) this.#refresh();
  }

  // Another geometry in the same objects: the frame before shows the old one, the frame after the new one.
  #replace(objects, {positions, normals, indices, attributes, targets = []}) {
    if (objects.length === 0) return;
    const {BufferGeometry, BufferAttribute, Box3, Sphere, Vector3} = this.#options.three;
    const old = objects[0].geometry, geometry = new BufferGeometry();
    geometry.name = old.name;
    geometry.userData = old.userData;
    geometry.setAttribute('position', new BufferAttribute(positions, 3));
    if (normals) geometry.setAttribute('normal', new BufferAttribute(normals, 3));
    for (const [name, values] of Object.entries(gatherWeights(this.stream.joints, attributes))) {
      geometry.setAttribute(nameInThree(name), new BufferAttribute(values, values.length * 3 / positions.length));
    }
    geometry.setIndex(new BufferAttribute(indices, 1));
    geometry.boundingBox = new Box3(new Vector3(...this.stream.min), new Vector3(...this.stream.max));
    const reach = new Vector3();  // of morph targets, as GLTFLoader has it
    for (const target of targets) {
      geometry.morphTargetsRelative = true;
      for (const [name, offsets] of Object.entries(target)) (geometry.morphAttributes[nameInThree(name)] ??= []).push(new BufferAttribute(offsets, 3));
      target.POSITION?.forEach((offset, i) => reach.setComponent(i % 3, Math.max(reach.getComponent(i % 3), Math.abs(offset))));
    }
    geometry.boundingBox.expandByVector(reach);
    geometry.boundingSphere = geometry.boundingBox.getBoundingSphere(new Sphere());
    geometry.boundingSphere.radius += this.stream.errors[0];  // coarse levels may stick out of the bounds of the finest
    for (const object of objects) object.geometry = geometry;
    old.dispose();
  }

  #fail(error, part) {
    if (this.#failed || this.#disposed) return;
    this.#failed = true;
    const shown = this.#available >= 0 ? `level ${this.#available}` : 'the fallback';
    this.#options.onProblem(`${this.name}: level ${part} cannot be shown (${error.message}); ${shown} stays`);
    for (const {reject} of this.#waiting.splice(0)) reject(error);
  }
}
