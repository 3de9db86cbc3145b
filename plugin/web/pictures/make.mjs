// Assets as they came beside what is packed at default, drawn by three.js: npm run pictures. Writes docs/images/<asset>.jpg and
// docs/results/asset_pictures.md. Fails where an asset is not there, or looks unlike its original.
import {mkdirSync, readFileSync, statSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {openPage} from '../test/browser/support.mjs';
import {dataFolder, lacerta, root, scratch} from '../test/node/support.mjs';
import {viewerRoots} from '../../../samples/viewer/serve.mjs';

const leastPsnr = 20;  // dB between the two drawings; 24 is what reflections on a visor cost that turns by two degrees
const assets = [
  {name: 'DamagedHelmet', views: [{direction: [-0.6, 0.2, 1], zoom: 1.3}, {direction: [-0.6, 0.2, 1], zoom: 3, target: [-0.1, -0.1, 0.5]}]},
  {name: 'FlightHelmet', views: [{direction: [0.5, 0.15, 1], zoom: 1.2}, {direction: [0.5, 0.15, 1], zoom: 4, target: [0, 0.45, 0.5]}]},
  {name: 'SheenChair', views: [{direction: [0.8, 0.4, 1], zoom: 1.25}, {direction: [0.8, 0.4, 1], zoom: 3.5, target: [0, -0.1, 0.3]}]},
  {name: 'MaterialsVariantsShoe', views: [{direction: [0.45, 0.4, 1], zoom: 1.25}, {direction: [0.5, 0.6, 0.8], zoom: 3, target: [0.35, 0.1, 0.2]}]},
];

function packed({name}) {
  const original = join(dataFolder, `${name}.glb`), path = join(scratch, `${name}.glb`);
  const {primitives} = JSON.parse(lacerta('pack', original, '-o', path, '--json'));
  const sum = key => primitives.reduce((total, primitive) => total + primitive[key], 0);
  return {geometry: [sum('bytesBefore'), sum('bytesAfter')], files: [statSync(original).size, statSync(path).size]};
}

const kB = bytes => bytes < 1e6 ? `${(bytes / 1e3).toFixed(1)} kB` : `${(bytes / 1e6).toFixed(2)} MB`;
const images = join(root, 'docs/images');
mkdirSync(images, {recursive: true});
const viewer = await openPage('/', [['/originals/', dataFolder], ['/assets/', scratch], ...viewerRoots.slice(1, -1), ['/', fileURLToPath(new URL('.', import.meta.url))]]);
const rows = [], sections = [];
try {
  for (const asset of assets) {
    const {geometry, files} = packed(asset);
    const captions = [`original, geometry ${kB(geometry[0])}`, `packed at default, geometry ${kB(geometry[1])}`];
    const {picture, psnr, triangles} = await viewer.page.evaluate(([urls, texts, views]) => window.compose(urls, texts, views),
      [[`/originals/${asset.name}.glb`, `/assets/${asset.name}.glb`], captions, asset.views]);
    const file = join(images, `${asset.name}.jpg`);
    writeFileSync(file, Buffer.from(picture.split(',')[1], 'base64'));
    console.log(asset.name, ...geometry, ...triangles, ...psnr.map(x => x.toFixed(1)), `${statSync(file).size} bytes of picture`);
    if (!psnr.every(x => x >= leastPsnr)) throw new Error(`${asset.name}: the two pictures are only ${psnr} dB alike`);
    rows.push([asset.name, ...triangles, ...geometry, ...files, ...psnr.map(x => x.toFixed(1))]);
    sections.push(`## ${asset.name}\n\n![${asset.name}, original and packed](../images/${asset.name}.jpg)\n`);
  }
} finally {
  await viewer.close();
}
const version = JSON.parse(readFileSync(new URL('../package.json', import.meta.url))).devDependencies.three;
writeFileSync(join(root, 'docs/results/asset_pictures.md'), `# Assets before and after

Written by \`npm run pictures\` in plugin/web: each asset as it came (left) and as \`lacerta pack\` makes it without further options (right), the whole and a part of it nearer,
drawn by three.js ${version} in Chromium, the packed ones through \`lacerta/three\`. Bytes of the geometry are those of attributes and indices; what else is in the files, textures
for the most part, is byte for byte the same. The last columns compare the two drawings (dB of their colors, whole and nearer), before they become JPEG. In the data set
that the tests use, FlightHelmet and the shoe have single pixels in the place of their pictures: squares are drawn on both sides instead, which show where texture coordinates are.

Of Khronos' glTF sample assets: FlightHelmet (CC0), DamagedHelmet (theblueturtle_, ctxwing), SheenChair (Wayfair), MaterialsVariantsShoe (Shopify), these CC BY 4.0.

| asset | triangles | triangles packed | geometry bytes | packed | file bytes | packed | dB, whole | dB, nearer |
|---|---|---|---|---|---|---|---|---|
${rows.map(row => `| ${row.join(' | ')} |`).join('\n')}

${sections.join('\n')}`);
