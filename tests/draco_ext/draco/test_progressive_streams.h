// Hand-made progressive streams: a coded base and random coefficients over it.
#ifndef LACERTA_TESTS_DRACO_EXT_DRACO_TEST_PROGRESSIVE_STREAMS_H_
#define LACERTA_TESTS_DRACO_EXT_DRACO_TEST_PROGRESSIVE_STREAMS_H_

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
  Bytes CustomForm() const { return WriteCustomForm({base.stream, refinement}); }
};

inline ProgressiveStream MakeProgressiveStream(const BaseMesh& base, int num_levels) {
  ProgressiveStream result;
  result.base = EncodeBaseMesh(base).value();
  const Coefficients coefficients = RandomCoefficients(result.base.mesh, num_levels, 7);
  RefinementBytes written = WriteRefinement(result.base.mesh, coefficients.steps, coefficients.levels).value();
  result.part_sizes.push_back(result.base.stream.size());
  result.part_sizes.insert(result.part_sizes.end(), written.part_sizes.begin(), written.part_sizes.end());
  result.refinement = std::move(written.bytes);
  return result;
}

}  // namespace lacerta::testing

#endif  // LACERTA_TESTS_DRACO_EXT_DRACO_TEST_PROGRESSIVE_STREAMS_H_
