// lacerta.wasm out of the module binary.js: nothing to fetch, nothing to configure.
import binary from './binary.js';

export async function loadBinary() {
  const deflated = Uint8Array.from(atob(binary), character => character.charCodeAt(0));
  return new Response(new Blob([deflated]).stream().pipeThrough(new DecompressionStream('deflate-raw'))).arrayBuffer();
}
