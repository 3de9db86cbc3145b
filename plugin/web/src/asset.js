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
 * {data, refinements, streams: [{vertexCounts, triangleCounts, errors, min, max, normals, segments: [{offset, length}]}], order: [{stream, part,
 * offset, length}], length}; offsets are from the front of all segments. Throws where it contradicts itself.
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
  streams.forEach((stream, s) => demand(stream.segments.length === stream.errors.length, `stream ${s} has ${stream.segments.length} segments`));
  return {data: extension.data, refinements: extension.refinements, streams, order, length: offset};
}

/** The extension of a primitive, {stream, group}, or undefined; throws where the stream does not exist. */
export function progressivePrimitive(primitive, progressive) {
  const extension = primitive.extensions?.[extensionName];
  if (extension === undefined || progressive === undefined) return undefined;
  demand(isIndex(extension.stream) && extension.stream < progressive.streams.length, `stream ${extension.stream} does not exist`);
  return {stream: extension.stream, group: extension.group ?? 0};
}
