// A glTF file with morph targets.
import {Document, NodeIO} from '@gltf-transform/core';

export const kTargets = 3;

/** A torus with bumps and targets, named a, b, c, that raise hills. */
export async function writeMorphedTorus(path, around = 160, across = 80) {
  const document = new Document(), buffer = document.createBuffer(), positions = [], indices = [], offsets = Array.from({length: kTargets}, () => []);
  for (let i = 0; i < around; ++i) {
    for (let j = 0; j < across; ++j) {
      const u = 2 * Math.PI * i / around, v = 2 * Math.PI * j / across, radius = 0.4 + 0.03 * Math.sin(5 * u) * Math.cos(3 * v);
      positions.push((1 + radius * Math.cos(v)) * Math.cos(u), (1 + radius * Math.cos(v)) * Math.sin(u), radius * Math.sin(v));
      for (let t = 0; t < kTargets; ++t) {
        const hill = 0.2 * Math.max(0, Math.cos(u - 2 * t) - 0.3) ** 2;
        offsets[t].push(hill * Math.cos(u), hill * Math.sin(u), hill * t);
      }
      const a = i * across + j, b = (i + 1) % around * across + j, next = (j + 1) % across - j;
      indices.push(a, b, b + next, a, b + next, a + next);
    }
  }
  const accessor = (type, array) => document.createAccessor().setType(type).setArray(array).setBuffer(buffer);
  const primitive = document.createPrimitive().setIndices(accessor('SCALAR', Uint32Array.from(indices))).setAttribute('POSITION', accessor('VEC3', Float32Array.from(positions)));
  for (const [t, values] of offsets.entries()) primitive.addTarget(document.createPrimitiveTarget('abc'[t]).setAttribute('POSITION', accessor('VEC3', Float32Array.from(values))));
  const mesh = document.createMesh().addPrimitive(primitive).setWeights([0.5, 0, 0]);
  document.createScene().addChild(document.createNode().setMesh(mesh));
  await new NodeIO().write(path, document);
}
