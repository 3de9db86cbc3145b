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

const rangeOf = ({byteOffset = 0, byteLength}) => ({begin: byteOffset, end: byteOffset + byteLength});

// The bufferViews of images that nothing else refers to.
function imageViews(json) {
  const {images = [], ...rest} = json, views = new Set(images.map(image => image.bufferView));
  JSON.stringify(rest, (key, value) => {
    if (key === 'bufferView') views.delete(value);
    return value;
  });
  return views;
}

/** Where images lie in the first buffer: [{begin, end}]. Surfaces can be shown without them. */
export function imageRanges(json) {
  const images = imageViews(json);
  return json.bufferViews.filter((view, i) => view.buffer === 0 && images.has(i)).map(rangeOf);
}

/** Where in the first buffer the bytes lie that have to be there before anything is shown: [{begin, end}], bases of streams included, images not. */
export function neededRanges(json, progressive) {
  const images = imageViews(json);
  const ranges = json.bufferViews.filter((view, i) => view.buffer === 0 && i !== progressive.data && !images.has(i)).map(rangeOf);
  const bases = progressive.order.filter(segment => segment.part === 0);
  const data = json.bufferViews[progressive.data];
  if (data.buffer === 0) {
    const {begin, end} = rangeOf(data);
    ranges.push({begin, end: Math.min(end, begin + Math.max(0, ...bases.map(base => base.offset + base.length)))});
  }
  return ranges;
}

/** Ranges in order, those that touch or lie close as one. */
export function joined(ranges) {
  const result = [];
  for (const range of [...ranges].sort((a, b) => a.begin - b.begin)) {
    const last = result.at(-1);
    if (last && range.begin <= last.end + 4096) last.end = Math.max(last.end, range.end);
    else result.push({...range});
  }
  return result;
}

/** The front of a file, as its bytes come in. */
export class GrowingBytes {
  #buffer = new Uint8Array(1 << 16);
  length = 0;
  append(bytes) {
    if (this.length + bytes.length > this.#buffer.length) {
      const larger = new Uint8Array(Math.max(2 * this.#buffer.length, this.length + bytes.length));
      larger.set(this.bytes);
      this.#buffer = larger;
    }
    this.#buffer.set(bytes, this.length);
    this.length += bytes.length;
  }
  get bytes() { return this.#buffer.subarray(0, this.length); }
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
