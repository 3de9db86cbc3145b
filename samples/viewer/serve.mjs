// Serves the viewer: npm start [-- FOLDER], in plugin/web. Builds the package where that has not been done, and packs a few assets where the folder of
// assets (build/viewer_assets) has none.
//   LACERTA_COMMAND  the native command, if not in build/     PORT  default 8080
// Any static server that honours Range does as well; this one can also be slow: ?kbps=100 at the end of an asset's address.
import {execFileSync} from 'node:child_process';
import {existsSync, mkdirSync, readdirSync} from 'node:fs';
import {createServer} from 'node:http';
import {createRequire} from 'node:module';
import {basename, join, resolve} from 'node:path';
import {fileURLToPath, pathToFileURL} from 'node:url';

const here = fileURLToPath(new URL('.', import.meta.url));
const web = join(here, '../../plugin/web'), isMain = process.argv[1] === fileURLToPath(import.meta.url);
const assets = resolve(isMain && process.argv[2] || join(here, '../../build/viewer_assets'));
const require = createRequire(join(web, 'package.json'));
const {default: sirv} = await import(pathToFileURL(require.resolve('sirv')).href);

// Lets no more than so many kB per second through.
function slowDown(response, kilobytesPerSecond) {
  const write = response.write.bind(response), end = response.end.bind(response);
  const piece = Math.max(256, kilobytesPerSecond * 50);  // 50 ms
  const start = performance.now();
  let sent = 0, queue = Promise.resolve();
  const send = async chunk => {
    for (let at = 0; at < chunk.length && !response.destroyed; at += piece) {
      const part = chunk.subarray(at, at + piece);
      sent += part.length;
      const due = start + sent / kilobytesPerSecond;
      await new Promise(resolve => setTimeout(resolve, Math.max(0, due - performance.now())));
      write(part);
    }
  };
  response.write = chunk => {
    queue = queue.then(() => send(Buffer.from(chunk))).then(() => response.emit('drain'));
    return false;
  };
  response.end = chunk => {
    if (chunk) response.write(chunk);
    queue = queue.then(() => end());
    return response;
  };
}

/** roots: [prefix of the address, folder]. Resolves to the listening server. */
export async function serve(roots, port = 0) {
  const handlers = roots.map(([prefix, folder]) => [prefix, sirv(folder, {dev: true, etag: true})]);
  const server = createServer((request, response) => {
    const url = new URL(request.url, 'http://localhost');
    const found = handlers.find(([prefix]) => url.pathname.startsWith(prefix));
    const notFound = () => response.writeHead(404).end('not found');
    if (url.pathname === '/assets.json') return response.writeHead(200, {'content-type': 'application/json'}).end(JSON.stringify(listAssets()));
    if (!found) return notFound();
    const speed = Number(url.searchParams.get('kbps'));
    if (speed > 0) slowDown(response, speed);
    request.url = '/' + url.pathname.slice(found[0].length);
    found[1](request, response, notFound);
  });
  await new Promise(resolve => server.listen(port, '127.0.0.1', resolve));
  return server;
}

export const viewerRoots = [['/assets/', assets], ['/lacerta/', join(web, 'dist')], ['/three/', join(web, 'node_modules/three')], ['/', here]];

function listAssets() {
  return existsSync(assets) ? readdirSync(assets).filter(name => name.endsWith('.glb') && !name.includes('.draco.')) : [];
}

async function prepare() {
  if (!existsSync(join(web, 'dist/lacerta.wasm'))) execFileSync('npm', ['run', 'build'], {cwd: web, stdio: 'inherit'});
  if (listAssets().length > 0) return;
  mkdirSync(assets, {recursive: true});
  const {dataFolder, lacerta, scratch, writeTorus} = await import(pathToFileURL(join(web, 'test/node/support.mjs')).href);
  const {readMesh, writeDracoTwin} = await import(pathToFileURL(join(web, 'test/node/draco_twin.mjs')).href);
  const torus = join(scratch, 'torus.obj');
  writeTorus(torus, 240, 120);
  const meshes = [torus, ...['horse', 'bunny_zipper', 'venus'].map(name => join(dataFolder, `${name}.ply`)).filter(existsSync)];
  for (const mesh of meshes) {
    const out = join(assets, `${basename(mesh).replace(/\.\w+$/, '')}.glb`);
    console.log(`packing ${out}`);
    lacerta('pack', mesh, '-o', out, '--psnr', '75', '--levels', 'always', '--effort', 'fast');
    await writeDracoTwin(readMesh(mesh), out);
  }
}

if (isMain) {
  await prepare();
  const server = await serve(viewerRoots, Number(process.env.PORT ?? 8080));
  console.log(`http://localhost:${server.address().port}/`);
}
