// The levels of a stream with quality layers, as far as they have come: values that segments refine, and the mesh that they make
// (docs/format.md, "Layers"). A stream of one layer needs none of this: it is done with a level once it has come.
#ifndef LACERTA_DECODER_LAYER_DECODER_H_
#define LACERTA_DECODER_LAYER_DECODER_H_

#include <cstddef>
#include <vector>

#include "common/butterfly.h"
#include "common/layer_coding.h"
#include "common/stream_layout.h"
#include "common/subdivision.h"
#include "lacerta/decoder.h"

namespace lacerta {

// A segment as it came.
struct LayerPayload {
  LayerSegment segment;
  Bytes payload;
};

class LayerDecoder {
 public:
  // steps: of the header; base: topology of the base mesh; num_still: of its triangles; last_level: finer ones are not wanted.
  LayerDecoder(std::vector<LevelSteps> steps, Topology base, size_t num_still, int last_level, const DecodeLimits& limits);

  // Takes segments that are to be shown together. Fails with kInvalidData where one does not follow upon those before, with
  // kLimitExceeded where a level is over the limits; nothing has changed then.
  Status Take(const std::vector<LayerPayload>& segments);

  // Whether all levels that are wanted are as fine as they get.
  bool is_complete() const;
  // Brings `mesh` up to date: two levels beyond the finest that has begun, since smooth ones are nearer to the surface than flat
  // triangles, and all of them at the end. Fails with kInvalidData where a position is not finite; the mesh is then as it was.
  Status Show(SemiRegularMesh* mesh);

  // Of the last level that Show has made; 1 or more.
  std::vector<Triangle> ShownTriangles() const { return RefineTriangles(topologies_[static_cast<size_t>(shown_) - 1]); }

 private:
  Status CheckOrder(const std::vector<LayerPayload>& segments) const;
  void Decode(const LayerPayload& segment);
  // Makes the topology of the level below `level`, within the limits.
  Status Reach(int level);

  const std::vector<LevelSteps> steps_;
  const size_t num_still_;
  const int last_level_;
  const DecodeLimits limits_;
  const StencilTable stencils_;
  std::vector<Topology> topologies_;  // of levels 0, 1, ... as far as they were wanted
  LayerState state_;
  int shown_ = 0;
  int lowest_changed_ = 1;  // level, since Show
};

}  // namespace lacerta

#endif  // LACERTA_DECODER_LAYER_DECODER_H_
