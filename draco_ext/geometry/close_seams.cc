#include "geometry/close_seams.h"

#include <cstddef>
#include <cstdint>

#include "geometry/value_difference.h"

namespace lacerta {
namespace {

constexpr uint32_t kNone = MeshAttribute::kNoValue;

// A value that corners of a vertex keep.
struct Kept {
  uint32_t row = 0;
  uint32_t next = kNone;  // of the same vertex
};

void CloseSeams(const std::vector<Triangle>& triangles, size_t num_vertices, double tolerance, double texture_size,
                MeshAttribute* attribute) {
  constexpr int kMostKept = 32;  // at a vertex; where a fan has more, the others stay as they are
  std::vector<Kept> kept;
  std::vector<uint32_t> first(num_vertices, kNone);  // in `kept`
  const auto value = [&](uint32_t row) { return attribute->values.data() + size_t{row} * attribute->components; };
  for (size_t f = 0; f < triangles.size(); ++f) {
    for (size_t k = 0; k < 3; ++k) {
      uint32_t& row = attribute->corners[f][k];
      if (row == kNone) continue;
      uint32_t* link = &first[triangles[f][k]];
      int num_kept = 0;
      for (; *link != kNone && num_kept < kMostKept; ++num_kept) {
        Kept& known = kept[*link];
        if (known.row == row || ErrorBetween(*attribute, texture_size, value(known.row), value(row)) <= tolerance) {
          row = known.row;
          break;
        }
        link = &known.next;
      }
      if (*link != kNone) continue;
      *link = static_cast<uint32_t>(kept.size());
      kept.push_back({row, kNone});
    }
  }
}

}  // namespace

void CloseSeams(const std::vector<double>& tolerances, double texture_size, AttributedMesh* mesh) {
  for (size_t a = 0; a < mesh->attributes.size(); ++a) {
    if (!(tolerances[a] > 0.0)) continue;
    CloseSeams(mesh->surface.triangles, mesh->surface.positions.size(), tolerances[a], texture_size, &mesh->attributes[a]);
  }
  WeldExactly(mesh);
}

}  // namespace lacerta
