// The coders of the paper's comparison, put together from stages: a transform of the remesh, then model-based
// allocation with the product's entropy coder, or zerotrees. All of them carry the base in the same Draco stream.
#ifndef LACERTA_TESTS_BASELINES_CODERS_H_
#define LACERTA_TESTS_BASELINES_CODERS_H_

#include <cstddef>
#include <vector>

#include "baselines/transform.h"
#include "draco/base_mesh_codec.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta::baselines {

struct CodedMesh {
  size_t bytes = 0;              // all: base with its connectivity, headers, details
  std::vector<Vec3f> positions;  // of the finest level, as decoded
};

// Steps by model-based allocation [Payan, Antonini 2004] at the slope lambda, see CodeByModel. base: in the order of
// `transform`.
StatusOr<CodedMesh> CodeWithModel(const CodedBase& base, const Transform& transform, const Decomposition& mesh,
                                  double lambda);

struct ZerotreeOptions {
  // Width of the last plane at the finest level, in model units; coarser levels and the lattice of the base are finer
  // by the root of the energy of their coefficients, so that planes end at equal squared error per coefficient.
  double threshold = 0.0;
  // Tangential coordinates count as this many times what they are before planes are cut: below one they get fewer
  // planes.
  double tangential_scale = 1.0;
};

// The three coordinates of all details as three sets of zerotrees, down to the plane of `threshold`. Decoded magnitudes
// lie in the middle of what is left open.
StatusOr<CodedMesh> CodeWithZerotrees(const CodedBase& base, const Transform& transform, const Decomposition& mesh,
                                      const ZerotreeOptions& options);

}  // namespace lacerta::baselines

#endif  // LACERTA_TESTS_BASELINES_CODERS_H_
