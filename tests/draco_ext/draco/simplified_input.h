// An input with its bases, for the tests of what is coded over them.
#ifndef LACERTA_TESTS_DRACO_EXT_DRACO_SIMPLIFIED_INPUT_H_
#define LACERTA_TESTS_DRACO_EXT_DRACO_SIMPLIFIED_INPUT_H_

#include <utility>

#include "draco/refinable_surface.h"
#include "draco_ext/remesh/remeshing.h"
#include "lacerta/surface_distance.h"
#include "remesh/base_parts.h"

namespace lacerta::testing {

struct SimplifiedInput {
  // input: without creases; beside: what stands still beside it.
  explicit SimplifiedInput(const TriangleMesh& input, TriangleMesh beside = {})
      : mesh(input),
        surface(mesh, TopologyOf(mesh)),
        history(Decimated(mesh)),
        still(std::move(beside)),
        meter(SurfaceDistanceMeter::Create(Together(mesh, still)).value()) {}
  RefinableSurface Refinable() const { return {surface, history, still}; }

  const TriangleMesh mesh;
  const InputSurface surface;
  const CollapseHistory history;
  const TriangleMesh still;
  const SurfaceDistanceMeter meter;
};

}  // namespace lacerta::testing

#endif  // LACERTA_TESTS_DRACO_EXT_DRACO_SIMPLIFIED_INPUT_H_
