// Hand-made progressive streams: a coded base and random coefficients over it.
#ifndef LACERTA_TESTS_DRACO_EXT_DRACO_TEST_PROGRESSIVE_STREAMS_H_
#define LACERTA_TESTS_DRACO_EXT_DRACO_TEST_PROGRESSIVE_STREAMS_H_

#include <utility>
#include <vector>

#include "draco/base_mesh_codec.h"
#include "draco/custom_form.h"
#include "draco_ext/draco/test_meshes.h"
#include "encoder/stream_writer.h"

namespace lacerta::testing {

struct ProgressiveStream {
  CodedBase base;
  Bytes refinement;
  std::vector<size_t> part_sizes;  // base, then one per level; of the Draco form

  Bytes DracoForm() const {
    Bytes stream = base.stream;
    stream.insert(stream.end(), refinement.begin(), refinement.end());
    return stream;
  }
  // With the stock stream, or with the compact base and the refinement that fits its order.
  Bytes CustomForm() const { return WriteCustomForm({base.stream, refinement, base.coding}); }
};

// The refinement of a base by the coefficients that every hand-made stream holds.
inline RefinementBytes MakeRefinement(const BaseMesh& base, int num_levels, const BaseTags& tags = {},
                                      BaseStepField base_step = BaseStepField::kWritten) {
  const Coefficients coefficients = RandomCoefficients(base, num_levels, 7, 6.0, tags);
  return WriteRefinement(base, coefficients.steps, coefficients.levels, tags, base_step).value();
}

// The finest level that MakeRefinement gives.
inline TriangleMesh Refined(const BaseMesh& base, int num_levels) {
  const Bytes bytes = MakeRefinement(base, num_levels).bytes;
  return MeshAtLevel(DecodeRefinement(base, bytes, {}).value().mesh, num_levels).value();
}

// joined: vertices at one point are joined (BaseTags::joined).
inline ProgressiveStream MakeProgressiveStream(const BaseMesh& base, int num_levels, bool joined = false,
                                               BaseCoding coding = BaseCoding::kStock) {
  ProgressiveStream result;
  result.base = EncodeBaseMesh(base, coding).value();
  BaseTags tags;
  if (joined) tags.joined = FirstAtSamePoint(result.base.mesh.lattice);
  RefinementBytes written = MakeRefinement(result.base.mesh, num_levels, tags,
                                           coding == BaseCoding::kCompact ? BaseStepField::kLeftOut : BaseStepField::kWritten);
  result.part_sizes.push_back(result.base.stream.size());
  result.part_sizes.insert(result.part_sizes.end(), written.part_sizes.begin(), written.part_sizes.end());
  result.refinement = std::move(written.bytes);
  return result;
}

}  // namespace lacerta::testing

#endif  // LACERTA_TESTS_DRACO_EXT_DRACO_TEST_PROGRESSIVE_STREAMS_H_
