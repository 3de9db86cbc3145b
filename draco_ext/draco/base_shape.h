// Which of several simplifications of a surface gives the better base meshes.
//
// Long triangles follow creases and necks, round ones suit the butterfly: which takes fewer bits differs from surface to surface by up to a
// tenth, and no geometric measure of the base was found that tells. The details of the normal meshes do, before anything is coded
// (docs/decisions/0013-base-shape.md).
#ifndef LACERTA_DRACO_BASE_SHAPE_H_
#define LACERTA_DRACO_BASE_SHAPE_H_

#include <vector>

#include "common/subdivision.h"
#include "lacerta/codec.h"
#include "remesh/collapse_history.h"
#include "remesh/input_surface.h"

namespace lacerta {

// The surface simplified in each of the ways. topology: of surface.mesh(), with its curves.
std::vector<CollapseHistory> ShapedHistories(const InputSurface& surface, const Topology& topology);

// Simplifies the surface in more than one way and returns the history over whose base meshes, near the usual sizes, the details take the
// fewest bits.
//   topology      of surface.mesh(), with its curves
//   typical_base  vertices of the base meshes that streams of the quality asked for usually have
//   lambda        slope of the rate-distortion curve, squared model units per bit
//   mode          of the streams
//   sizes         of bases that are looked at, as shares of the typical one; a single size may be a fluke; none: the surface is simplified
//                 in the way that is best on the whole
CollapseHistory BestShapedHistory(const InputSurface& surface, const Topology& topology, double typical_base, double lambda,
                                  EncodeMode mode, const std::vector<double>& sizes = {0.6, 1.0, 1.6});

}  // namespace lacerta

#endif  // LACERTA_DRACO_BASE_SHAPE_H_
