// The two-sided squared distance between a mesh and the input as a quadratic form of the mesh's vertices [Hoppe et al. 1993].
#ifndef LACERTA_REMESH_DISTANCE_MODEL_H_
#define LACERTA_REMESH_DISTANCE_MODEL_H_

#include <cstdint>
#include <vector>

#include "geometry/triangle_tree.h"
#include "lacerta/mesh.h"
#include "remesh/mesh_neighbors.h"

namespace lacerta {

// Symmetric 3 x 3.
struct Symmetric3 {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

  void AddOuter(const Vec3d& n, double weight) {
    const Vec3d w = n * weight;
    xx += w.x * n.x, xy += w.x * n.y, xz += w.x * n.z, yy += w.y * n.y, yz += w.y * n.z, zz += w.z * n.z;
  }
  void AddScaledIdentity(double weight) { xx += weight, yy += weight, zz += weight; }
  double Trace() const { return xx + yy + zz; }
  Vec3d operator*(const Vec3d& v) const {
    return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
  }
  // Solves this * x = b; zero where there is no solution.
  Vec3d Solve(const Vec3d& b) const;
};

// E(x + d) = value + 2 gradient . d + d . A d for moves d of the vertices, where A has the blocks below. E is the mean of the two
// mean squared distances, in squared model units.
struct DistanceModel {
  double forward = 0;   // mean squared distance from the input to the mesh
  double backward = 0;  // and the other way
  std::vector<Vec3d> gradient;       // #V
  std::vector<Symmetric3> diagonal;  // #V
  std::vector<Symmetric3> off_diagonal;  // #E: the block between the ends of an edge
};

struct AreaSample;
struct FitResidual;

// The input, sampled and ready to be measured against.
class FitTarget {
 public:
  // mesh: with some area (SurfaceDistanceMeter::Create succeeds on it); must outlive the target. Takes about `num_samples` points,
  // in an order of neighbours; small parts of many faces get more of them than their area asks for. farthest: how far from the mesh vertices of another one
  // may go where they are fitted, model units; 0: anywhere.
  FitTarget(const TriangleMesh& mesh, size_t num_samples, double farthest = 0);

  // The same with other samples, for little.
  void Resample(size_t num_samples);

  // Gauss-Newton model at `mesh`, from the target's samples and about as many on `mesh`. Every sample is held to the plane
  // through its closest point, upright on the way to it, so that value and gradient are those of the distance itself. Runs on all
  // cores; the same on any number of them. A mesh without area, as one on a lattice that is too coarse for it, is as far off as the
  // target is large, as DecodedDistance takes it.
  DistanceModel ModelAt(const TriangleMesh& mesh, const MeshNeighbors& neighbors) const;

  // The larger of forward and backward at `mesh` alone, by the target's samples and as many on `mesh`, however many triangles it has. Several
  // times cheaper, and no neighbors are needed.
  double DistortionAt(const TriangleMesh& mesh) const;

  // A sample of the input and the face of a mesh that it is closest to; SurfacePoint::kNone where the mesh has no area.
  struct Hit {
    Vec3f position;
    double share = 0;  // of the area
    uint32_t face = SurfacePoint::kNone;
    double squared_distance = 0;
  };
  std::vector<Hit> HitsOn(const TriangleMesh& mesh) const;

  // Of a point to the input. hint: a face of the input that may be near, or SurfacePoint::kNone; becomes the one that is.
  double SquaredDistance(const Vec3f& point, uint32_t* hint) const;

  // The squared distance of a point to the input over that of how far it may be; 0 where it is near enough.
  double Excess(const Vec3f& point) const;

  // How far vertices may retreat from where they were fitted, for the bytes: a part of how far they may be off; 0: any.
  double most_retreat() const { return kMostRetreat * farthest_; }

  double diagonal() const { return diagonal_; }
  const TriangleMesh& mesh() const { return mesh_; }

 private:
  struct Sample {
    Vec3f position;
    double share = 0;  // of the area
  };

  std::vector<FitResidual> Forward(const TriangleMesh& mesh, const TriangleTree& tree) const;
  std::vector<FitResidual> Backward(const TriangleMesh& mesh, const std::vector<AreaSample>& samples) const;

  static constexpr double kMostRetreat = 0.45;

  const TriangleMesh& mesh_;
  TriangleTree tree_;
  double diagonal_ = 0;
  const double farthest_;
  size_t num_samples_ = 0;
  std::vector<Sample> samples_;
};

}  // namespace lacerta

#endif  // LACERTA_REMESH_DISTANCE_MODEL_H_
