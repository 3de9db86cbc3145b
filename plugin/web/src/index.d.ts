/** What stopped a decoder; `code` is a lacerta_result of lacerta.h. */
export class LacertaError extends Error { code: number; }

export interface DecoderOptions {
  /** No level above it is decoded. */
  maxLevel?: number;
  maxVertices?: number;
  maxTriangles?: number;
  /** Bytes of the base section, where they are known: glTF tells them. */
  baseSize?: number;
  /** Of a stream with attributes and groups, from its JSON. */
  baseLengths?: number[];
  attributes?: string[];
}
export interface Progress {
  /** The finest complete level, 0 being the base; -1: no base yet. */
  level: number;
  /** Levels above the base; -1: not known yet. */
  numLevels: number;
  /** Meshes above the base so far; more than `level` only with quality layers. */
  state: number;
  hasLayers: boolean;
  isComplete: boolean;
  bytesUsed: number;
  /** Of faces, one per material. */
  numGroups: number;
}
export interface Mesh {
  positions: Float32Array;
  normals: Float32Array | null;
  indices: Uint32Array;
  /** By their names in glTF; none for streams without. */
  attributes: Record<string, Float32Array>;
}
export interface BaseGroup {
  positions: ArrayLike<number>;
  indices: ArrayLike<number>;
  attributes?: Record<string, ArrayLike<number>>;
}
export interface ReadOptions {
  /** Whether smooth normals are wanted, which follow from the shape. */
  normals?: boolean;
  /** Default: all groups as one. */
  group?: number;
}

export class Decoder {
  constructor(wasm: WebAssembly.Exports, options?: DecoderOptions);
  append(bytes: Uint8Array): number;
  finish(): number;
  needsBase: boolean;
  baseSection(): Uint8Array;
  setBase(positions: ArrayLike<number>, indices: ArrayLike<number>): void;
  setBaseGroup(group: number, base: BaseGroup): void;
  progress(): Progress;
  read(level: number, options?: ReadOptions): Mesh;
  dispose(): void;
}

/** The functions of Decoder in a worker. */
export interface RemoteDecoder {
  /** Bytes that fill their buffer are transferred: the array is empty afterwards. */
  append(bytes: Uint8Array): Promise<Progress>;
  finish(): Promise<Progress>;
  setBase(positions: ArrayLike<number>, indices: ArrayLike<number>): Promise<void>;
  setBaseGroup(group: number, base: BaseGroup): Promise<void>;
  progress(): Promise<Progress>;
  read(level: number, options?: ReadOptions): Promise<Mesh>;
  dispose(): void;
}
export interface PoolOptions {
  size?: number;
  createWorker?: () => unknown;
}
export class DecoderPool {
  constructor(module: WebAssembly.Module, options?: PoolOptions);
  readonly streams: number;
  warm(): void;
  create(options?: DecoderOptions): RemoteDecoder;
  dispose(): void;
}

export function compile(url?: string | URL): Promise<WebAssembly.Module>;
export function createDecoder(options?: DecoderOptions): Promise<Decoder>;
export function createPool(options?: PoolOptions): Promise<DecoderPool>;
