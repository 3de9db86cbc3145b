#include "extension/progressive.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <set>
#include <string>
#include <utility>

#include "common/attribute_layout.h"
#include "document/buffer_edit.h"

namespace lacerta {
namespace {

StatusOr<std::vector<uint64_t>> ParseIndices(const Json& object, const char* key) {
  const Json* array = Find(object, key);
  if (array == nullptr || !array->is_array()) return InvalidData(std::string("\"") + key + "\" is no array");
  std::vector<uint64_t> values;
  values.reserve(array->size());
  for (const Json& element : *array) {
    const std::optional<uint64_t> value = AsIndex(&element);
    if (!value.has_value())
      return InvalidData(std::string("\"") + key + "\" holds something else than integers from 0 on");
    values.push_back(*value);
  }
  return values;
}

StatusOr<std::vector<double>> ParseNumbers(const Json& object, const char* key) {
  const Json* array = Find(object, key);
  if (array == nullptr || !array->is_array()) return InvalidData(std::string("\"") + key + "\" is no array");
  std::vector<double> values;
  for (const Json& element : *array) {
    const std::optional<double> value = AsNumber(&element);
    if (!value.has_value() || !std::isfinite(*value))
      return InvalidData(std::string("\"") + key + "\" holds no number");
    values.push_back(*value);
  }
  return values;
}

Status ParseVec3(const Json& object, const char* key, Vec3f* value) {
  LACERTA_ASSIGN_OR_RETURN(const std::vector<double> numbers, ParseNumbers(object, key));
  if (numbers.size() != 3) return InvalidData(std::string("\"") + key + "\" does not have three numbers");
  for (int axis = 0; axis < 3; ++axis) {
    const double number = numbers[static_cast<size_t>(axis)];
    if (std::abs(number) > std::numeric_limits<float>::max())
      return InvalidData(std::string("\"") + key + "\" is too large");
    (*value)[axis] = static_cast<float>(number);
  }
  return Status();
}

// A table of weights needs weights, and names no joint twice.
Status ParseJoints(const Json& json, ProgressiveStream* stream) {
  if (Find(json, "joints") == nullptr) return Status();
  LACERTA_ASSIGN_OR_RETURN(const std::vector<uint64_t> joints, ParseIndices(json, "joints"));
  const std::set<uint64_t> distinct(joints.begin(), joints.end());
  const bool has_weights = std::count(stream->attributes.begin(), stream->attributes.end(), kWeightsName) == 1;
  if (joints.empty() || joints.size() > kMostComponents || distinct.size() != joints.size() ||
      *distinct.rbegin() > std::numeric_limits<uint16_t>::max() || !has_weights) {
    return InvalidData("\"joints\" are not those of weights");
  }
  stream->joints.assign(joints.begin(), joints.end());
  return Status();
}

StatusOr<ProgressiveStream> ParseStream(const Json& json) {
  ProgressiveStream stream;
  LACERTA_ASSIGN_OR_RETURN(stream.vertex_counts, ParseIndices(json, "vertexCounts"));
  LACERTA_ASSIGN_OR_RETURN(stream.triangle_counts, ParseIndices(json, "triangleCounts"));
  LACERTA_ASSIGN_OR_RETURN(stream.errors, ParseNumbers(json, "errors"));
  LACERTA_RETURN_IF_ERROR(ParseVec3(json, "min", &stream.min));
  LACERTA_RETURN_IF_ERROR(ParseVec3(json, "max", &stream.max));
  stream.smooth_normals = AsString(Find(json, "normals")) == "smooth";
  if (Find(json, "baseLengths") != nullptr) {
    LACERTA_ASSIGN_OR_RETURN(stream.base_lengths, ParseIndices(json, "baseLengths"));
    if (stream.base_lengths.empty()) return InvalidData("\"baseLengths\" is empty");
  }
  for (uint64_t a = 0; a < ArraySize(json, "attributes"); ++a) {
    const Json* name = FindElement(json, "attributes", a);
    if (!name->is_string()) return InvalidData("\"attributes\" holds something else than names");
    stream.attributes.push_back(name->get<std::string>());
  }
  LACERTA_RETURN_IF_ERROR(ParseJoints(json, &stream));
  const size_t levels = stream.vertex_counts.size();
  if (levels == 0 || stream.triangle_counts.size() != levels || stream.errors.size() != levels) {
    return InvalidData("\"vertexCounts\", \"triangleCounts\" and \"errors\" are not of one length above 0");
  }
  return stream;
}

Status CheckSegments(const Progressive& progressive) {
  std::vector<uint64_t> counts(progressive.streams.size(), 0);
  uint64_t sum = 0;
  const auto adds_up = [&](const Segment& base) {
    uint64_t left = base.length;
    for (const uint64_t length : progressive.streams[static_cast<size_t>(base.stream)].base_lengths) {
      if (length > left) return false;
      left -= length;
    }
    return left == 0;
  };
  for (const Segment& segment : progressive.segments) {
    if (segment.stream >= counts.size()) {
      return InvalidData("segments.stream: stream " + std::to_string(segment.stream) + " does not exist");
    }
    if (segment.length > std::numeric_limits<uint64_t>::max() - sum)
      return InvalidData("segments.byteLength overflows");
    sum += segment.length;
    const bool is_base = counts[static_cast<size_t>(segment.stream)]++ == 0;
    if (is_base && !progressive.streams[static_cast<size_t>(segment.stream)].base_lengths.empty() &&
        !adds_up(segment)) {
      return InvalidData("stream " + std::to_string(segment.stream) + ": \"baseLengths\" do not add up to its base");
    }
  }
  for (size_t s = 0; s < counts.size(); ++s) {
    const size_t levels = progressive.streams[s].vertex_counts.size();
    if (counts[s] != levels) {
      return InvalidData("stream " + std::to_string(s) + " has " + std::to_string(counts[s]) + " segments for " +
                         std::to_string(levels) + " levels");
    }
  }
  return Status();
}

StatusOr<Progressive> ParseUnnamed(const Json& extension) {
  LACERTA_ASSIGN_OR_RETURN(const uint64_t version, GetIndex(extension, "version"));
  if (version != kProgressiveVersion) {
    return Unsupported("version " + std::to_string(version) + " is not known, only " +
                       std::to_string(kProgressiveVersion) + "; a newer Lacerta may read it");
  }
  Progressive progressive;
  LACERTA_ASSIGN_OR_RETURN(progressive.data, GetIndex(extension, "data"));
  if (const Json* refinements = Find(extension, "refinements"); refinements != nullptr) {
    LACERTA_ASSIGN_OR_RETURN(const uint64_t view, GetIndex(extension, "refinements"));
    progressive.refinements = view;
  }
  const Json* segments = Find(extension, "segments");
  if (segments == nullptr) return InvalidData("\"segments\" is missing");
  LACERTA_ASSIGN_OR_RETURN(const std::vector<uint64_t> streams, ParseIndices(*segments, "stream"));
  LACERTA_ASSIGN_OR_RETURN(const std::vector<uint64_t> lengths, ParseIndices(*segments, "byteLength"));
  if (streams.size() != lengths.size()) return InvalidData("segments.stream and segments.byteLength differ in length");
  for (size_t i = 0; i < streams.size(); ++i) progressive.segments.push_back({streams[i], lengths[i]});
  for (uint64_t s = 0; s < ArraySize(extension, "streams"); ++s) {
    StatusOr<ProgressiveStream> stream = ParseStream(*FindElement(extension, "streams", s));
    if (!stream.ok()) return stream.status().WithContext("stream " + std::to_string(s));
    progressive.streams.push_back(std::move(stream).value());
  }
  LACERTA_RETURN_IF_ERROR(CheckSegments(progressive));
  return progressive;
}

// The bytes of all segments in one or two pieces.
struct Transmitted {
  Span<const uint8_t> data, refinements;

