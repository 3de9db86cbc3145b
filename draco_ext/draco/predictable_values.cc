#include "draco/predictable_values.h"

#include <draco/attributes/point_attribute.h>
#include <draco/compression/attributes/mesh_attribute_indices_encoding_data.h>
#include <draco/mesh/corner_table.h>
#include <draco/mesh/mesh.h>
#include <draco/mesh/mesh_attribute_corner_table.h>

#include <algorithm>

namespace lacerta {
namespace {

using draco::CornerIndex;

// Parallelograms of a value over the triangles around its corner `start`, all of whose values come before, in the order of Draco's decoder: to the
// left, from a border on to the right.
template <typename CornerTable>
void AppendParallelograms(const CornerTable& table, const std::vector<int32_t>& ranks, CornerIndex start, PredictableValues* result) {
  std::vector<std::array<uint32_t, 3>>& parallelograms = result->parallelograms;
  const size_t first = parallelograms.size();
  const auto rank = [&](CornerIndex c) { return static_cast<uint32_t>(ranks[table.Vertex(c).value()]); };
  const uint32_t predicted = rank(start);
  const auto append = [&](CornerIndex corner) {
    const CornerIndex across = table.Opposite(corner);
    if (across == draco::kInvalidCornerIndex) return;
    const std::array<uint32_t, 3> p = {rank(table.Next(across)), rank(table.Previous(across)), rank(across)};
    if (*std::max_element(p.begin(), p.end()) < predicted) parallelograms.push_back(p);
  };
  const auto is_full = [&] { return parallelograms.size() == first + kMostParallelograms; };
  append(start);
  result->has_usual.push_back(parallelograms.size() > first ? 1 : 0);
  CornerIndex corner = table.SwingLeft(start);
  for (; !is_full() && corner != draco::kInvalidCornerIndex && corner != start; corner = table.SwingLeft(corner)) append(corner);
  if (corner == draco::kInvalidCornerIndex) {
    for (corner = table.SwingRight(start); !is_full() && corner != draco::kInvalidCornerIndex; corner = table.SwingRight(corner)) append(corner);
  }
  result->first_parallelogram.push_back(static_cast<uint32_t>(parallelograms.size()));
}

}  // namespace

std::optional<PredictableValues> FindPredictableValues(const draco::MeshDecoder& decoder, int attribute) {
  const draco::PointAttribute& from = *decoder.mesh()->attribute(attribute);
  const draco::MeshAttributeIndicesEncodingData* const order = decoder.GetAttributeEncodingData(attribute);
  const draco::MeshAttributeCornerTable* const cut = decoder.GetAttributeCornerTable(attribute);  // along seams
  const draco::CornerTable* const whole = decoder.GetCornerTable();
  if (order == nullptr || whole == nullptr) return std::nullopt;
  const std::vector<CornerIndex>& corners = order->encoded_attribute_value_index_to_corner_map;
  const std::vector<int32_t>& ranks = order->vertex_to_encoded_attribute_value_index_map;
  if (corners.empty() || corners.size() != from.size()) return std::nullopt;
  PredictableValues result;
  result.components = static_cast<uint32_t>(from.num_components());
  result.values.resize(corners.size() * result.components);
  result.first_parallelogram = {0};
  for (uint32_t n = 0; n < corners.size(); ++n) {
    if (!from.ConvertValue<int32_t>(draco::AttributeValueIndex(n), from.num_components(), result.values.data() + size_t{n} * result.components)) return std::nullopt;
    if (cut != nullptr) {
      AppendParallelograms(*cut, ranks, corners[n], &result);
    } else {
      AppendParallelograms(*whole, ranks, corners[n], &result);
    }
  }
  if (std::any_of(result.values.begin(), result.values.end(), [](int32_t v) { return v < -kMostValue || v > kMostValue; })) return std::nullopt;
  return result;
}

}  // namespace lacerta
