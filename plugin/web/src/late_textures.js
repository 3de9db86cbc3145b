// Textures that come after the surfaces: materials are made without them first, and get them when their bytes are there.

const isTexture = (key, value) => key.endsWith('Texture') && typeof value?.index === 'number';

/** Takes the textures out of the materials of a GLTFParser's JSON; returns the materials as they were. */
export function takeTextures(json) {
  const {materials = []} = json;
  json.materials = materials.map(material => {
    const bare = JSON.parse(JSON.stringify(material, (key, value) => isTexture(key, value) ? undefined : value));
    if (material.emissiveTexture) delete bare.emissiveFactor;  // else all of it would glow
    return bare;
  });
  return materials;
}

/** Gives the materials of gltf their textures. body: the first buffer, with the images now. The materials stay the same objects. */
export async function putTextures(gltf, materials, body) {
  const {parser} = gltf, {json} = parser;
  json.materials = materials;
  parser.extensions.KHR_binary_glTF.body = body;
  parser.cache.removeAll();
  const byMaterial = new Map();  // of three.js: which of the JSON it shows
  for (const scene of gltf.scenes) {
    scene.traverse(object => {
      const {meshes, primitives = 0} = parser.associations.get(object) ?? {};
      const index = object.isMesh ? json.meshes[meshes]?.primitives[primitives]?.material : undefined;
      if (index !== undefined) byMaterial.set(object.material, index);
    });
  }
  const making = new Map([...new Set(byMaterial.values())].map(index => [index, parser.getDependency('material', index)]));
  for (const [material, index] of byMaterial) {
    const whole = await making.get(index);
    for (const [key, value] of Object.entries(whole)) if (value?.isTexture) material[key] = value;
    if (whole.emissiveMap) material.emissive?.copy(whole.emissive);
    if (whole.aoMap) material.aoMapIntensity = whole.aoMapIntensity;
    // Without tangents GLTFLoader has turned the sign of y already.
    for (const scale of ['normalScale', 'clearcoatNormalScale']) if (whole[scale]) material[scale]?.multiply(whole[scale]);
    material.needsUpdate = true;
  }
}