  void Append(uint64_t begin, uint64_t end, Bytes* bytes) const {
    const auto append = [&](Span<const uint8_t> piece, uint64_t offset) {
      const uint64_t from = std::clamp<uint64_t>(begin, offset, offset + piece.size()) - offset;
      const uint64_t to = std::clamp<uint64_t>(end, offset, offset + piece.size()) - offset;
      if (from < to) bytes->insert(bytes->end(), piece.begin() + from, piece.begin() + to);
    };
    append(data, 0);
    append(refinements, data.size());
  }
  uint64_t size() const { return data.size() + refinements.size(); }
};

StatusOr<Transmitted> FindTransmitted(const GltfDocument& document, const Progressive& progressive) {
  Transmitted transmitted;
  LACERTA_ASSIGN_OR_RETURN(transmitted.data, AvailableViewBytes(document, progressive.data));
  if (!progressive.refinements.has_value()) return transmitted;
  // What is missing of `data` would shift the rest.
  const uint64_t announced =
      AsIndex(Find(*FindElement(document.json, "bufferViews", progressive.data), "byteLength")).value_or(0);
  if (transmitted.data.size() < announced) return transmitted;
  LACERTA_ASSIGN_OR_RETURN(transmitted.refinements, AvailableViewBytes(document, *progressive.refinements));
  return transmitted;
}

Json ShortNumbers(const Vec3f& v) { return {ShortNumber(v.x), ShortNumber(v.y), ShortNumber(v.z)}; }

}  // namespace

StatusOr<Progressive> ParseProgressive(const GltfDocument& document) {
  const Json* extension = FindExtension(document.json, kProgressiveName);
  if (extension == nullptr) return NotFound(std::string("the asset has no ") + kProgressiveName);
  StatusOr<Progressive> progressive = ParseUnnamed(*extension);
  if (!progressive.ok()) return progressive.status().WithContext(kProgressiveName);
  return progressive;
}

Json FormatProgressive(const Progressive& progressive) {
  Json segments = {{"stream", Json::array()}, {"byteLength", Json::array()}};
  for (const Segment& segment : progressive.segments) {
    segments["stream"].push_back(segment.stream);
    segments["byteLength"].push_back(segment.length);
  }
  Json streams = Json::array();
  for (const ProgressiveStream& stream : progressive.streams) {
    Json errors = Json::array();
    for (const double error : stream.errors) errors.push_back(RoundedNumber(error));
    Json json = {{"vertexCounts", stream.vertex_counts},
                 {"triangleCounts", stream.triangle_counts},
                 {"errors", std::move(errors)},
                 {"min", ShortNumbers(stream.min)},
                 {"max", ShortNumbers(stream.max)}};
    if (stream.smooth_normals) json["normals"] = "smooth";
    if (!stream.base_lengths.empty()) json["baseLengths"] = stream.base_lengths;
    if (!stream.attributes.empty()) json["attributes"] = stream.attributes;
    if (!stream.joints.empty()) json["joints"] = stream.joints;
    streams.push_back(std::move(json));
  }
  Json json = {{"version", kProgressiveVersion}, {"data", progressive.data}};
  if (progressive.refinements.has_value()) json["refinements"] = *progressive.refinements;
  json["segments"] = std::move(segments);
  json["streams"] = std::move(streams);
  return json;
}

StatusOr<Bytes> TransmittedBytes(const GltfDocument& document, const Progressive& progressive) {
  LACERTA_ASSIGN_OR_RETURN(const Transmitted transmitted, FindTransmitted(document, progressive));
  Bytes bytes(transmitted.data.begin(), transmitted.data.end());
  bytes.insert(bytes.end(), transmitted.refinements.begin(), transmitted.refinements.end());
  return bytes;
}

Status ReplaceTransmittedBytes(Bytes data, Progressive* progressive, GltfDocument* document) {
  Json& views = document->json["bufferViews"];
  Json& old = views[static_cast<size_t>(progressive->data)];
  const uint64_t old_buffer = AsIndex(Find(old, "buffer")).value_or(0);
  const uint64_t old_begin = AsIndex(Find(old, "byteOffset")).value_or(0);
  const uint64_t old_end = old_begin + AsIndex(Find(old, "byteLength")).value_or(0);
  const uint64_t length = data.size();
  const uint64_t buffer = AddBuffer(std::move(data), document);
  for (Json& view : views) {
    const uint64_t offset = AsIndex(Find(view, "byteOffset")).value_or(0);
    const uint64_t end = offset + AsIndex(Find(view, "byteLength")).value_or(0);
    if (AsIndex(Find(view, "buffer")) != old_buffer || offset < old_begin || end > old_end || &view == &old) continue;
    if (end - old_begin > length) return InvalidData("a bufferView shows a part of the refinements");
    view["buffer"] = buffer;
    PlaceAt(offset - old_begin, &view);
  }
  old["buffer"] = buffer;
  PlaceAt(0, &old);
  old["byteLength"] = length;
  std::set<uint64_t> unused;
  if (progressive->refinements.has_value()) unused.insert(*progressive->refinements);
  progressive->refinements.reset();
  document->json["extensions"][kProgressiveName] = FormatProgressive(*progressive);
  DropUnusedViews(unused, document);
  return Status();
}

StatusOr<GatheredStream> GatherStream(const GltfDocument& document, const Progressive& progressive, uint64_t stream) {
  LACERTA_ASSIGN_OR_RETURN(const Transmitted data, FindTransmitted(document, progressive));
  GatheredStream gathered;
  uint64_t offset = 0;
  bool is_base = true;
  for (const Segment& segment : progressive.segments) {
    if (segment.stream == stream && gathered.complete) {
      const uint64_t begin = std::min<uint64_t>(offset, data.size());
      const uint64_t length = std::min<uint64_t>(segment.length, data.size() - begin);
      data.Append(begin, begin + length, &gathered.bytes);
      gathered.complete = length == segment.length;
      if (is_base) {
        gathered.base_offset = begin;
        gathered.base_length = length;
        is_base = false;
      }
    }
    offset += segment.length;
  }
  return gathered;
}

namespace {

// Parts in a row of a stream: one that lowers the error little may be on the way to one that lowers it a lot.
struct Run {
  uint64_t stream = 0;
  size_t begin = 0, end = 0;
  double gain = -std::numeric_limits<double>::infinity();  // per byte
  bool operator<(const Run& b) const {
    return gain != b.gain ? gain < b.gain : stream > b.stream;
  }  // the first of equal ones is the largest
};

Run BestRun(uint64_t stream, size_t begin, const std::vector<uint64_t>& lengths, const std::vector<double>& errors) {
  Run best{stream, begin, begin + 1};
  double bytes = 0.0;
  for (size_t end = begin + 1; end <= lengths.size(); ++end) {
    bytes += static_cast<double>(lengths[end - 1]);
    const double gain = (errors[begin - 1] - errors[end - 1]) / std::max(bytes, 1.0);
    if (gain > best.gain) best = {stream, begin, end, gain};
  }
  return best;
}

}  // namespace

std::vector<Segment> OrderSegments(const std::vector<std::vector<uint64_t>>& part_lengths,
                                   const std::vector<std::vector<double>>& errors) {
  std::vector<Segment> order;
  std::priority_queue<Run> runs;  // the next one of every stream
  const auto push = [&](uint64_t s, size_t begin) {
    if (begin < part_lengths[s].size()) runs.push(BestRun(s, begin, part_lengths[s], errors[s]));
  };
  for (size_t s = 0; s < part_lengths.size(); ++s) {
    order.push_back({s, part_lengths[s][0]});
    push(s, 1);
  }
  while (!runs.empty()) {
    const Run run = runs.top();
    runs.pop();
    for (size_t part = run.begin; part < run.end; ++part) order.push_back({run.stream, part_lengths[run.stream][part]});
    push(run.stream, run.end);
  }
  return order;
}

}  // namespace lacerta
