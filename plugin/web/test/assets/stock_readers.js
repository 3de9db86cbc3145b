// In the page: stock three.js alone.
import * as THREE from 'three';
import {DRACOLoader} from 'three/addons/loaders/DRACOLoader.js';
import {GLTFLoader} from 'three/addons/loaders/GLTFLoader.js';

const dracoLoader = new DRACOLoader().setDecoderPath('/three/examples/jsm/libs/draco/gltf/');
const renderer = new THREE.WebGLRenderer({preserveDrawingBuffer: true});
renderer.setSize(200, 200, false);

// The part of the picture that is not background.
function covered(scene, box) {
  const size = box.getSize(new THREE.Vector3()).length(), center = box.getCenter(new THREE.Vector3());
  const camera = new THREE.PerspectiveCamera(30, 1, size / 100, size * 10);
  camera.position.copy(center).add(new THREE.Vector3(0.5, 0.4, 1).normalize().multiplyScalar(size * 1.9));
  camera.lookAt(center);
  const shown = new THREE.Scene();
  shown.background = new THREE.Color(0xff00ff);
  shown.add(scene, new THREE.HemisphereLight(0xffffff, 0x888888, 3));
  renderer.render(shown, camera);
  const context = new OffscreenCanvas(200, 200).getContext('2d');
  context.drawImage(renderer.domElement, 0, 0);
  const {data} = context.getImageData(0, 0, 200, 200);
  let count = 0;
  for (let i = 0; i < data.length; i += 4) count += data[i] < 250 || data[i + 1] > 5 || data[i + 2] < 250;
  return count / (data.length / 4);
}

/** {triangles, box: [min, max], covered: share of a picture, finite: whether all positions are} of a file as a stock loader shows it. */
window.look = async url => {
  const gltf = await new GLTFLoader().setDRACOLoader(dracoLoader).loadAsync(url);
  let triangles = 0, finite = true;
  gltf.scene.traverse(({isMesh, geometry}) => {
    if (!isMesh) return;
    const {position} = geometry.attributes;
    triangles += (geometry.index ?? position).count / 3;
    for (let i = 0; i < position.count && finite; ++i) finite = [position.getX(i), position.getY(i), position.getZ(i)].every(Number.isFinite);
  });
  const box = new THREE.Box3().setFromObject(gltf.scene, true);
  return {triangles, finite, box: [box.min.toArray(), box.max.toArray()], covered: covered(gltf.scene, box)};
};
window.ready = true;
