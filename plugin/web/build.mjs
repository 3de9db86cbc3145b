// Builds dist/: the decoder as standalone WebAssembly, and the modules beside it. Needs em++ (cmake/install_packages.sh web).
import {execFile} from 'node:child_process';
import {copyFileSync, mkdirSync, readFileSync, readdirSync, rmSync, statSync, writeFileSync} from 'node:fs';
import {availableParallelism} from 'node:os';
import {basename, dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {promisify} from 'node:util';
import {deflateRawSync, gzipSync} from 'node:zlib';
import {transformSync} from 'esbuild';

const here = dirname(fileURLToPath(import.meta.url));
const root = join(here, '..', '..');
const dist = join(here, 'dist');
const objects = join(root, 'build', 'wasm');
const maxGzipped = 60_000;  // bytes of all that a page may load

const folders = ['draco_ext/common', 'draco_ext/decoder'];
const sources = folders.flatMap(folder => readdirSync(join(root, folder)).filter(name => name.endsWith('.cc')).map(name => join(root, folder, name)));
for (const name of ['base_section', 'caller_data', 'group_base', 'lacerta', 'no_draco_base_reader', 'shown_level', 'stream_decoder']) sources.push(join(root, 'plugin/c', `${name}.cc`));
for (const name of readdirSync(join(here, 'wasm'))) {
  const twin = sources.findIndex(source => basename(source) === name);  // which it takes the place of
  sources.splice(twin < 0 ? sources.length : twin, 1, join(here, 'wasm', name));
}

// Where the time goes; all else is built for size. They come first, for the linker takes the first instance of a template.
const forSpeed = new Set(['hot_paths', 'butterfly', 'coefficient_coding', 'coefficient_sets', 'curved_prediction', 'local_frame', 'octahedral', 'smooth_normals', 'subdivision', 'synthesis']);
const isForSpeed = source => forSpeed.has(basename(source, '.cc'));
sources.sort((a, b) => isForSpeed(b) - isForSpeed(a));
const optimization = source => isForSpeed(source) ? ['-O2', '-fno-unroll-loops', '-fno-vectorize', '-fno-slp-vectorize'] : ['-Oz'];  // the same speed in fewer bytes
const includes = ['draco_ext', 'draco_ext/include', 'plugin/c', 'plugin/c/include'].map(folder => `-I${join(root, folder)}`);
const flags = ['-std=c++17', '-DNDEBUG', '-DLACERTA_TERSE', '-fno-exceptions', '-fno-rtti', '-flto', '-mbulk-memory', '-msign-ext', '-mnontrapping-fptoint', '-fno-math-errno',
  '-ffp-contract=off'];  // the floats of every other build

// Of the functions of lacerta.h those that JavaScript calls.
const exported = new Set([...readFileSync(join(here, 'src/decoder.js'), 'utf8').matchAll(/\.(lacerta_\w+)\(/g)].map(match => `_${match[1]}`));
const linking = ['-Oz', '-Wl,-mllvm,-inline-threshold=0', '--no-entry', '-sSTANDALONE_WASM=1', '-sALLOW_MEMORY_GROWTH=1', '-sMALLOC=emmalloc', '-sTOTAL_STACK=262144',
  `-sEXPORTED_FUNCTIONS=${[...exported, '_malloc', '_free'].join(',')}`];

const run = promisify(execFile);
const isNewer = (target, than) => {
  try { return statSync(target).mtimeMs > than; } catch { return false; }
};
const newestHeader = Math.max(...['draco_ext', 'plugin/c'].flatMap(folder => readdirSync(join(root, folder), {recursive: true})
  .filter(name => name.endsWith('.h')).map(name => statSync(join(root, folder, name)).mtimeMs)), statSync(fileURLToPath(import.meta.url)).mtimeMs);

async function compile(source) {
  const object = join(objects, `${basename(source, '.cc')}.o`);
  if (isNewer(object, Math.max(newestHeader, statSync(source).mtimeMs))) return object;
  await run('em++', [...optimization(source), ...flags, ...includes, '-c', source, '-o', object]);
  return object;
}

async function compileAll() {
  const queue = sources.map((source, index) => ({source, index}));
  const made = [];
  const worker = async () => {
    for (let next; (next = queue.shift());) made[next.index] = await compile(next.source);
  };
  await Promise.all(Array.from({length: availableParallelism()}, worker));
  return made;
}

mkdirSync(objects, {recursive: true});
rmSync(dist, {recursive: true, force: true});
mkdirSync(dist);
for (const name of readdirSync(join(here, 'src'))) {
  const from = join(here, 'src', name), to = join(dist, name);
  if (name.endsWith('.js')) writeFileSync(to, transformSync(readFileSync(from, 'utf8'), {minify: true, format: 'esm', target: 'es2022'}).code);
  else copyFileSync(from, to);
}
await run('em++', [...flags, ...linking, ...await compileAll(), '-o', join(objects, 'lacerta.wasm')]);
// The optimizer, which comes with Emscripten, makes small functions part of their callers: that makes decoding twice as fast. Then loops and branches are
// made anew until nothing comes off.
const optimize = (...options) => run('wasm-opt', [...options, '--enable-bulk-memory', '--enable-sign-ext', '--enable-nontrapping-float-to-int']);
await optimize('-O3', '--inlining-optimizing', '--flexible-inline-max-function-size', '6', join(objects, 'lacerta.wasm'), '-o', join(objects, 'inlined.wasm'));
const again = ['--flatten', '--rereloop', '-Oz'];
await optimize(...again, ...again, '-Oz', '--converge', join(objects, 'inlined.wasm'), '-o', join(dist, 'lacerta.wasm'));
const wasm = readFileSync(join(dist, 'lacerta.wasm'));
// Deflated, then as base64: what comes over the wire is as small as the separate file.
writeFileSync(join(dist, 'binary.js'), `// Made by build.mjs: lacerta.wasm, deflated.\nexport default '${deflateRawSync(wasm, {level: 9}).toString('base64')}';\n`);

const gzipped = path => gzipSync(readFileSync(path), {level: 9}).length;
const rows = readdirSync(dist).filter(name => /\.(js|wasm)$/.test(name)).map(name => [name, statSync(join(dist, name)).size, gzipped(join(dist, name))]);
for (const [name, bytes, zipped] of rows) console.log(`${name.padEnd(20)} ${String(bytes).padStart(8)} bytes ${String(zipped).padStart(7)} gzipped`);
// What a page takes to decode, with the binary as a file or inside; the loader for three.js comes on top.
const decoding = ['decoder.js', 'pool.js', 'worker.js'];
for (const build of [['lacerta.wasm', 'binary_file.js', 'index.js'], ['binary.js', 'binary_inline.js', 'inline.js']]) {
  const sum = rows.filter(([name]) => decoding.includes(name) || build.includes(name)).reduce((total, row) => total + row[2], 0);
  console.log(`decoder with ${build[0]}: ${sum} gzipped`);
  if (sum > maxGzipped) {
    console.error(`more than the ${maxGzipped} bytes that are allowed`);
    process.exitCode = 1;
  }
}
