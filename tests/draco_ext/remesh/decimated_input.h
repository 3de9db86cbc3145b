// An input with a base mesh of its own, for the tests of what is done to bases.
#ifndef LACERTA_TESTS_DRACO_EXT_REMESH_DECIMATED_INPUT_H_
#define LACERTA_TESTS_DRACO_EXT_REMESH_DECIMATED_INPUT_H_

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "draco_ext/remesh/remeshing.h"
#include "remesh/growing_normal_mesh.h"
#include "remesh/reversal.h"

namespace lacerta::testing {

struct DecimatedInput {
  // input: without creases.
  DecimatedInput(const TriangleMesh& input, uint32_t num_base_vertices)
      : mesh(input), topology(TopologyOf(mesh)), surface(mesh, topology), history(Decimated(mesh, {num_base_vertices, 12, 0.2})) {}
  BaseDomain Domain() const { return BaseDomain(history, history.num_collapses()); }

  const TriangleMesh mesh;
  const Topology topology;
  const InputSurface surface;
  const CollapseHistory history;
};

// Of three levels over the base at `positions`: that its vertices are where the domain says, and that hardly a triangle is reversed.
inline void ExpectPiercedWhereTheDomainSays(const InputSurface& surface, const BaseDomain& domain, const std::vector<Vec3f>& positions) {
  GrowingNormalMesh growing(surface, domain, positions, PiercingOptions());
  for (int level = 0; level < 3; ++level) growing.AddLevel();
  const double diagonal = BoundingBoxDiagonal(surface.mesh());
  const std::vector<DomainPoint> parameters = growing.Parameters();
  for (size_t v = 0; v < parameters.size(); ++v) {
    const DomainPoint on_input = domain.ToInput(parameters[v]);
    EXPECT_LT(Norm(surface.PositionAt(on_input.face, on_input.barycentric) - growing.mesh().mesh.positions[v]), 1e-5 * diagonal) << v;
  }
  EXPECT_LT(FindReversed(surface, growing.mesh()).share, 0.002);
}

}  // namespace lacerta::testing

#endif  // LACERTA_TESTS_DRACO_EXT_REMESH_DECIMATED_INPUT_H_
