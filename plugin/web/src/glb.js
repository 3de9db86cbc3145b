// GLB files that have arrived in part.
const kMagic = 0x46546c67, kJson = 0x4e4f534a;

/** {json, binOffset} of the first bytes of a GLB; undefined where they end within the JSON; null where this is no GLB. */
export function readHead(bytes) {
  if (bytes.length < 20) return undefined;
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
  if (view.getUint32(0, true) !== kMagic || view.getUint32(4, true) !== 2 || view.getUint32(16, true) !== kJson) return null;
  const length = view.getUint32(12, true);
  if (bytes.length < 20 + length) return undefined;
  return {json: JSON.parse(new TextDecoder().decode(bytes.subarray(20, 20 + length))), binOffset: 28 + length};
}

/** Where in the first buffer the bytes lie that have to be there before anything is shown: [{begin, end}], bases of streams included. */
export function neededRanges(json, progressive) {
  const ranges = [];
  json.bufferViews.forEach((view, i) => {
    if (view.buffer !== 0 || i === progressive.data) return;
    const begin = view.byteOffset ?? 0;
    ranges.push({begin, end: begin + view.byteLength});
  });
  const bases = progressive.order.filter(segment => segment.part === 0);
  const data = json.bufferViews[progressive.data];
  if (data.buffer === 0) {
    const begin = data.byteOffset ?? 0;
    ranges.push({begin, end: Math.min(begin + data.byteLength, begin + Math.max(0, ...bases.map(base => base.offset + base.length)))});
  }
  return ranges;
}

/** A GLB of this JSON and the front of its first buffer. */
export function formatGlb(json, body) {
  const text = new TextEncoder().encode(JSON.stringify(json));
  const padded = length => Math.ceil(length / 4) * 4;
  const bytes = new Uint8Array(28 + padded(text.length) + padded(body.length));
  const view = new DataView(bytes.buffer);
  [kMagic, 2, bytes.length, padded(text.length), kJson].forEach((value, i) => view.setUint32(4 * i, value, true));
  bytes.fill(0x20, 20, 20 + padded(text.length));
  bytes.set(text, 20);
  view.setUint32(20 + padded(text.length), padded(body.length), true);
  view.setUint32(24 + padded(text.length), 0x004e4942, true);
  bytes.set(body, 28 + padded(text.length));
  return bytes.buffer;
}
