/** The JSON of LACERTA_mesh_progressive, checked. */
export interface Segment { stream: number; part: number; offset: number; length: number; }
export interface ProgressiveStream {
  vertexCounts: number[];
  triangleCounts: number[];
  errors: number[];
  min: number[];
  max: number[];
  normals?: 'smooth';
  baseLengths?: number[];
  /** TARGETS_0_POSITION and the like are of morph targets: three components for each of them. */
  attributes?: string[];
  /** Of a skinned surface: which joint of the skin each component of WEIGHTS_0 belongs to, as the decoder has it. */
  joints?: number[];
  segments: Segment[];
}
export interface Progressive {
  data: number;
  refinements?: number;
  streams: ProgressiveStream[];
  order: Segment[];
  length: number;
  /** Bytes that the file holds of them; less than `length` where it was trimmed. */
  available: number;
}
export function parseProgressive(json: object): Progressive | undefined;
/** Where the Draco streams of a base section lie in it, one per group. */
export function baseParts(stream: ProgressiveStream): {begin: number; end: number}[];
