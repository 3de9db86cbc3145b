// The JSON of LACERTA_mesh_progressive as a checked value.
export const extensionName = 'LACERTA_mesh_progressive';

function demand(condition, what) {
  if (!condition) throw new Error(`${extensionName}: ${what}`);
}
const isIndex = value => Number.isSafeInteger(value) && value >= 0;
const areIndices = value => Array.isArray(value) && value.every(isIndex);
const areNumbers = (value, length) => Array.isArray(value) && value.length === length && value.every(Number.isFinite);

/**
 * Reads the extension at the root of a glTF document. Returns undefined where there is none, else
 * {data, refinements, streams: [{vertexCounts, triangleCounts, errors, min, max, normals, baseLengths, attributes, joints, segments: [{offset, length}]}],
 * order: [{stream, part, offset, length}], length, available: less where the asset was trimmed}; offsets are from the front of all segments. Throws
 * where it contradicts itself.
 */
export function parseProgressive(json) {
  const extension = json.extensions?.[extensionName];
  if (extension === undefined) return undefined;
  demand(extension.version === 1, `version ${extension.version} is not known, only 1`);
  const isView = view => isIndex(view) && json.bufferViews?.[view] !== undefined;
  demand(isView(extension.data), '"data" is no bufferView');
  demand(extension.refinements === undefined || isView(extension.refinements), '"refinements" is no bufferView');
  const {stream: owners, byteLength: lengths} = extension.segments ?? {};
  demand(areIndices(owners) && areIndices(lengths) && owners.length === lengths.length, '"segments" are malformed');
  demand(Array.isArray(extension.streams), '"streams" are missing');
  const streams = extension.streams.map((stream, s) => {
    const levels = stream.vertexCounts?.length;
    demand(levels > 0 && areIndices(stream.vertexCounts) && areIndices(stream.triangleCounts) && stream.triangleCounts.length === levels &&
      areNumbers(stream.errors, levels) && areNumbers(stream.min, 3) && areNumbers(stream.max, 3), `stream ${s} is malformed`);
    return {...stream, segments: []};
  });
  let offset = 0;
  const order = owners.map((s, i) => {
    demand(s < streams.length, `segment ${i} belongs to stream ${s}, which does not exist`);
    const segment = {stream: s, part: streams[s].segments.length, offset, length: lengths[i]};
    streams[s].segments.push(segment);
    offset += lengths[i];
    return segment;
  });
  streams.forEach((stream, s) => {
    demand(stream.segments.length === stream.errors.length, `stream ${s} has ${stream.segments.length} segments`);
    const {baseLengths, attributes = [], joints} = stream;
    demand(baseLengths === undefined ? attributes.length === 0 : areIndices(baseLengths) && baseLengths.length > 0 && Array.isArray(attributes) &&
      attributes.every(name => typeof name === 'string') && baseLengths.reduce((sum, length) => sum + length, 0) === stream.segments[0].length,
    `the attributes or groups of stream ${s} are malformed`);
    demand(joints === undefined || areIndices(joints) && joints.length > 0 && joints.length <= 1024 && new Set(joints).size === joints.length && Math.max(...joints) < 65536 &&
      attributes.includes('WEIGHTS_0'), `the joints of stream ${s} are not those of weights`);
  });
  const views = [extension.data, extension.refinements].filter(view => view !== undefined).map(view => json.bufferViews[view].byteLength ?? Infinity);
  return {data: extension.data, refinements: extension.refinements, streams, order, length: offset,
    available: Math.min(offset, views.reduce((sum, bytes) => sum + bytes, 0))};
}

/** The extension of a primitive, {stream, group}, or undefined; throws where the stream or group does not exist. */
export function progressivePrimitive(primitive, progressive) {
  const extension = primitive.extensions?.[extensionName];
  if (extension === undefined || progressive === undefined) return undefined;
  demand(isIndex(extension.stream) && extension.stream < progressive.streams.length, `stream ${extension.stream} does not exist`);
  const {stream, group = 0} = extension;
  demand(isIndex(group) && group < (progressive.streams[stream].baseLengths?.length ?? 1), `group ${group} of stream ${stream} does not exist`);
  return {stream, group};
}

/** Where the Draco streams of a base section lie in it: [{begin, end}], one per group. */
export function baseParts(stream) {
  let end = 0;
  return (stream.baseLengths ?? [stream.segments[0].length]).map(length => ({begin: end, end: end += length}));
}
