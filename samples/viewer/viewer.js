// The page: loads an asset with LacertaLoader and shows how it sharpens, beside the Draco file of equal error where that is asked for.
import * as THREE from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';
import {DRACOLoader} from 'three/addons/loaders/DRACOLoader.js';
import {GLTFLoader} from 'three/addons/loaders/GLTFLoader.js';
import {LacertaLoader} from 'lacerta/three';
import {createPool} from 'lacerta/inline';

const byId = id => document.getElementById(id);
const dracoLoader = new DRACOLoader().setDecoderPath('/three/examples/jsm/libs/draco/gltf/').preload();
const pool = createPool();
const makeLoader = () => new GLTFLoader().setDRACOLoader(dracoLoader);
const loader = new LacertaLoader(makeLoader, {three: THREE, dracoLoader, pool});

// A canvas with one model in it.
class View {
  constructor(element, camera) {
    this.element = element;
    this.text = element.querySelector('p');
    this.camera = camera;
    this.scene = new THREE.Scene();
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x445566, 2));
    const sun = new THREE.DirectionalLight(0xffffff, 2);
    sun.position.set(1, 2, 3);
    this.scene.add(sun);
    this.renderer = new THREE.WebGLRenderer({canvas: element.querySelector('canvas'), antialias: true, preserveDrawingBuffer: true});
    this.renderer.setClearColor(0x20242a);
  }
  set(gltf) {
    this.clear();
    this.gltf = gltf;
    this.scene.add(gltf.scene);
    gltf.scene.traverse(object => { if (object.isMesh) object.material.side = THREE.DoubleSide; });
  }
  clear() {
    if (!this.gltf) return;
    this.gltf.userData.lacerta?.dispose();
    this.scene.remove(this.gltf.scene);
    this.gltf.scene.traverse(object => {
      object.geometry?.dispose();
      for (const value of Object.values(object.material ?? {})) if (value?.isTexture) value.dispose();
      object.material?.dispose();
    });
    this.gltf = undefined;
    this.text.textContent = '';
  }
  draw(wireframe) {
    const {clientWidth: width, clientHeight: height} = this.element;
    if (width === 0) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.gltf?.scene.traverse(object => { if (object.isMesh) object.material.wireframe = wireframe; });
    this.renderer.render(this.scene, this.camera);
  }
}

const camera = new THREE.PerspectiveCamera(40, 1, 0.01, 100);
const left = new View(byId('left'), camera), right = new View(byId('right'), camera);
const controls = new OrbitControls(camera, byId('views'));
let download, started = 0;

function frame(scene) {
  const box = new THREE.Box3().setFromObject(scene), center = box.getCenter(new THREE.Vector3()), size = box.getSize(new THREE.Vector3()).length();
  camera.near = size / 1000;
  camera.far = size * 100;
  camera.position.copy(center).add(new THREE.Vector3(0.5, 0.3, 1).normalize().multiplyScalar(size * 1.2));
  controls.target.copy(center);
  controls.update();
}

const seconds = () => ((performance.now() - started) / 1000).toFixed(2);
const slow = (url, speed = byId('speed').value) => speed > 0 && !url.startsWith('blob:') ? `${url}${url.includes('?') ? '&' : '?'}kbps=${speed}` : url;

function readOut(model, name) {
  const surface = model.surfaces[0];
  const part = surface.part, known = part >= 0;
  left.text.textContent = `${name}: ${model.received} of ${model.total} bytes, ${seconds()} s\n` +
    (known ? `level ${part} of ${surface.lastPart}, ${surface.stream.triangleCounts[part]} triangles, error ${surface.stream.errors[part].toPrecision(3)}` : 'base');
}

