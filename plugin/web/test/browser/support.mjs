// Chromium, and a server of the viewer with assets packed for the tests.
import {existsSync, mkdirSync} from 'node:fs';
import {join} from 'node:path';
import {chromium} from 'playwright-core';
import {serve, viewerRoots} from '../../../../samples/viewer/serve.mjs';
import {writeDracoTwin} from '../node/draco_twin.mjs';
import {dataFolder, pack, root, scratch, writeTorus} from '../node/support.mjs';

export const pictures = join(root, 'out/browser');
mkdirSync(pictures, {recursive: true});

const flags = ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-quic', '--no-first-run',
  '--disable-background-networking', '--disable-component-update', '--disable-sync', '--js-flags=--expose-gc'];

/** A scan, or where there is none a bumpy torus, packed at `psnr` dB, and its Draco twin. */
export async function scanAsset(psnr) {
  const horse = join(dataFolder, 'horse.ply'), torus = join(scratch, 'torus.obj');
  if (!existsSync(horse)) writeTorus(torus, 240, 160);
  const name = existsSync(horse) ? 'horse' : 'torus';
  const glb = pack(`${name}_${psnr}.glb`, name === 'horse' ? horse : torus, '--psnr', String(psnr), '--levels', 'always');
  const twin = await writeDracoTwin(name === 'horse' ? horse : torus, glb);
  return {name, glb, twin: twin.path, file: `/assets/${name}_${psnr}.glb`, twinFile: `/assets/${name}_${psnr}.draco.glb`};
}

/** {page, base, close} with the viewer open and nothing loaded. */
export async function openViewer({width = 640, height = 480} = {}) {
  const server = await serve([['/assets/', scratch], ...viewerRoots.slice(1)]);
  const base = `http://127.0.0.1:${server.address().port}`;
  const browser = await chromium.launch({executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', args: flags});
  const page = await browser.newPage({viewport: {width, height}});
  const errors = [];
  page.on('pageerror', error => errors.push(error.message));
  await page.goto(`${base}/?idle`);
  await page.waitForFunction('window.ready');
  // Decoders and shaders are warm, as on the second page of a site: the link is what is measured.
  return {page, base, server, errors, close: async () => {
    await browser.close();
    server.closeAllConnections();
    server.close();
  }};
}

/** Loads in the page and waits until the last level is shown, or a problem is. Resolves to the history of levels. */
export async function loadWhole(page, url, mode = 'stream') {
  // Nothing is drawn before: software rendering of a large model takes a second, and no page would load into that.
  await page.evaluate('window.viewer.clear()');
  await page.waitForTimeout(300);
  await page.evaluate(([address, how]) => window.viewer.show(address, {mode: how, name: 'asset'}), [url, mode]);
  await page.waitForFunction('document.getElementById("problem").textContent !== "" || window.model?.surfaces.every(s => s.isComplete)', null, {timeout: 60000});
  return page.evaluate('window.history_of_levels');
}
