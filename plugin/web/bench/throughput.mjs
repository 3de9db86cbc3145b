// Triangles per second of the decoder in WebAssembly, beside native and beside Draco's own decoder in WebAssembly, in one process in turns:
//   node bench/throughput.mjs [docs/results/wasm_table.md]
// Draco decodes what its encoder makes of the very mesh that the stream decodes to, at 11 bits. CPU time of the process, the best of several.
import {execFileSync} from 'node:child_process';
import {existsSync, readFileSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import draco3d from 'draco3d';
import {Decoder, compile} from '../dist/index.js';
import {instantiate} from '../dist/decoder.js';
import {dataFolder, decodeDraco, dracoModule, pack, root, scratch, writeTorus} from '../test/node/support.mjs';

const kRuns = 7;

function cpuMilliseconds(run) {
  const before = process.cpuUsage();
  run();
  const {user, system} = process.cpuUsage(before);
  return (user + system) / 1000;
}

async function dracoStream(mesh) {
  const module = await draco3d.createEncoderModule();
  const builder = new module.MeshBuilder(), encoder = new module.Encoder(), made = new module.Mesh(), bytes = new module.DracoInt8Array();
  builder.AddFacesToMesh(made, mesh.indices.length / 3, mesh.indices);
  builder.AddFloatAttributeToMesh(made, module.POSITION, mesh.positions.length / 3, 3, mesh.positions);
  encoder.SetAttributeQuantization(module.POSITION, 11);
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

async function measure(name, path) {
  const wasm = await instantiate(await compile()), draco = await dracoModule(), bytes = new Uint8Array(readFileSync(path));
  const decode = normals => {
    const decoder = new Decoder(wasm);
    const mesh = decoder.read(decoder.append(bytes), {normals});
    decoder.dispose();
    return mesh;
  };
  const mesh = decode(false), triangles = mesh.indices.length / 3, other = await dracoStream(mesh);
  const best = {wasm: Infinity, normals: Infinity, draco: Infinity, native: Infinity};
  for (let i = 0; i < kRuns; ++i) {
    best.wasm = Math.min(best.wasm, cpuMilliseconds(() => decode(false)));
    best.normals = Math.min(best.normals, cpuMilliseconds(() => decode(true)));
    best.draco = Math.min(best.draco, cpuMilliseconds(() => decodeDraco(draco, other)));
    if (i % 3 === 0) best.native = Math.min(best.native, nativeMilliseconds(path));
  }
  const rate = milliseconds => (triangles / milliseconds / 1000).toFixed(1);
  return `| ${name} | ${triangles} | ${bytes.length} | ${other.length} | ${rate(best.wasm)} | ${(100 * best.native / best.wasm).toFixed(0)} % | ` +
    `${(best.draco / best.wasm).toFixed(1)} | ${rate(best.normals)} |`;
}

const rows = [];
// A million triangles that any machine has: a grid around a torus, which is coded on its own connectivity.
const torus = join(scratch, 'million.obj');
writeTorus(torus, 1024, 512);
for (const [name, input, ...options] of [['horse, 70 dB', join(dataFolder, 'horse.ply')], ['horse, 80 dB', join(dataFolder, 'horse.ply'), '--psnr', '80'],
  ['venus, 80 dB', join(dataFolder, 'venus.ply'), '--psnr', '80'], ['bumpy torus, 80 dB', torus, '--psnr', '80']]) {
  if (!existsSync(input)) console.error(`no ${input}: left out`);
  else rows.push(await measure(name, pack(`${name.replace(/\W+/g, '_')}.drc`, input, '--form', 'custom', '--levels', 'always', ...options)));
}
const table = `# Decoding in WebAssembly

Made by \`npm run bench -- docs/results/wasm_table.md\` in plugin/web: Node.js ${process.version}, CPU time of one thread, best of ${kRuns}. Mtri/s: million triangles
per second, from the bytes of a stream in custom form to positions and indices in arrays of JavaScript. Draco: draco3d on the same mesh at 11 bits.

| stream | triangles | bytes | Draco's bytes | Mtri/s | of native | times Draco's speed | Mtri/s with normals |
|---|---|---|---|---|---|---|---|
${rows.join('\n')}
`;
if (process.argv[2]) writeFileSync(process.argv[2], table);
else console.log(table);
