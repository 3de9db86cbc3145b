// In the page: draws an asset as it came and as it is packed, by the same camera in the same light, and composes one picture of both.
import * as THREE from 'three';
import {RoomEnvironment} from 'three/addons/environments/RoomEnvironment.js';
import {DRACOLoader} from 'three/addons/loaders/DRACOLoader.js';
import {GLTFLoader} from 'three/addons/loaders/GLTFLoader.js';
import {LacertaExtension} from 'lacerta/three';

const side = 540, gap = 4, caption = 26;
const renderer = new THREE.WebGLRenderer({antialias: true, preserveDrawingBuffer: true});
renderer.setSize(side, side, false);
renderer.toneMapping = THREE.ACESFilmicToneMapping;
const environment = new THREE.PMREMGenerator(renderer).fromScene(new RoomEnvironment(), 0.04).texture;
const dracoLoader = new DRACOLoader().setDecoderPath('/three/examples/jsm/libs/draco/gltf/');

async function load(url) {
  let problem;
  const loader = new GLTFLoader().setDRACOLoader(dracoLoader);
  loader.register(parser => new LacertaExtension(parser, {three: THREE, onProblem: message => { problem = message; }}));
  const gltf = await loader.loadAsync(url), model = gltf.userData.lacerta;
  while (model && !problem && !model.surfaces.every(surface => surface.isComplete)) {
    [problem] = model.problems;
    await new Promise(resolve => setTimeout(resolve, 20));
  }
  if (problem) throw new Error(`${url}: ${problem}`);
  replacePlaceholders(gltf);
  return gltf;
}

// Some copies of the sample assets have single pixels in the place of their pictures. As normal maps these tilt all normals by half a right angle, which
// nobody means, so squares stand for them: they show where texture coordinates are.
function squares() {
  const size = 1024, cell = 32, context = new OffscreenCanvas(size, size).getContext('2d');
  context.fillStyle = '#76838c';
  context.fillRect(0, 0, size, size);
  context.fillStyle = '#57626a';
  for (let y = 0; y < size; y += cell) for (let x = y % (2 * cell); x < size; x += 2 * cell) context.fillRect(x, y, cell, cell);
  const texture = new THREE.CanvasTexture(context.canvas);
  texture.colorSpace = THREE.SRGBColorSpace;
  texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
  texture.anisotropy = 8;
  return texture;
}

function replacePlaceholders(gltf) {
  const isPixel = texture => texture?.isTexture && texture.image?.width === 1 && texture.image?.height === 1;
  gltf.scene.traverse(({material}) => {
    if (!material || !Object.values(material).some(isPixel)) return;
    const replaced = isPixel(material.map);
    for (const [key, value] of Object.entries(material)) if (isPixel(value)) material[key] = null;
    if (replaced) Object.assign(material, {map: squares(), metalness: 0, roughness: 0.35});
    material.needsUpdate = true;
  });
}

// Seen from `direction`, `zoom` times as near as to show all of it, at `target` in units of the half box.
function placeCamera(box, {direction, zoom = 1, target = [0, 0, 0]}) {
  const half = box.getSize(new THREE.Vector3()).multiplyScalar(0.5), radius = half.length(), angle = 30;
  const camera = new THREE.PerspectiveCamera(angle, 1, radius / 100, radius * 100);
  const center = box.getCenter(new THREE.Vector3()).add(new THREE.Vector3(...target).multiply(half));
  const distance = radius / Math.sin(angle / 2 * Math.PI / 180) / zoom;
  camera.position.copy(center).add(new THREE.Vector3(...direction).normalize().multiplyScalar(distance));
  camera.lookAt(center);
  return camera;
}

function draw(gltf, camera) {
  const scene = new THREE.Scene();
  scene.background = new THREE.Color(0xf2f2f0);
  scene.environment = environment;
  scene.add(gltf.scene);
  renderer.render(scene, camera);
  const copy = new OffscreenCanvas(side, side).getContext('2d', {willReadFrequently: true});
  copy.drawImage(renderer.domElement, 0, 0);
  return copy;
}

// Of the colors of two drawings, in dB.
function colorPsnr(a, b) {
  const x = a.getImageData(0, 0, side, side).data, y = b.getImageData(0, 0, side, side).data;
  let sum = 0;
  for (let i = 0; i < x.length; ++i) sum += (x[i] - y[i]) ** 2;
  return 10 * Math.log10(255 ** 2 / (sum / (x.length * 3 / 4)));  // opacity is the same everywhere
}

function trianglesOf(gltf) {
  let sum = 0;
  gltf.scene.traverse(({isMesh, geometry}) => { if (isMesh) sum += (geometry.index ?? geometry.attributes.position).count / 3; });
  return sum;
}

/**
 * files: addresses of the original and the packed asset; captions: one for each; views: rows of the picture. Resolves to {picture: a data URL, psnr: of each
 * view, triangles: of both}.
 */
window.compose = async (files, captions, views) => {
  const assets = await Promise.all(files.map(load)), box = new THREE.Box3().setFromObject(assets[0].scene);
  const sheet = document.createElement('canvas').getContext('2d');
  sheet.canvas.width = 2 * side + gap;
  sheet.canvas.height = caption + views.length * side + (views.length - 1) * gap;
  sheet.fillStyle = '#fff';
  sheet.fillRect(0, 0, sheet.canvas.width, sheet.canvas.height);
  sheet.fillStyle = '#222';
  sheet.font = '16px sans-serif';
  captions.forEach((text, i) => sheet.fillText(text, i * (side + gap) + 6, 18));
  const psnr = views.map((view, row) => {
    const drawn = assets.map(gltf => draw(gltf, placeCamera(box, view)));
    drawn.forEach((context, i) => sheet.drawImage(context.canvas, i * (side + gap), caption + row * (side + gap)));
    return colorPsnr(...drawn);
  });
  const picture = sheet.canvas.toDataURL('image/jpeg', 0.8);
  return {picture, psnr, triangles: assets.map(trianglesOf)};
};
window.ready = true;
