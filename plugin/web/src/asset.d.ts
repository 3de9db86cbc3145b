/** The JSON of LACERTA_mesh_progressive, checked. */
export interface Segment { stream: number; part: number; offset: number; length: number; }
export interface ProgressiveStream {
  vertexCounts: number[];
  triangleCounts: number[];
  errors: number[];
  min: number[];
  max: number[];
  normals?: 'smooth';
  segments: Segment[];
}
export interface Progressive {
  data: number;
  refinements?: number;
  streams: ProgressiveStream[];
  order: Segment[];
  length: number;
}
export function parseProgressive(json: object): Progressive | undefined;
