// A small base with attributes of all kinds, and a stream for it.
#ifndef LACERTA_TESTS_DRACO_EXT_ENCODER_ATTRIBUTED_TEST_STREAMS_H_
#define LACERTA_TESTS_DRACO_EXT_ENCODER_ATTRIBUTED_TEST_STREAMS_H_

#include <algorithm>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "common/attribute_wedges.h"
#include "common/coefficient_sets.h"
#include "common/glued_base.h"
#include "common/octahedral.h"
#include "common/stream_layout.h"
#include "draco_ext/encoder/test_streams.h"
#include "encoder/stream_writer.h"
#include "lacerta/attributed_base.h"

namespace lacerta::testing {

// The octahedron as two groups, its upper and its lower half. Texture coordinates and normals have seams around one triangle each; the upper
// half alone has a color, the lower one alone a tangent.
inline AttributedBase OctahedronWithAttributes() {
  const BaseMesh whole = Octahedron();
  AttributedBase base;
  base.mesh.step = whole.step;
  base.group_sizes = {4, 4};
  const auto add = [&](const char* name, AttributeKind kind, uint32_t components, uint8_t upper, uint8_t lower) {
    const bool is_normal = kind == AttributeKind::kNormal;
    BaseAttribute& a = base.attributes.emplace_back();
    a.precision = {name, kind, components, is_normal ? 0.0f : 1.0f / 128, is_normal ? 8 : 0};
    a.in_group = {upper, lower};
  };
  add("TEXCOORD_0", AttributeKind::kTextureCoordinates, 2, 1, 1);
  add("NORMAL", AttributeKind::kNormal, 3, 1, 1);
  add("COLOR_0", AttributeKind::kColor, 3, 1, 0);
  add("TANGENT", AttributeKind::kTangent, 4, 0, 1);
  for (uint32_t f = 0; f < whole.triangles.size(); ++f) {
    for (const uint32_t v : whole.triangles[f]) {
      const auto& p = whole.lattice[v];
      const auto put = [&](size_t a, std::initializer_list<int32_t> numbers) { base.attributes[a].values.insert(base.attributes[a].values.end(), numbers); };
      const int32_t i = static_cast<int32_t>(v), away = f == 3 ? 100 : 0;
      base.mesh.lattice.push_back(p);
      put(0, {17 * i - 20 + away, 90 - 13 * i * i});
      const Vec3f normal{static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]) + (f == 5 ? 20.0f : 0.0f)};
      const auto point = OctahedralFromNormal(normal, 8);
      put(1, {point[0], point[1]});
      put(2, {20 * i, 128 - 9 * i, 64});
      put(3, {p[1] * 2, -p[0] * 2, 30, 128});
    }
    base.mesh.triangles.push_back({3 * f, 3 * f + 1, 3 * f + 2});
  }
  return base;
}

// Steps and random residuals of the attributes of a base: level 2 has none of the first one. is_chained: of colors.
inline WrittenAttributes RandomResiduals(const AttributedBase& base, int num_levels, uint32_t seed, double scale, bool is_chained = false) {
  std::mt19937 random(seed);
  const GluedBase glued = GlueBase(base).value();
  WrittenAttributes written{BaseChecksum(base), {}, {}};
  for (size_t a = 0; a < base.attributes.size(); ++a) {
    AttributeWedges wedges = MakeAttributeWedges(glued.attributes[a].base_corners, glued.attributes[a].num_base_values).value();
    written.wedges.push_back(wedges);
    CodedAttribute coded;
    coded.header.precision = base.attributes[a].precision;
    coded.header.prediction = coded.header.precision.kind == AttributeKind::kNormal  ? AttributePrediction::kGeometry
                              : coded.header.precision.kind == AttributeKind::kColor ? AttributePrediction::kLinear
                                                                                      : AttributePrediction::kButterfly;
    coded.header.is_chained = is_chained && HasChain(coded.header.precision);
    for (int level = 0; level < num_levels; ++level) {
      if (level > 0) RefineWedges(&wedges);
      const bool is_silent = level == 1 && a == 0;
      coded.header.steps.push_back(is_silent ? 0.0f : RoundStep(0.004f * static_cast<float>(1 + level)));
      coded.residuals.emplace_back(is_silent ? 0 : CodedComponents(coded.header.precision) * wedges.topology.num_edges());
      for (int32_t& q : coded.residuals.back()) q = static_cast<int32_t>(std::lround(scale * (static_cast<double>(random() % 2001) / 1000 - 1)));
    }
    written.coded.push_back(std::move(coded));
  }
  return written;
}

struct AttributedTestStream {
  AttributedBase base;
  Coefficients positions;
  WrittenAttributes attributes;
  RefinementBytes refinement;
};

// Positions of level 3 are silent, its attributes are not.
inline AttributedTestStream MakeAttributedTestStream(const AttributedBase& base, int num_levels, uint32_t seed, double scale, bool is_chained = false) {
  const BaseMesh glued = GlueBase(base).value().mesh;
  AttributedTestStream stream{base, RandomCoefficients(glued, num_levels, seed, scale), RandomResiduals(base, num_levels, seed + 1, scale, is_chained), {}};
  if (num_levels >= 3) Silence(3, &stream.positions);
  const std::vector<Topology> topologies = BuildTopologies(glued, num_levels).value();
  stream.refinement =
      WriteRefinement(glued, topologies, stream.positions.steps, stream.positions.levels, {}, BaseStepField::kWritten, &stream.attributes).value();
  return stream;
}

}  // namespace lacerta::testing

#endif  // LACERTA_TESTS_DRACO_EXT_ENCODER_ATTRIBUTED_TEST_STREAMS_H_
