import type {ProgressiveStream} from './asset.js';
import type {DecoderPool} from './index.js';

export interface LacertaOptions {
  /** The module `three` itself, as the page imports it. */
  three: object;
  /** For assets without fallback whose base is a Draco stream, and for morph targets; that of the GLTFLoader if absent. */
  dracoLoader?: object;
  pool?: DecoderPool | Promise<DecoderPool>;
  workers?: number;
  /** Pixels that a level may be off on the screen; with update(). Default 1. */
  pixelError?: number;
  /** Of all surfaces of a model together. */
  maxTriangles?: number;
  maxLevel?: number;
  onModel?: (model: ProgressiveModel) => void;
  /** Told why an asset shows its fallback alone. Default: console.warn. */
  onProblem?: (message: string) => void;
}

export interface Surface {
  readonly index: number;
  readonly name: string;
  readonly stream: ProgressiveStream;
  /** Shown; -1: the fallback. */
  readonly part: number;
  readonly lastPart: number;
  readonly isComplete: boolean;
  readonly objects: object[];
}

/** Events: 'level' {surface, level, error, triangles}, 'progress' {received, total}, 'complete', 'textures' (on the materials,
 * where they came after the surfaces), 'problem' {message}; each in `detail`. */
export class ProgressiveModel extends EventTarget {
  readonly surfaces: Surface[];
  pixelError: number;
  maxTriangles: number;
  /** Messages of all 'problem' events so far. */
  readonly problems: string[];
  readonly received: number;
  readonly total: number;
  /** Chooses levels by their error on the screen; height: pixels of the viewport. */
  update(camera: object, height: number): void;
  setMaxLevel(level: number): void;
  whenLevel(level: number): Promise<void[]>;
  abort(): void;
  resume(): Promise<void>;
  dispose(): void;
}

export class LacertaExtension {
  constructor(parser: object, options: LacertaOptions);
  readonly name: 'LACERTA_mesh_progressive';
}

export class LacertaLoader {
  constructor(makeLoader: () => object, options: LacertaOptions);
  load(url: string, options?: {mode?: 'stream' | 'range'; signal?: AbortSignal; retries?: number; timeout?: number;
    headers?: Record<string, string>; fetch?: typeof fetch}): Promise<any>;
}