export async function show(url, {mode = byId('mode').value, name = url} = {}) {
  download?.abort(new Error('replaced'));
  download = new AbortController();
  const {signal} = download;
  byId('problem').textContent = '';
  byId('progress').value = 0;
  const begun = started = performance.now();
  window.history_of_levels = [];
  window.textures_shown = undefined;
  try {
    const gltf = await loader.load(slow(url), {mode, signal, timeout: 5000});
    if (signal.aborted) return;
    left.set(gltf);
    frame(gltf.scene);
    const model = gltf.userData.lacerta;
    window.history_of_levels.push({level: -1, milliseconds: performance.now() - started});
    window.model = model;
    if (!model) {
      left.text.textContent = `${name}: not progressive, ${seconds()} s`;
      byId('progress').value = 1;
      return gltf;
    }
    byId('quality').max = Math.max(...model.surfaces.map(surface => surface.lastPart));
    byId('quality').value = byId('quality').max;
    model.addEventListener('level', ({detail}) => {
      window.history_of_levels.push({level: detail.level, error: detail.error, triangles: detail.triangles, milliseconds: performance.now() - started});
      readOut(model, name);
    });
    model.addEventListener('textures', () => { window.textures_shown = performance.now() - begun; });
    model.addEventListener('progress', ({detail}) => {
      byId('progress').value = detail.received / detail.total;
      readOut(model, name);
    });
    byId('problem').textContent = model.problems.join('\n');
    model.addEventListener('problem', ({detail}) => { byId('problem').textContent = detail.message; });
    model.surfaces.forEach(surface => surface.part >= 0 && window.history_of_levels.push({level: surface.part, error: surface.stream.errors[surface.part], milliseconds: performance.now() - started}));
    byId('progress').value = model.received / model.total;
    readOut(model, name);
    return gltf;
  } catch (error) {
    if (!signal.aborted) byId('problem').textContent = error.message;
  }
}

async function showDraco(url) {
  const begun = performance.now();
  right.text.textContent = 'Draco: loading';
  try {
    const gltf = await makeLoader().loadAsync(slow(url));
    right.set(gltf);
    let triangles = 0;
    gltf.scene.traverse(object => { triangles += object.isMesh ? object.geometry.index.count / 3 : 0; });
    window.draco_shown = performance.now() - begun;
    right.text.textContent = `Draco: ${triangles} triangles, ${(window.draco_shown / 1000).toFixed(2)} s`;
  } catch (error) {
    right.text.textContent = `Draco: ${error.message}`;
  }
}

function load() {
  const url = byId('url').value || `/assets/${byId('assets').value}`;
  byId('right').hidden = !byId('side').checked;
  if (byId('side').checked) showDraco(url.replace(/\.glb$/, '.draco.glb'));
  else right.clear();
  return show(url);
}

byId('load').onclick = load;
byId('abort').onclick = () => window.model?.abort();
byId('quality').oninput = () => window.model?.setMaxLevel(Number(byId('quality').value));
byId('side').onchange = load;
document.body.ondragover = event => event.preventDefault();
document.body.ondrop = event => {
  event.preventDefault();
  const [file] = event.dataTransfer.files;
  if (file) show(URL.createObjectURL(file), {mode: 'stream', name: file.name});
};

window.longest_frame = 0;
let before = performance.now();
function tick(now) {
  window.longest_frame = Math.max(window.longest_frame, now - before);
  before = now;
  const began = performance.now();
  if (byId('auto').checked) window.model?.update(camera, byId('left').clientHeight);
  left.draw(byId('wireframe').checked);
  if (!byId('right').hidden) right.draw(byId('wireframe').checked);
  window.longest_draw = Math.max(window.longest_draw ?? 0, performance.now() - began);
  requestAnimationFrame(tick);
}
requestAnimationFrame(tick);
window.viewer = {show, showDraco, clear: () => left.clear(), left, renderer: left.renderer, pool: () => pool};

const list = await (await fetch('/assets.json')).json();
byId('assets').append(...list.map(name => new Option(name)));
const asked = new URL(location.href).searchParams;
if (asked.get('url')) byId('url').value = asked.get('url');
if (asked.get('speed')) byId('speed').value = asked.get('speed');
if (!asked.has('idle') && (list.length > 0 || asked.get('url'))) load();
window.ready = true;
