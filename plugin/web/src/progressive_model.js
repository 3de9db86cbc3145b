// The progressive surfaces of one loaded glTF: which level each shows, where the bytes come from, what the program hears of it.
import {chooseParts, mostValuable, pixelsPerUnit} from './level_choice.js';
import {SegmentFeed} from './segment_feed.js';
import {Surface} from './surface.js';

const kDefaults = {pixelError: 1, maxTriangles: Infinity, maxLevel: Infinity};

/**
 * Events: 'level' {surface, level, error}, 'progress' {received, total}, 'complete', 'textures' (they came after the surfaces), 'problem' {message}: one for each thing that went wrong; what
 * was shown stays.
 */
export class ProgressiveModel extends EventTarget {
  surfaces = [];      // one per stream that is shown
  pixelError;         // pixels that a level may be off on the screen
  maxTriangles;       // of all surfaces together
  maxLevel;           // quality slider: no part above it
  #feed;
  #progressive;
  #abort = new AbortController();
  #problems = new Set();
  #view;              // of update(): {camera, height}; without, every surface gets its finest level
  #source;
  #running;
  #isRead = false;    // all that the source gives

  constructor(progressive, options = {}) {
    super();
    this.#progressive = progressive;
    Object.assign(this, kDefaults, Object.fromEntries(Object.keys(kDefaults).filter(key => options[key] !== undefined).map(key => [key, options[key]])));
    this.#feed = new SegmentFeed(progressive, (stream, part, bytes) => {
      this.surfaces.find(surface => surface.index === stream)?.take(part, bytes);
    });
  }

  /** surfaces: made of Surface options; each begins with its base. */
  async begin(pool, descriptions, three, options) {
    this.surfaces = descriptions.map(description => new Surface({
      ...description, pool, three, options, stream: this.#progressive.streams[description.index],
      onLevel: detail => {
        this.#emit('level', detail);
        if (this.surfaces.every(surface => surface.isComplete)) this.#emit('complete', {});
      },
      onProblem: message => this.#problem(message),
    }));
    await Promise.all(this.surfaces.map(surface => surface.begin()));
  }

  /** Messages of all 'problem' events so far; a small file may have had its problem before anybody listens. */
  get problems() { return [...this.#problems]; }
  get received() { return this.#feed.bytes; }
  get total() { return this.#progressive.length; }
  get signal() { return this.#abort.signal; }
  get feed() { return this.#feed; }

  /** Bytes at `offset` from the front of the streams' data. */
  push(offset, bytes) {
    if (this.signal.aborted) return;
    this.#feed.push(offset, bytes);
    this.#emit('progress', {received: this.received, total: this.total});
  }

  /** Where the bytes come from: an async function of this model and a signal, called again by resume(). Its failure is told once. */
  read(source) {
    this.#source = source;
    return this.resume();
  }
  resume() {
    if (this.#running || this.#isRead || !this.#source) return this.#running ?? Promise.resolve();
    if (this.signal.aborted) this.#abort = new AbortController();
    const {signal} = this;
    return this.#running = this.#source(this, signal).then(() => {
      const {available} = this.#progressive;
      if (this.received < available) throw new Error(`the file ends early: ${this.received} of ${available} bytes of the surfaces are there; the last good level stays`);
      this.#isRead = !signal.aborted;
    }).catch(error => {
      if (!signal.aborted) this.#problem(error.message);
    }).finally(() => { this.#running = undefined; });
  }
  /** Ends the download; what is there stays, and resume() goes on. */
  abort() { this.#abort.abort(new Error('aborted')); }

  /** Textures that were not there when the surfaces were: a promise that they are on their materials. */
  addTextures(done) {
    return done.then(() => this.#emit('textures', {}), error => this.#problem(`textures cannot be shown (${error.message})`));
  }

  /** Call it before each frame, or when the camera moved: chooses the levels that the view is worth. height: pixels of the viewport. */
  update(camera, height) {
    this.#view = {camera, height};
    this.#choose();
  }

  /** The segment that is worth most now of those that are wanted and not there; undefined: none. */
  nextSegment() {
    const items = this.#items(), wanted = this.#wanted(items);
    const available = this.surfaces.map(surface => surface.receivedPart);
    const streams = this.surfaces.map(surface => surface.stream);
    return mostValuable(items, available, wanted, {streams});
  }

  /** Resolves when all surfaces show part `part` (or their last), or better. */
  whenLevel(part) { return Promise.all(this.surfaces.map(surface => surface.when(part))); }

  dispose() {
    this.abort();
    for (const surface of this.surfaces) surface.dispose();
    this.surfaces = [];
    this.#source = undefined;
  }

  #items() {
    return this.surfaces.map(surface => {
      const {errors, triangleCounts} = surface.stream;
      if (!this.#view) return {errors, triangleCounts, scale: 1};
      const {camera, height} = this.#view;
      const {distance, stretch, visible} = surface.seenFrom(camera);
      const pixels = camera.isPerspectiveCamera ? pixelsPerUnit(distance, camera.fov * Math.PI / 180, height) / camera.zoom ** -1
        : height * camera.zoom / (camera.top - camera.bottom);
      return {errors, triangleCounts, scale: visible ? pixels * stretch : 0};
    });
  }
  #wanted(items) {
    const parts = this.#view ? chooseParts(items, this) : chooseParts(items, {pixelError: 0, maxTriangles: this.maxTriangles});
    return parts.map(part => Math.min(part, this.maxLevel));
  }
  #choose() {
    const wanted = this.#wanted(this.#items());
    this.surfaces.forEach((surface, i) => surface.show(wanted[i]));
  }
  setMaxLevel(part) {
    this.maxLevel = part;
    this.#choose();
  }

  #emit(type, detail) { this.dispatchEvent(Object.assign(new Event(type), {detail})); }
  #problem(message) {
    if (this.#problems.has(message)) return;
    this.#problems.add(message);
    this.#emit('problem', {message});
  }
}
