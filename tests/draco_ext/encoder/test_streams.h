// Small base meshes and coefficients for the tests of the stream.
#ifndef LACERTA_TESTS_DRACO_EXT_ENCODER_TEST_STREAMS_H_
#define LACERTA_TESTS_DRACO_EXT_ENCODER_TEST_STREAMS_H_

#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "common/base_tags.h"
#include "common/coefficient_sets.h"
#include "common/step_forecast.h"
#include "common/subdivision.h"
#include "encoder/layer_writer.h"
#include "lacerta/decoder.h"

namespace lacerta::testing {

inline BaseMesh Octahedron() {
  return {1.0f / 64,
          {{{64, 0, 0}}, {{-64, 0, 0}}, {{0, 64, 0}}, {{0, -64, 0}}, {{0, 0, 64}}, {{0, 0, -64}}},
          {{{0, 2, 4}}, {{2, 1, 4}}, {{1, 3, 4}}, {{3, 0, 4}}, {{2, 0, 5}}, {{1, 2, 5}}, {{3, 1, 5}}, {{0, 3, 5}}}};
}

// A torus of `around` x `across` quads, each cut in two: all vertices regular.
inline BaseMesh Torus(uint32_t around, uint32_t across) {
  BaseMesh base{1.0f / 256, {}, {}};
  constexpr double kTwoPi = 6.283185307179586;
  for (uint32_t i = 0; i < around; ++i) {
    for (uint32_t j = 0; j < across; ++j) {
      const double u = kTwoPi * i / around, v = kTwoPi * j / across, r = 2 + std::cos(v);
      base.lattice.push_back({{static_cast<int32_t>(std::lround(256 * r * std::cos(u))),
                               static_cast<int32_t>(std::lround(256 * r * std::sin(u))),
                               static_cast<int32_t>(std::lround(256 * std::sin(v)))}});
      const auto at = [&](uint32_t a, uint32_t b) { return (a % around) * across + b % across; };
      base.triangles.push_back({{at(i, j), at(i + 1, j), at(i + 1, j + 1)}});
      base.triangles.push_back({{at(i, j), at(i + 1, j + 1), at(i, j + 1)}});
    }
  }
  return base;
}

// A square of two triangles: border edges and border vertices only.
inline BaseMesh Square() {
  return {0.5f, {{{0, 0, 0}}, {{2, 0, 0}}, {{2, 2, 0}}, {{0, 2, 0}}}, {{{0, 1, 2}}, {{0, 2, 3}}}};
}

// A base mesh with what it says beyond its triangles.
struct TaggedBase {
  BaseMesh base;
  BaseTags tags = {};
};

// An octahedron whose belt is a crease, with a corner in it.
inline TaggedBase OctahedronWithCrease() {
  TaggedBase result{Octahedron()};
  const Topology t = BuildTopology(6, result.base.triangles).value();
  for (const auto& [a, b] : t.edges) result.tags.crease.push_back(a < 4 && b < 4);
  result.tags.corner = {0, 0, 1, 0, 0, 0};
  return result;
}

// The square, its corners kept.
inline TaggedBase SquareWithCorners() { return {Square(), {{}, {}, {1, 1, 1, 1}, {}}}; }

// An octahedron beside three triangles at one edge, which stand still: what cannot be refined need not be manifold.
inline TaggedBase OctahedronBesideStillSheets() {
  TaggedBase result{Octahedron()};
  BaseMesh& base = result.base;
  base.lattice.insert(base.lattice.end(), {{{200, 0, 0}}, {{200, 0, 64}}, {{264, 0, 0}}, {{200, 64, 0}}, {{200, -64, 9}}});
  base.triangles.insert(base.triangles.begin() + 3, {{{6, 7, 8}}, {{6, 7, 9}}});
  base.triangles.push_back({{6, 7, 10}});
  result.tags.still.assign(base.triangles.size(), 0);
  for (const size_t f : {size_t{3}, size_t{4}, base.triangles.size() - 1}) result.tags.still[f] = 1;
  return result;
}

// Three squares that meet at one edge, cut apart there; the last one runs along it the other way.
inline TaggedBase ThreeSheets() {
  TaggedBase result{{1.0f / 32, {}, {}}};
  const std::array<std::array<int32_t, 2>, 3> ways = {{{{64, 3}}, {{-32, 60}}, {{-35, -55}}}};
  for (uint32_t sheet = 0; sheet < 3; ++sheet) {
    const auto [x, y] = ways[sheet];
    result.base.lattice.insert(result.base.lattice.end(), {{{0, 0, 0}}, {{0, 0, 64}}, {{x, y, 64}}, {{x, y, 0}}});
    const uint32_t a = 4 * sheet;
    const std::vector<Triangle> faces = {{{a, a + 1, a + 2}}, {{a, a + 2, a + 3}}};
    for (const auto& [p, q, r] : faces) result.base.triangles.push_back(sheet == 2 ? Triangle{p, r, q} : Triangle{p, q, r});
  }
  result.tags.joined = FirstAtSamePoint(result.base.lattice);
  return result;
}

inline std::vector<TaggedBase> TaggedBases() {
  return {OctahedronWithCrease(), SquareWithCorners(), OctahedronBesideStillSheets(), ThreeSheets()};
}

struct Coefficients {
  std::vector<LevelSteps> steps;
  std::vector<QuantizedLevel> levels;
};

// Two-sided geometric coefficients whose scale falls from level to level; the tangential set of level 2 is not coded.
inline Coefficients RandomCoefficients(const BaseMesh& base, int num_levels, uint32_t seed, double scale = 6.0,
                                       const BaseTags& tags = {}) {
  std::mt19937 random(seed);
  Coefficients result;
  Topology t = BuildTopology(static_cast<uint32_t>(base.lattice.size()), base.triangles, tags).value();
  for (int level = 1; level <= num_levels; ++level, scale /= 2) {
    const LevelSteps steps = {RoundStep(0.01f / static_cast<float>(level)), level == 2 ? 0.0f : RoundStep(0.02f), 3,
                              static_cast<uint8_t>(level == 2 ? 0 : 5)};
    QuantizedLevel q;
    // Of geometric distribution, without a function of the math library: golden streams depend on it.
    const auto draw = [&](double mean) {
      const auto limit = static_cast<uint64_t>(4294967296.0 * mean / (1 + mean));
      int32_t magnitude = 0;
      while (random() < limit) ++magnitude;
      return (random() & 1) != 0 ? magnitude : -magnitude;
    };
    for (uint32_t e = 0; e < t.num_edges(); ++e) {
      q.normal.push_back(t.is_copy(e) ? 0 : draw(scale));
      for (int k = 0; k < 2; ++k) q.tangential.push_back(level == 2 || t.is_copy(e) ? 0 : draw(scale / 6));
    }
    result.steps.push_back(steps);
    result.levels.push_back(std::move(q));
    t = Refine(t);
  }
  return result;
}

// The same with the first levels curved.
inline Coefficients Curved(Coefficients c, int num_curved) {
  for (int i = 0; i < num_curved; ++i) c.steps[i].is_curved = true;
  return c;
}

// Steps as the default mode takes them.
inline std::vector<LevelSteps> LawfulSteps(size_t num_levels) {
  std::vector<LevelSteps> steps;
  for (int bits = StepToBits(RoundStep(0.01f)); steps.size() < num_levels; bits = NextStepBits(bits)) {
    const float normal = StepFromBits(static_cast<uint16_t>(bits));
    steps.push_back({normal, 2 * normal, 0, 0});
  }
  return steps;
}

// The coefficients in three rounds: levels 1 and 2 on steps 8 times larger, then all on steps twice as large, then as they are. In the
// second and third round level 1 waits for level 2.
inline std::vector<LayerValues> InLayers(const Coefficients& c) {
  std::vector<LayerValues> segments;
  for (const int shift : {3, 1, 0}) {
    const size_t num_levels = shift == 3 ? std::min<size_t>(2, c.levels.size()) : c.levels.size();
    for (size_t i = 0; i < num_levels; ++i) {
      if (c.steps[i].is_silent()) continue;
      QuantizedLevel values = c.levels[i];
      for (auto* set : {&values.normal, &values.tangential}) {
        for (int32_t& q : *set) q = q < 0 ? -(-q >> shift) : q >> shift;
      }
      segments.push_back({{static_cast<int>(i) + 1, shift, shift < 3 && i == 0 && c.levels.size() > 1}, std::move(values)});
    }
  }
  return segments;
}

// Without coefficients in one of the levels.
inline void Silence(size_t level, Coefficients* c) {
  c->steps[level - 1] = {};
  QuantizedLevel& q = c->levels[level - 1];
  q.normal.assign(q.normal.size(), 0);
  q.tangential.assign(q.tangential.size(), 0);
}

}  // namespace lacerta::testing

#endif  // LACERTA_TESTS_DRACO_EXT_ENCODER_TEST_STREAMS_H_
