// One way to code a surface progressively: a base mesh of a certain size, the normal mesh over it, and the streams that come
// of it at any slope of the rate-distortion curve.
#ifndef LACERTA_DRACO_NORMAL_MESH_CANDIDATE_H_
#define LACERTA_DRACO_NORMAL_MESH_CANDIDATE_H_

#include <cstdint>
#include <vector>

#include "draco/base_mesh_codec.h"
#include "encoder/coefficient_descent.h"
#include "encoder/step_law.h"
#include "encoder/stream_writer.h"
#include "encoder/surface_target.h"
#include "lacerta/codec.h"

namespace lacerta {

// A coded surface as bytes and as the mesh that a decoder makes of them.
struct CodedStream {
  Bytes base;                        // the base section
  Bytes refinement;
  std::vector<size_t> part_sizes;    // of the base section, then as in RefinementBytes
  CodedSurface coded;                // what both hold
  SemiRegularMesh decoded;
  std::vector<Triangle> triangles;   // of the finest level, as MeshAtLevel orders them
  double plane_distortion = 0;       // PlaneDistortion: about the squared distance to the unquantized remesh

  size_t size() const { return base.size() + refinement.size(); }
  TriangleMesh FinestMesh() const { return {decoded.positions, triangles}; }
};

// Where on the rate-distortion curve to code. Slopes are squared model units per bit, > 0. Paper mode knows the first one alone.
struct CodingSlope {
  double lambda = 0;       // of the choice of coefficients
  double step_lambda = 0;  // of the steps
  double base_lambda = 0;  // of the base lattice
  int last_detailed = 1;   // level, 1 .. L, for StepsForSlope; levels beyond the next one get no coefficients
  int passes = DescentOptions().passes;
  int quality_layers = 1;
};

class NormalMeshCandidate {
 public:
  // normal_mesh: over base.mesh, in its order.
  NormalMeshCandidate(CodedBase base, NormalMesh normal_mesh);

  // Codes at a slope of the rate-distortion curve: lambda in squared model units per bit, > 0. A larger one gives fewer bytes.
  StatusOr<CodedStream> Code(double lambda, EncodeMode mode) const {
    return Code({lambda, lambda, lambda, LastDetailed(lambda), DescentOptions().passes, 1}, mode);
  }
  // from: a surface of this candidate coded near that slope, in the default mode. The descent goes on from it, with its steps and lattice: what comes is
  // much like it, while from the beginning slopes that hardly differ give streams that differ by a percent. Null: from the beginning.
  StatusOr<CodedStream> Code(const CodingSlope& slope, EncodeMode mode, const CodedSurface* from = nullptr) const;

  // LastDetailedLevel of this surface.
  int LastDetailed(double lambda) const { return LastDetailedLevel(target_, detail_scales_, lambda); }

  int num_levels() const { return target_.num_levels(); }
  uint32_t num_base_vertices() const { return normal_mesh_.mesh.num_base_vertices; }
  const NormalMesh& normal_mesh() const { return normal_mesh_; }
  // The remesh as a plain mesh, before anything is quantized.
  TriangleMesh RemeshedSurface() const;

 private:
  bool JoinsTheCuts(const BaseMesh& lattice) const;
  BaseMesh BaseLattice(const TriangleMesh& base, double step) const;
  CodedSurface FirstRounding(const CodingSlope& slope, std::vector<Vec3f>* decoded) const;
  // decoded: becomes what a decoder makes of it.
  StatusOr<CodedSurface> CodeSurface(const CodingSlope& slope, EncodeMode mode, const CodedSurface* from, std::vector<Vec3f>* decoded) const;
  StatusOr<RefinementBytes> Write(const CodedSurface& coded, const CodingSlope& slope) const;
  std::vector<Triangle> FinestTriangles() const;  // in the order of MeshAtLevel

  CodedBase base_;  // at a nominal step: fixes the order
  NormalMesh normal_mesh_;
  SurfaceTarget target_;
  std::vector<double> detail_scales_;
};

}  // namespace lacerta

#endif  // LACERTA_DRACO_NORMAL_MESH_CANDIDATE_H_
