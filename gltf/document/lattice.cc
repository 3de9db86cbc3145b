#include "document/lattice.h"

#include <draco/compression/attributes/normal_compression_utils.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

namespace lacerta {
namespace {

void Store(float value, uint64_t index, Bytes* bytes) {
  std::memcpy(bytes->data() + index * sizeof(float), &value, sizeof(float));
}

}  // namespace

int64_t Lattice::Round(float value, uint32_t component) const {
  const auto last = static_cast<float>((int64_t{1} << bits) - 1);
  const float k = std::floor((value - origin[component]) * (last / range) + 0.5f);
  if (!(k > 0.0f)) return 0;  // NaN, too: of values that are not finite, or so far apart that the range is not
  return static_cast<int64_t>(std::min(k, last));
}

float Lattice::At(int64_t k, uint32_t component) const {
  const auto last = static_cast<float>((int64_t{1} << bits) - 1);
  return static_cast<float>(k) * (range / last) + origin[component];
}

Lattice FitLattice(const AccessorData& data, int bits) {
  Lattice lattice;
  lattice.bits = bits;
  float range = 0.0f;
  const std::vector<ComponentRange> ranges = ComponentRanges(data);
  for (size_t c = 0; c < ranges.size(); ++c) {
    lattice.origin[c] = ranges[c].low;
    range = std::max(range, ranges[c].high - ranges[c].low);
  }
  lattice.range = range > 0.0f ? range : 1.0f;
  return lattice;
}

Lattice LatticeOfStep(const Lattice& box, float step) {
  Lattice lattice = box;
  const double steps = std::max(1.0, static_cast<double>(box.range) / static_cast<double>(step));  // 1 where that is NaN
  lattice.bits = static_cast<int>(std::clamp(std::ceil(std::log2(steps + 1.0)), 1.0, static_cast<double>(kMostLatticeBits)));
  const double last = static_cast<double>((int64_t{1} << lattice.bits) - 1);
  lattice.range = std::max(static_cast<float>(last * static_cast<double>(step)), box.range);
  return lattice;
}

AccessorData RoundToLattice(const AccessorData& data, const Lattice& lattice) {
  AccessorData rounded = data;
  for (uint64_t i = 0; i < data.count; ++i) {
    for (uint32_t c = 0; c < data.components; ++c) {
      Store(lattice.At(lattice.Round(data.Float(i, c), c), c), i * data.components + c, &rounded.bytes);
    }
  }
  return rounded;
}

AccessorData RoundKeepingSums(const AccessorData& data, const Lattice& lattice) {
  constexpr uint32_t kMostComponents = 4;
  const double step = static_cast<double>(lattice.range) / static_cast<double>((int64_t{1} << lattice.bits) - 1);
  AccessorData rounded = data;
  for (uint64_t i = 0; i < data.count; ++i) {
    std::array<int64_t, kMostComponents> k = {};
    std::array<double, kMostComponents> exact = {};
    double sum = 0.0;
    int64_t missing = 0;
    for (uint32_t c = 0; c < data.components; ++c) {
      exact[c] = static_cast<double>(data.Float(i, c)) / step;
      k[c] = lattice.Round(data.Float(i, c), c);
      sum += exact[c];
      missing -= k[c];
    }
    constexpr double kMost = 1e15;  // beyond, there is nothing to be kept
    missing = std::fabs(sum) < kMost ? missing + static_cast<int64_t>(std::floor(sum + 0.5)) : 0;
    // Not more than half a step is missing in each component.
    for (uint32_t tries = 0; tries < data.components && missing != 0; ++tries) {
      const int64_t move = missing > 0 ? 1 : -1;
      uint32_t best = data.components;
      double most = 0.0;  // by how much the component was rounded the other way
      for (uint32_t c = 0; c < data.components; ++c) {
        const double left = static_cast<double>(move) * (exact[c] - static_cast<double>(k[c]));
        if (left > most) most = left, best = c;
      }
      if (best == data.components) break;
      k[best] += move;
      missing -= move;
    }
    for (uint32_t c = 0; c < data.components; ++c) Store(lattice.At(k[c], c), i * data.components + c, &rounded.bytes);
  }
  return rounded;
}

AccessorData RoundOctahedral(const AccessorData& normals, int bits) {
  draco::OctahedronToolBox box;
  box.SetQuantizationBits(bits);
  AccessorData rounded = normals;
  for (uint64_t i = 0; i < normals.count; ++i) {
    float vector[3] = {normals.Float(i, 0), normals.Float(i, 1), normals.Float(i, 2)};
    int32_t s = 0;
    int32_t t = 0;
    box.FloatVectorToQuantizedOctahedralCoords(vector, &s, &t);
    box.QuantizedOctahedralCoordsToUnitVector(s, t, vector);
    for (uint32_t c = 0; c < 3; ++c) Store(vector[c], 3 * i + c, &rounded.bytes);
  }
  return rounded;
}

AccessorData AsFloat(const AccessorData& data) {
  if (data.type == ComponentType::kFloat) return data;
  AccessorData floats;
  floats.components = data.components;
  floats.count = data.count;
  floats.bytes.resize(static_cast<size_t>(data.count) * data.components * sizeof(float));
  for (uint64_t i = 0; i < data.count; ++i) {
    for (uint32_t c = 0; c < data.components; ++c) Store(data.Float(i, c), i * data.components + c, &floats.bytes);
  }
  return floats;
}

}  // namespace lacerta
