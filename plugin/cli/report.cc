#include "report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "lacerta/surface_distance.h"

namespace lacerta::cli {

Json NumberOrNull(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json ToJson(const EncodeReport& report) {
  Json levels = Json::array();
  for (const LevelReport& level : report.levels) {
    levels.push_back({{"vertices", level.vertices},
                      {"triangles", level.triangles},
                      {"bytes", level.bytes},
                      {"error", NumberOrNull(level.error)},
                      {"psnr", NumberOrNull(level.psnr)}});
  }
  return {{"inputVertices", report.input_vertices},
          {"inputTriangles", report.input_triangles},
          {"diagonal", NumberOrNull(report.diagonal)},
          {"cleaned",
           {{"weldedVertices", report.clean.welded_vertices},
            {"degenerateTriangles", report.clean.degenerate_triangles},
            {"duplicateTriangles", report.clean.duplicate_triangles},
            {"isolatedVertices", report.clean.isolated_vertices}}},
          {"parts",
           {{"refinedComponents", report.parts.refined_components},
            {"stillComponents", report.parts.still_components},
            {"hiddenComponents", report.parts.hidden_components},
            {"flippedTriangles", report.parts.flipped_triangles},
            {"cutEdges", report.parts.cut_edges},
            {"mendedTears", report.parts.mended_tears},
            {"strayComponents", report.parts.stray_components},
            {"splitVertices", report.parts.split_vertices}}},
          {"progressive", report.progressive},
          {"subdividedInput", report.subdivided_input},
          {"reason", report.reason},
          {"normalShare", NumberOrNull(report.normal_share)},
          {"remeshPsnr", NumberOrNull(report.remesh_psnr)},
          {"measurements", report.measurements},
          {"levels", std::move(levels)}};
}

Json ToJson(const PackReport& report) {
  Json primitives = Json::array();
  for (const PrimitiveReport& primitive : report.primitives) {
    Json json = {{"mesh", primitive.mesh},
                 {"primitive", primitive.primitive},
                 {"name", primitive.name},
                 {"storage", StorageName(primitive.storage)},
                 {"reason", primitive.reason},
                 {"bytesBefore", primitive.bytes_before},
                 {"bytesAfter", primitive.bytes_after}};
    const bool is_stream = !primitive.encode.levels.empty();
    if (is_stream) json["encode"] = ToJson(primitive.encode);
    const bool is_draco = primitive.storage == PrimitiveStorage::kDraco && !is_stream;
    if (is_draco || !primitive.attributes.empty()) {
      json["error"] = NumberOrNull(primitive.error);
      json["targetError"] = NumberOrNull(primitive.target_error);
      if (is_draco) json["attributes"] = {{"POSITION", {{"bits", primitive.position_bits}}}};
      for (const AttributeReport& attribute : primitive.attributes) {
        Json& to = json["attributes"][attribute.name];
        to = {{"error", NumberOrNull(attribute.error)}, {"unit", attribute.unit}};
        if (is_draco) to["bits"] = attribute.bits;
      }
    }
    primitives.push_back(std::move(json));
  }
  return {{"primitives", std::move(primitives)}, {"notes", report.notes}};
}

Json ToJson(const StreamInfo& stream) {
  Json levels = Json::array();
  for (const StreamInfo::Level& level : stream.levels) {
    Json json = {{"vertices", level.vertices}, {"triangles", level.triangles}, {"bytes", level.bytes}};
    json["error"] = level.error.has_value() ? NumberOrNull(*level.error) : Json();
    json["psnr"] = level.error.has_value() ? NumberOrNull(Psnr(*level.error, stream.diagonal)) : Json();
    json["available"] = level.available;
    levels.push_back(std::move(json));
  }
  return {{"mesh", stream.mesh},
          {"primitive", stream.primitive},
          {"name", stream.name},
          {"diagonal", NumberOrNull(stream.diagonal)},
          {"levels", std::move(levels)}};
}

Json ToJson(const std::vector<PrimitiveInfo>& primitives) {
  Json json = Json::array();
  for (const PrimitiveInfo& primitive : primitives) {
    json.push_back({{"mesh", primitive.mesh},
                    {"primitive", primitive.primitive},
                    {"name", primitive.name},
                    {"storage", StorageName(primitive.storage)},
                    {"vertices", primitive.vertices},
                    {"triangles", primitive.triangles},
                    {"bytes", primitive.bytes}});
  }
  return json;
}

void PrintJson(const Json& json) {
  std::printf("%s\n", json.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
}

void PrintTable(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows) {
  std::vector<size_t> widths;
  widths.reserve(header.size());
  for (const std::string& cell : header) widths.push_back(cell.size());
  for (const auto& row : rows) {
    for (size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  const auto print_row = [&](const std::vector<std::string>& row) {
    for (size_t i = 0; i < row.size(); ++i)
      std::printf("%s%*s", i == 0 ? "" : "  ", static_cast<int>(widths[i]), row[i].c_str());
    std::printf("\n");
  };
  print_row(header);
  for (const auto& row : rows) print_row(row);
}

std::string Fixed(double value, int decimals) {
  char text[64];
  std::snprintf(text, sizeof(text), "%.*f", decimals, value);
  return text;
}

std::string Short(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof(text), "%.*g", digits, value);
  return text;
}

const char* StorageName(PrimitiveStorage storage) {
  switch (storage) {
    case PrimitiveStorage::kProgressive:
      return "progressive";
    case PrimitiveStorage::kDraco:
      return "draco";
    case PrimitiveStorage::kUntouched:
      return "untouched";
  }
  return "";
}

const char* FallbackName(Fallback fallback) {
  switch (fallback) {
    case Fallback::kDraco:
      return "draco";
    case Fallback::kPlain:
      return "plain";
    case Fallback::kNone:
      return "none";
  }
  return "";
}

void PrintLevels(const EncodeReport& report) {
  std::vector<std::vector<std::string>> rows;
  for (size_t i = 0; i < report.levels.size(); ++i) {
    const LevelReport& level = report.levels[i];
    const double bpv =
        8.0 * static_cast<double>(level.bytes) / static_cast<double>(std::max<uint64_t>(report.input_vertices, 1));
    rows.push_back({std::to_string(i), std::to_string(level.triangles), std::to_string(level.bytes), Fixed(bpv, 3),
                    Short(level.error, 4), Fixed(level.psnr, 2)});
  }
  PrintTable({"level", "triangles", "bytes", "b/iv", "error", "PSNR dB"}, rows);
}

void PrintPrecision(const PrimitiveReport& report) {
  std::printf("  POSITION %d bits, error %s of %s", report.position_bits, Short(report.error, 3).c_str(),
              Short(report.target_error, 3).c_str());
  for (const AttributeReport& attribute : report.attributes) {
    if (attribute.bits == 0) {
      std::printf("; %s exact", attribute.name.c_str());
    } else {
      std::printf("; %s %d bits, %s%s%s", attribute.name.c_str(), attribute.bits, Short(attribute.error, 3).c_str(),
                  attribute.unit.empty() ? "" : " ", attribute.unit.c_str());
    }
  }
  std::printf("\n");
}

void PrintPrimitives(const std::vector<PrimitiveInfo>& primitives) {
  std::vector<std::vector<std::string>> rows;
  for (const PrimitiveInfo& primitive : primitives) {
    if (primitive.storage == PrimitiveStorage::kProgressive) continue;
    rows.push_back({std::to_string(primitive.mesh), std::to_string(primitive.primitive), StorageName(primitive.storage),
                    std::to_string(primitive.vertices), std::to_string(primitive.triangles),
                    std::to_string(primitive.bytes), primitive.name});
  }
  if (!rows.empty()) PrintTable({"mesh", "primitive", "storage", "vertices", "triangles", "bytes", "name"}, rows);
}

void PrintLevels(const StreamInfo& stream) {
  std::vector<std::vector<std::string>> rows;
  for (size_t i = 0; i < stream.levels.size(); ++i) {
    const StreamInfo::Level& level = stream.levels[i];
    rows.push_back({std::to_string(i), std::to_string(level.vertices), std::to_string(level.triangles),
                    std::to_string(level.bytes), level.error.has_value() ? Short(*level.error, 4) : "-",
                    level.error.has_value() ? Fixed(Psnr(*level.error, stream.diagonal), 2) : "-",
                    level.available ? "yes" : "no"});
  }
  PrintTable({"level", "vertices", "triangles", "bytes", "error", "PSNR dB", "in file"}, rows);
}

}  // namespace lacerta::cli
