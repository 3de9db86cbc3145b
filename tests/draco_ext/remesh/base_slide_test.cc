#include "remesh/base_slide.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/butterfly.h"
#include "draco_ext/remesh/decimated_input.h"
#include "draco_ext/remesh/remeshing.h"
#include "remesh/growing_normal_mesh.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

// A base of so many vertices, slid or not, and what is pierced over it.
struct Slid : testing::DecimatedInput {
  Slid(const TriangleMesh& input, uint32_t num_vertices, bool slides)
      : DecimatedInput(input, num_vertices), domain(Domain()), start(domain.PositionsOn(mesh)), positions(start) {
    if (slides) SlideBase(surface, &domain, &positions, 10'000);
  }
  size_t NumMoved() const {
    return static_cast<size_t>(std::count_if(positions.begin(), positions.end(), [&](const Vec3f& p) { return p != start[static_cast<size_t>(&p - positions.data())]; }));
  }

  BaseDomain domain;
  const std::vector<Vec3f> start;
  std::vector<Vec3f> positions;
};

// Root mean square of what the vertices of the last of `num_levels` levels are off their prediction.
double Details(const Slid& slid, int num_levels) {
  GrowingNormalMesh growing(slid.surface, slid.domain, slid.positions, PiercingOptions());
  Topology coarse = slid.domain.topology();
  for (int level = 1; level < num_levels; ++level) {
    growing.AddLevel();
    coarse = Refine(coarse);
  }
  const std::vector<Vec3f> predicted = PredictMidpoints(coarse, StencilTable(coarse), growing.mesh().mesh.positions);
  growing.AddLevel();
  double sum = 0;
  for (size_t e = 0; e < predicted.size(); ++e) sum += SquaredNorm(growing.mesh().mesh.positions[coarse.num_vertices + e] - predicted[e]);
  return std::sqrt(sum / static_cast<double>(predicted.size()));
}

TEST(SlideBase, LeavesLessToCode) {
  const shapes::NamedShape shapes[] = {{"bumps", shapes::BumpySphere(5), true, true, 0, 0}, {"torus", shapes::Torus(96, 48), true, true, 0, 1}};
  for (const shapes::NamedShape& shape : shapes) {
    SCOPED_TRACE(shape.name);
    const Slid stays(shape.mesh, 60, false), slides(shape.mesh, 60, true);
    EXPECT_GT(slides.NumMoved(), 50u);
    for (const int level : {2, 3}) {
      const double share = Details(slides, level) / Details(stays, level);
      EXPECT_LT(share, 0.9) << level;
      EXPECT_GT(share, 0.2) << level;
    }
  }
}

TEST(SlideBase, WhatIsPiercedStandsWhereTheDomainSays) {
  for (const TriangleMesh& input : {shapes::BumpySphere(4), shapes::Torus(64, 32), shapes::GridWithBorder(40, 40, 0.3f)}) {
    const Slid slid(input, 50, true);
    testing::ExpectPiercedWhereTheDomainSays(slid.surface, slid.domain, slid.positions);
  }
}

TEST(SlideBase, GoesNoFartherThanHalfAnEdgeNorAroundATip) {
  for (const TriangleMesh& input : {shapes::BumpySphere(5), shapes::Torus(64, 32)}) {
    const Slid slid(input, 40, true);
    std::vector<double> length(slid.start.size()), count(slid.start.size());
    for (const auto& [a, b] : slid.domain.topology().edges) {
      for (const uint32_t v : {a, b}) length[v] += Norm(slid.start[a] - slid.start[b]), count[v] += 1;
    }
    double farthest = 0;
    for (uint32_t v = 0; v < slid.start.size(); ++v) {
      const double share = Norm(slid.positions[v] - slid.start[v]) / (length[v] / count[v]);
      farthest = std::max(farthest, share);
      const DomainPoint& place = slid.domain.slid_to(v);
      if (place.face == kNone) continue;
      EXPECT_GT(Dot(slid.surface.NormalAt(place.face, place.barycentric), slid.surface.vertex_normal(slid.domain.input_vertex(v))), 0.79f);
    }
    EXPECT_LT(farthest, 0.6);  // the closest point of the input may lie a little beyond
    EXPECT_GT(farthest, 0.05);
  }
}

TEST(SlideBase, CurvesStay) {
  const Slid slid(shapes::GridWithBorder(40, 40, 0.3f), 40, true);
  EXPECT_GT(slid.NumMoved(), 3u);
  for (uint32_t v = 0; v < slid.start.size(); ++v) {
    if (slid.domain.topology().role[v] == CurveRole::kSmooth) continue;
    EXPECT_EQ(slid.positions[v], slid.start[v]);
  }
}

TEST(SlideBase, WhatIsFlatStays) {
  EXPECT_EQ(Slid(shapes::GridWithBorder(20, 20), 30, true).NumMoved(), 0u);
}

TEST(SlideBase, IsTheSameOnOneThreadAndAtAnotherScale) {
  const TriangleMesh input = shapes::BumpySphere(4);
  const Slid slid(input, 40, true), larger(lacerta::testing::Scaled(input, 1024), 40, true);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(Slid(input, 40, true).positions, slid.positions);
  for (size_t v = 0; v < slid.positions.size(); ++v) EXPECT_LT(Norm(larger.positions[v] * (1.0f / 1024) - slid.positions[v]), 1e-3f);
}

}  // namespace
}  // namespace lacerta
