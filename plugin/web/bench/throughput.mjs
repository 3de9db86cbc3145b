// Triangles per second of the decoder in WebAssembly, beside native and beside Draco's own decoder in WebAssembly, in turns, in Node.js and in Chromium:
//   node bench/throughput.mjs [../../docs/results/wasm_table.md]
// Draco decodes what its encoder makes of the very mesh that the stream decodes to: as small as it gets (speed 0, 12 bits), and by default (speed 5, 11 bits).
import {execFileSync} from 'node:child_process';
import {existsSync, readFileSync, writeFileSync} from 'node:fs';
import {basename, join} from 'node:path';
import draco3d from 'draco3d';
import {chromium} from 'playwright-core';
import {serve, viewerRoots} from '../../../samples/viewer/serve.mjs';
import {Decoder, compile} from '../dist/index.js';
import {instantiate} from '../dist/decoder.js';
import {dataFolder, decodeDraco, dracoModule, lacerta, root, scratch, writeTorus} from '../test/node/support.mjs';
import {contest} from './contest.mjs';

const kRuns = 9;
const kSettings = [{speed: 0, bits: 12}, {speed: 5, bits: 11}];

const cpuMilliseconds = () => {
  const {user, system} = process.cpuUsage();
  return (user + system) / 1000;
};

async function dracoStream(mesh, {speed, bits}) {
  const module = await draco3d.createEncoderModule();
  const builder = new module.MeshBuilder(), encoder = new module.Encoder(), made = new module.Mesh(), bytes = new module.DracoInt8Array();
  builder.AddFacesToMesh(made, mesh.indices.length / 3, mesh.indices);
  builder.AddFloatAttributeToMesh(made, module.POSITION, mesh.positions.length / 3, 3, mesh.positions);
  encoder.SetSpeedOptions(speed, speed);
  encoder.SetAttributeQuantization(module.POSITION, bits);
  const length = encoder.EncodeMeshToDracoBuffer(made, bytes);
  const stream = new Uint8Array(length);
  for (let i = 0; i < length; ++i) stream[i] = bytes.GetValue(i);
  for (const object of [builder, encoder, made, bytes]) module.destroy(object);
  return stream;
}

// The same calls in C, compiled against the shared library.
function nativeMilliseconds(path) {
  const program = join(scratch, 'throughput');
  if (!existsSync(program)) {
    const folder = ['build/release/plugin/c', 'build/plugin/c'].map(name => join(root, name)).find(name => existsSync(join(name, 'liblacerta.so')));
    execFileSync('cc', ['-O2', join(root, 'plugin/web/bench/throughput.c'), `-I${join(root, 'plugin/c/include')}`, `-L${folder}`, `-Wl,-rpath,${folder}`, '-llacerta', '-o', program]);
  }
  return Number(execFileSync(program, [path, String(kRuns)]));
}

