// A semi-regular mesh with attributes as a progressive stream: the base as stock Draco streams, one per group, then the refinement.
#ifndef LACERTA_DRACO_ATTRIBUTED_STREAM_H_
#define LACERTA_DRACO_ATTRIBUTED_STREAM_H_

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "decoder/joint_weights.h"
#include "lacerta/attributed_base.h"
#include "lacerta/attributed_levels.h"
#include "lacerta/mesh.h"
#include "lacerta/remesh.h"
#include "lacerta/status.h"
#include "remesh/attributed_remesh.h"

namespace lacerta {

// A surface that stands for itself, to be coded: normals are those of its finest level, weighted by area; no vertex counts as found by piercing, so that
// none may slide.
StatusOr<NormalMesh> AsNormalMesh(SemiRegularMesh surface);

using BytesBeside = std::function<uint64_t(const AttributedBase&)>;

using ErrorFactors = std::function<std::vector<float>(const AttributedSemiRegularMesh&, size_t attribute)>;

struct AttributedStreamOptions {
  double lambda = 0;       // squared model units per bit of positions, > 0: as in NormalMeshCandidate::Code
  int last_detailed = 0;   // for StepsForSlope; 0: LastDetailedLevel
  int passes = 3;
  // For each attribute the error to stay within, root mean square over the 99 % of the surface where it is least, beside what positions do: in the attribute's own units,
  // of normals and tangents in degrees; > 0.
  std::vector<double> errors;
  // Called with the surface as decoded and the values wanted there: sets those that fit it best, for vertices slide where the
  // shape does not show it. Empty: they stay.
  std::function<void(AttributedSemiRegularMesh*)> refit = {};
  // Of the attribute of weights, which has a component for each: the base holds them as glTF does then, the four
  // largest with the sum 1.
  JointTable joints = {};
  // Called for each attribute with the surface as decoded and the values wanted there: #values x components factors on
  // how far values are off, at most 1 where one matters less; empty: all 1.
  ErrorFactors factors = {};
  // Bytes that a host stores beside the stream for readers of the base alone; empty: none.
  BytesBeside beside = {};
};

struct AttributedStream {
  std::vector<Bytes> bases;           // the base section, one stock Draco stream for each group
  Bytes refinement;
  std::vector<size_t> part_sizes;     // as in RefinementBytes
  AttributedBase base;                // as decoders get it
  AttributedSemiRegularMesh decoded;  // as decoders make it, in the order of `base`
  std::vector<double> errors;         // of each attribute, as in the options
  std::vector<size_t> residual_bytes; // of each attribute above the base, about
  size_t bytes_beside = 0;            // as in the options

  size_t size() const;  // of all
};

// mesh: of any order; each of its groups has one triangle at least. Fails with kInvalidArgument where arrays have not the shapes that the types tell, and with kInvalidData where the base cannot be coded
// or its triangles, hung together where they touch (AttributedBase), are no manifold.
StatusOr<AttributedStream> EncodeAttributedStream(const AttributedNormalMesh& mesh, const AttributedStreamOptions& options);

}  // namespace lacerta

#endif  // LACERTA_DRACO_ATTRIBUTED_STREAM_H_
