#include "extension/progressive.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

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

StatusOr<ProgressiveStream> ParseStream(const Json& json) {
  ProgressiveStream stream;
  LACERTA_ASSIGN_OR_RETURN(stream.vertex_counts, ParseIndices(json, "vertexCounts"));
  LACERTA_ASSIGN_OR_RETURN(stream.triangle_counts, ParseIndices(json, "triangleCounts"));
  LACERTA_ASSIGN_OR_RETURN(stream.errors, ParseNumbers(json, "errors"));
  LACERTA_RETURN_IF_ERROR(ParseVec3(json, "min", &stream.min));
  LACERTA_RETURN_IF_ERROR(ParseVec3(json, "max", &stream.max));
  stream.smooth_normals = AsString(Find(json, "normals")) == "smooth";
  const size_t levels = stream.vertex_counts.size();
  if (levels == 0 || stream.triangle_counts.size() != levels || stream.errors.size() != levels) {
    return InvalidData("\"vertexCounts\", \"triangleCounts\" and \"errors\" are not of one length above 0");
  }
  return stream;
}

Status CheckSegments(const Progressive& progressive) {
  std::vector<uint64_t> counts(progressive.streams.size(), 0);
  uint64_t sum = 0;
  for (const Segment& segment : progressive.segments) {
    if (segment.stream >= counts.size()) {
      return InvalidData("segments.stream: stream " + std::to_string(segment.stream) + " does not exist");
    }
    if (segment.length > std::numeric_limits<uint64_t>::max() - sum)
      return InvalidData("segments.byteLength overflows");
    sum += segment.length;
    ++counts[static_cast<size_t>(segment.stream)];
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

}  // namespace

StatusOr<Progressive> ParseProgressive(const GltfDocument& document) {
  const Json* extensions = Find(document.json, "extensions");
  const Json* extension = extensions == nullptr ? nullptr : Find(*extensions, kProgressiveName);
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
    for (const double error : stream.errors) errors.push_back(static_cast<float>(error));
    Json json = {{"vertexCounts", stream.vertex_counts},
                 {"triangleCounts", stream.triangle_counts},
                 {"errors", std::move(errors)},
                 {"min", {stream.min.x, stream.min.y, stream.min.z}},
                 {"max", {stream.max.x, stream.max.y, stream.max.z}}};
    if (stream.smooth_normals) json["normals"] = "smooth";
    streams.push_back(std::move(json));
  }
  return {{"version", kProgressiveVersion},
          {"data", progressive.data},
          {"segments", std::move(segments)},
          {"streams", std::move(streams)}};
}

StatusOr<GatheredStream> GatherStream(const GltfDocument& document, const Progressive& progressive, uint64_t stream) {
  LACERTA_ASSIGN_OR_RETURN(const Span<const uint8_t> data, AvailableViewBytes(document, progressive.data));
  GatheredStream gathered;
  uint64_t offset = 0;
  bool is_base = true;
  for (const Segment& segment : progressive.segments) {
    if (segment.stream == stream && gathered.complete) {
      const uint64_t begin = std::min<uint64_t>(offset, data.size());
      const uint64_t length = std::min<uint64_t>(segment.length, data.size() - begin);
      gathered.bytes.insert(gathered.bytes.end(), data.begin() + begin, data.begin() + begin + length);
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

std::vector<Segment> OrderSegments(const std::vector<std::vector<uint64_t>>& part_lengths,
                                   const std::vector<std::vector<double>>& errors) {
  std::vector<Segment> order;
  std::vector<size_t> next(part_lengths.size(), 1);
  for (size_t s = 0; s < part_lengths.size(); ++s) order.push_back({s, part_lengths[s][0]});
  for (;;) {
    size_t best = part_lengths.size();
    double best_gain = 0.0;
    for (size_t s = 0; s < part_lengths.size(); ++s) {
      if (next[s] >= part_lengths[s].size()) continue;
      const double drop = errors[s][next[s] - 1] - errors[s][next[s]];
      const double gain = drop / static_cast<double>(std::max<uint64_t>(part_lengths[s][next[s]], 1));
      if (best == part_lengths.size() || gain > best_gain) {
        best = s;
        best_gain = gain;
      }
    }
    if (best == part_lengths.size()) return order;
    order.push_back({best, part_lengths[best][next[best]]});
    ++next[best];
  }
}

}  // namespace lacerta