const server = await serve([['/assets/', scratch], ['/bench/', join(root, 'plugin/web/bench')], ['/node/', join(root, 'plugin/web/test/node')], ...viewerRoots.slice(1)]);
const browser = await chromium.launch({executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', args: ['--no-sandbox']});
const page = await browser.newPage();
await page.goto(`http://127.0.0.1:${server.address().port}/bench/contest.mjs`);  // a page of that origin, no more
await page.addScriptTag({url: '/three/examples/jsm/libs/draco/draco_wasm_wrapper.js'});

const inChromium = (file, dracoFiles) => page.evaluate(async ([path, others, runs]) => {
  const [{contest}, {Decoder, instantiate}, {decodeDraco}] = await Promise.all(['/bench/contest.mjs', '/lacerta/decoder.js', '/node/decode_draco.mjs'].map(name => import(name)));
  const read = async name => new Uint8Array(await (await fetch(name)).arrayBuffer());
  const wasm = await instantiate(await WebAssembly.compile(await read('/lacerta/lacerta.wasm')));
  const draco = await DracoDecoderModule({wasmBinary: (await read('/three/examples/jsm/libs/draco/draco_decoder.wasm')).buffer});
  return contest({Decoder, wasm, decodeDraco, draco, bytes: await read(path), dracoStreams: await Promise.all(others.map(read)), runs, now: () => performance.now()});
}, [file, dracoFiles, kRuns]);

async function measure(name, path) {
  const wasm = await instantiate(await compile()), draco = await dracoModule(), bytes = new Uint8Array(readFileSync(path));
  const decoder = new Decoder(wasm), mesh = decoder.read(decoder.append(bytes));
  decoder.dispose();
  const dracoStreams = await Promise.all(kSettings.map(setting => dracoStream(mesh, setting)));
  const files = dracoStreams.map((stream, k) => {
    writeFileSync(join(scratch, `draco_${k}.drc`), stream);
    return `/assets/draco_${k}.drc`;
  });
  const native = Math.min(nativeMilliseconds(path), nativeMilliseconds(path), nativeMilliseconds(path));
  const node = contest({Decoder, wasm, decodeDraco, draco, bytes, dracoStreams, runs: kRuns, now: cpuMilliseconds});
  const chrome = await inChromium(`/assets/${basename(path)}`, files);
  const rate = milliseconds => (node.triangles / milliseconds / 1000).toFixed(1), times = ({stream, draco: others}, k) => (others[k] / stream).toFixed(1);
  const row = (where, result) => `| ${name} | ${where} | ${node.triangles} | ${bytes.length} | ${rate(result.stream)} | ${(100 * native / result.stream).toFixed(0)} % | ` +
    kSettings.map((setting, k) => `${dracoStreams[k].length} | ${times(result, k)} | `).join('') + `${rate(result.normals)} |`;
  return [row('Node.js', node), row('Chromium', chrome)];
}

const rows = [];
// A million triangles that any machine has: a grid around a torus, which is coded on its own connectivity.
const torus = join(scratch, 'million.obj');
writeTorus(torus, 1024, 512);
for (const [name, input, ...options] of [['horse, 70 dB', join(dataFolder, 'horse.ply')], ['horse, 80 dB', join(dataFolder, 'horse.ply'), '--psnr', '80'],
  ['venus, 80 dB', join(dataFolder, 'venus.ply'), '--psnr', '80'], ['bumpy torus, 80 dB', torus, '--psnr', '80']]) {
  if (!existsSync(input)) {
    console.error(`no ${input}: left out`);
  } else {
    const stream = join(scratch, `${name.replace(/\W+/g, '_')}.drc`);
    lacerta('pack', input, '-o', stream, '--form', 'custom', '--levels', 'always', ...options);
    rows.push(...await measure(name, stream));
  }
}
const table = `# Decoding in WebAssembly

Made by \`npm run bench -- ../../docs/results/wasm_table.md\` in plugin/web, in one run of one thread: Node.js ${process.version} (CPU time) and Chromium ${browser.version()} (time of the wall), best
of ${kRuns}. Mtri/s: million triangles per second, from the bytes of a stream in custom form to positions and indices in arrays of JavaScript; "of native": of the C library's CPU time.
Draco's own decoder in WebAssembly (draco3d; in Chromium the copy that three.js ships) decodes the same mesh, from a stream as small as its encoder makes it (speed 0, 12 bits), and from
one with its default settings (speed 5, 11 bits), which decodes faster and is larger: "times" its triangles per second.

| stream | where | triangles | bytes | Mtri/s | of native | Draco, speed 0: bytes | times | Draco, speed 5: bytes | times | Mtri/s with normals |
|---|---|---|---|---|---|---|---|---|---|---|
${rows.join('\n')}
`;
await browser.close();
server.closeAllConnections();
server.close();
if (process.argv[2]) writeFileSync(process.argv[2], table);
else console.log(table);
