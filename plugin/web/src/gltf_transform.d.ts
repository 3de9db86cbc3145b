import {Extension, ExtensionProperty, type Document, type Material} from '@gltf-transform/core';

export class LacertaMeshProgressive extends Extension {
  readonly extensionName: 'LACERTA_mesh_progressive';
  static readonly EXTENSION_NAME: 'LACERTA_mesh_progressive';
}
export class ProgressiveStreams extends ExtensionProperty {
  getExtensionJson(): object;
  setExtensionJson(json: object): this;
  getData(): Uint8Array;
  setData(bytes: Uint8Array): this;
}
export class ProgressiveMesh extends ExtensionProperty {
  getPrimitives(): {stream: number; group: number}[];
  /** Of morph targets. */
  getWeights(): number[];
  setWeights(weights: number[]): this;
  getMaterial(primitive: number): Material | null;
  setMaterial(primitive: number, material: Material | null): this;
}
/** Decodes all progressive meshes to a level, default the finest that is there. draco3d: a decoder module, for bases in Draco form. */
export function toLevel(options?: {level?: number; draco3d?: object}): (document: Document) => Promise<void>;
