// What bench/throughput.mjs does in Node.js and in Chromium alike: decodes a stream, and Draco's streams beside it, in turns.

/**
 * Milliseconds, the best of `runs`: {triangles, stream, normals, draco: [of each of dracoStreams]}. Decoder, decodeDraco: of the modules of that name; now():
 * a clock in milliseconds.
 */
export function contest({Decoder, wasm, decodeDraco, draco, bytes, dracoStreams, runs, now}) {
  const decode = normals => {
    const decoder = new Decoder(wasm);
    const mesh = decoder.read(decoder.append(bytes), {normals});
    decoder.dispose();
    return mesh;
  };
  const time = run => {
    const start = now();
    run();
    return now() - start;
  };
  const best = {triangles: decode(false).indices.length / 3, stream: Infinity, normals: Infinity, draco: dracoStreams.map(() => Infinity)};
  for (let i = 0; i < runs; ++i) {
    best.stream = Math.min(best.stream, time(() => decode(false)));
    best.normals = Math.min(best.normals, time(() => decode(true)));
    best.draco = best.draco.map((before, k) => Math.min(before, time(() => decodeDraco(draco, dracoStreams[k]))));
  }
  return best;
}
