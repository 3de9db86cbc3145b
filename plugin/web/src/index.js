// The package with lacerta.wasm as a file of its own.
import {loadBinary} from './binary_file.js';
import {Decoder, instantiate} from './decoder.js';
import {DecoderPool} from './pool.js';

export {Decoder, LacertaError} from './decoder.js';
export {DecoderPool} from './pool.js';
export {parseProgressive} from './asset.js';

/** lacerta.wasm, compiled; once for all who ask. url: where it is, if not beside this module. */
let compiled;
export function compile(url) {
  return compiled ??= loadBinary(url).then(WebAssembly.compile);
}

/** A decoder for this thread. */
export async function createDecoder(options) {
  return new Decoder(await instantiate(await compile()), options);
}

/** Decoders in workers. */
export async function createPool(options) {
  return new DecoderPool(await compile(), options);
}
