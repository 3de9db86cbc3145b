// Chromium, and a server of the viewer with assets packed for the tests.
import {randomBytes} from 'node:crypto';
import {existsSync, mkdirSync} from 'node:fs';
import {basename, join} from 'node:path';
import {deflateSync} from 'node:zlib';
import {Document, NodeIO} from '@gltf-transform/core';
import {ALL_EXTENSIONS} from '@gltf-transform/extensions';
import {chromium} from 'playwright-core';
import {serve, viewerRoots} from '../../../../samples/viewer/serve.mjs';
import {boundsOf, readMesh, writeDracoTwin} from '../node/draco_twin.mjs';
import {dataFolder, example, lacerta, pack, root, scratch, writeTorus} from '../node/support.mjs';

export const pictures = join(root, 'out/browser');
mkdirSync(pictures, {recursive: true});

const flags = ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-quic', '--no-first-run',
  '--disable-background-networking', '--disable-component-update', '--disable-sync', '--js-flags=--expose-gc'];

// The scan of that name, or where there is none a bumpy torus: {name, file}.
function findScan(scan) {
  const file = join(dataFolder, `${scan}.ply`);
  if (existsSync(file)) return {name: scan, file};
  const torus = join(scratch, 'torus.obj');
  if (!existsSync(torus)) writeTorus(torus, 240, 160);
  return {name: 'torus', file: torus};
}

async function assetWithTwin(name, packed, mesh) {
  const twin = await writeDracoTwin(mesh, packed);
  return {name, glb: packed, twin: twin.path, file: `/assets/${basename(packed)}`, twinFile: `/assets/${basename(twin.path)}`};
}

/** A scan (or its stand-in) packed at `psnr` dB, and its Draco twin. */
export async function scanAsset(scan, psnr) {
  const {name, file} = findScan(scan);
  return assetWithTwin(name, pack(`${name}_${psnr}.glb`, file, '--psnr', String(psnr), '--levels', 'always'), readMesh(file));
}

/** The same with texture coordinates, by projection along z, and a picture of noise of `side` x `side` x 3 bytes: what photographs of a scan take. */
export async function texturedScanAsset(scan, psnr, side) {
  const {name, file} = findScan(scan), mesh = readMesh(file), {min, max} = boundsOf(mesh.positions, 3), size = Math.max(...max.map((x, axis) => x - min[axis]));
  mesh.texcoords = new Float32Array(mesh.positions.length / 3 * 2).map((unused, i) => (mesh.positions[3 * (i >> 1) + (i & 1)] - min[i & 1]) / size);
  mesh.image = png(side, side, randomBytes(side * side * 3));
  const document = new Document(), buffer = document.createBuffer();
  const accessor = (type, array) => document.createAccessor().setType(type).setArray(array).setBuffer(buffer);
  const material = document.createMaterial().setBaseColorTexture(document.createTexture().setImage(mesh.image).setMimeType('image/png'));
  const primitive = document.createPrimitive().setIndices(accessor('SCALAR', mesh.indices)).setAttribute('POSITION', accessor('VEC3', mesh.positions))
    .setAttribute('TEXCOORD_0', accessor('VEC2', mesh.texcoords)).setMaterial(material);
  document.createScene().addChild(document.createNode().setMesh(document.createMesh().addPrimitive(primitive)));
  const plain = join(scratch, `${name}_textured.glb`);
  await new NodeIO().write(plain, document);
  return assetWithTwin(`${name} textured`, pack(`${name}_textured_${psnr}.glb`, plain, '--psnr', String(psnr), '--levels', 'always'), mesh);
}

/** A packed surface with texture coordinates and a picture of noise, which takes most of the file: {path, imageBytes}. */
export async function texturedAsset(name) {
  const plain = join(scratch, `plain_${name}`), io = new NodeIO().registerExtensions(ALL_EXTENSIONS);
  lacerta('unpack', example('torus_with_attributes.glb'), '-o', plain);
  const document = await io.read(plain), [mesh] = document.getRoot().listMeshes();
  const pixels = randomBytes(256 * 256 * 3), image = png(256, 256, pixels);
  const material = document.createMaterial().setBaseColorTexture(document.createTexture().setImage(image).setMimeType('image/png'));
  mesh.listPrimitives().forEach((primitive, i) => i === 0 ? primitive.setMaterial(material) : primitive.dispose());
  await io.write(plain, document);
  const path = pack(name, plain, '--psnr', '55', '--levels', 'always');
  return {path, imageBytes: image.length};
}

/** {page, base, server, errors, close} of Chromium at an address of a server of `roots`, when window.ready is set there. */
export async function openPage(address, roots, {width = 640, height = 480} = {}) {
  const server = await serve(roots);
  const base = `http://127.0.0.1:${server.address().port}`;
  const browser = await chromium.launch({executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', args: flags});
  const page = await browser.newPage({viewport: {width, height}});
  const errors = [];
  page.on('pageerror', error => errors.push(error.message));
  await page.goto(base + address);
  await page.waitForFunction('window.ready');
  return {page, base, server, errors, close: async () => {
    await browser.close();
    server.closeAllConnections();
    server.close();
  }};
}

/** The viewer open with nothing loaded; decoders and shaders are warm, as on the second page of a site: the link is what is measured. */
export const openViewer = size => openPage('/?idle', [['/assets/', scratch], ...viewerRoots.slice(1)], size);

/** Loads in the page and waits until the last level is shown, or a problem is. Resolves to the history of levels. */
export async function loadWhole(page, url, mode = 'stream') {
  // Nothing is drawn before: software rendering of a large model takes a second, and no page would load into that.
  await page.evaluate('window.viewer.clear()');
  await page.waitForTimeout(300);
  await page.evaluate(([address, how]) => window.viewer.show(address, {mode: how, name: 'asset'}), [url, mode]);
  await page.waitForFunction('document.getElementById("problem").textContent !== "" || window.model?.surfaces.every(s => s.isComplete)', null, {timeout: 60000});
  return page.evaluate('window.history_of_levels');
}

// As PNG has it; zlib.crc32 is newer than Debian's Node.js.
function crc32(bytes) {
  let crc = ~0;
  for (const byte of bytes) {
    crc ^= byte;
    for (let bit = 0; bit < 8; ++bit) crc = crc >>> 1 ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return ~crc >>> 0;
}

// A PNG of 8-bit colors.
function png(width, height, pixels) {
  const rows = Buffer.alloc(height * (1 + 3 * width));
  for (let y = 0; y < height; ++y) pixels.copy(rows, y * (1 + 3 * width) + 1, 3 * width * y, 3 * width * (y + 1));
  const chunk = (type, data) => {
    const body = Buffer.concat([Buffer.from(type), data]), out = Buffer.alloc(body.length + 8);
    out.writeUInt32BE(data.length);
    body.copy(out, 4);
    out.writeUInt32BE(crc32(body), body.length + 4);
    return out;
  };
  const head = Buffer.alloc(13);
  head.writeUInt32BE(width);
  head.writeUInt32BE(height, 4);
  head.set([8, 2], 8);
  return Buffer.concat([Buffer.from([137, 80, 78, 71, 13, 10, 26, 10]), chunk('IHDR', head), chunk('IDAT', deflateSync(rows)), chunk('IEND', Buffer.alloc(0))]);
}
