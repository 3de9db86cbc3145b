#include "draco/merge_values.h"

#include <draco/attributes/point_attribute.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "common/keyed_sort.h"

namespace lacerta {
namespace {

using draco::AttributeValueIndex;

// For every value the first one that has the same bits.
std::vector<uint32_t> FirstEqual(const draco::PointAttribute& attribute, size_t num_values) {
  const auto size = static_cast<size_t>(attribute.byte_stride());
  std::vector<uint32_t> first(num_values, 0), column(num_values);
  for (size_t begin = 0; begin < size; begin += sizeof(uint32_t)) {
    for (uint32_t i = 0; i < num_values; ++i) {
      column[i] = 0;
      std::memcpy(&column[i], attribute.GetAddress(AttributeValueIndex(i)) + begin, std::min(sizeof(uint32_t), size - begin));
    }
    RefineEqual(column, &first);
  }
  return first;
}

void MergeEqualValues(uint32_t num_points, draco::PointAttribute* attribute) {
  const std::vector<uint32_t> first = FirstEqual(*attribute, num_points);
  std::vector<uint32_t> merged(num_points);
  uint32_t num_merged = 0;
  for (uint32_t i = 0; i < num_points; ++i) merged[i] = first[i] == i ? num_merged++ : merged[first[i]];
  if (num_merged == num_points) return;
  attribute->SetExplicitMapping(num_points);
  for (uint32_t i = 0; i < num_points; ++i) {
    if (first[i] == i) attribute->SetAttributeValue(AttributeValueIndex(merged[i]), attribute->GetAddress(AttributeValueIndex(i)));
    attribute->SetPointMapEntry(draco::PointIndex(i), AttributeValueIndex(merged[i]));
  }
  attribute->Resize(num_merged);
}

}  // namespace

void MergeEqualValues(draco::Mesh* mesh) {
  for (int id = 0; id < mesh->num_attributes(); ++id) MergeEqualValues(mesh->num_points(), mesh->attribute(id));
}

}  // namespace lacerta
