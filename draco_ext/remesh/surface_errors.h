// How far a surface with attributes is from the original, and how far it may be.
#ifndef LACERTA_REMESH_SURFACE_ERRORS_H_
#define LACERTA_REMESH_SURFACE_ERRORS_H_

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lacerta/attribute_distance.h"
#include "lacerta/attributed_mesh.h"
#include "lacerta/status.h"
#include "lacerta/surface_distance.h"

namespace lacerta {

// Of a surface against the original.
struct SurfaceErrors {
  double distance = 0;                     // two-sided RMS distance d_S, model units
  std::vector<AttributeError> attributes;  // the worse of both directions, for each attribute of the original
  double turned = 0;           // share of the surface's area that looks away from all of the original near it
  double against_normals = 0;  // share that looks away from its own normals, beyond that of the original

  double swapped = 0;          // share of the original's area over which the back of a thin sheet has come upon its front or before it

  // Of what is swapped a twentieth counts: it is seen of double-sided materials alone, and told of walls that nobody sees, too.
  double MostTurned() const {
    constexpr double kOfSwapped = 0.05;
    return std::max({turned, against_normals, kOfSwapped * swapped});
  }
};

// What is allowed. All > 0; infinity: anything will do.
struct ErrorTargets {
  double distance = 0;
  std::vector<double> attributes;  // bounds of AttributeError::rms_99, in its units
  std::vector<double> everywhere = {};  // bounds of AttributeError::rms; empty: none
  double turned = std::numeric_limits<double>::infinity();  // bound of SurfaceErrors::MostTurned
};

// For every texture coordinate `texels` on 99 % of the surface, for normals and tangents `degrees`; joint weights and colors 1/256, all
// others 1/1000 of their range. `everywhere` stays empty: the last 1 % of the surface, small parts and sharp
// rims mostly, may be anything; to hold normals there, too, takes up to twice the triangles. Nor is `turned` bounded.
ErrorTargets TargetsFor(const AttributedMesh& mesh, double distance, double texels, double degrees);

// The worst error relative to its target: the targets are met where it is at most 1.
double WorstRatio(const SurfaceErrors& errors, const ErrorTargets& targets);

// Of one attribute alone.
double AttributeRatio(const SurfaceErrors& errors, const ErrorTargets& targets, size_t attribute);

// The largest difference between two values of one component; 0 where there are none.
double RangeOf(const MeshAttribute& attribute);

// Share of the area that has the attribute, for each of the mesh; 1 where there is no area.
std::vector<double> AttributeShares(const AttributedMesh& mesh);

// Copies share what was prepared of the original.
class SurfaceErrorMeter {
 public:
  // Copies the original. Fails as SurfaceDistanceMeter and AttributeDistanceMeter do.
  static StatusOr<SurfaceErrorMeter> Create(const AttributedMesh& original, double texture_size = 1024);

  // The same for surfaces whose attributes go by other names; names: one for each attribute of the original.
  SurfaceErrorMeter WithNames(std::vector<std::string> names) const;

  // num_samples: on each of the two surfaces, fewer where the original is small, more where a small part of it has an attribute.
  StatusOr<SurfaceErrors> Measure(const AttributedMesh& mesh, uint64_t num_samples) const;

  double diagonal() const { return diagonal_; }
  double texture_size() const { return texture_size_; }

 private:
  SurfaceErrorMeter(std::optional<SurfaceDistanceMeter> distance, AttributeDistanceMeter attributes, double diagonal, double texture_size,
                    uint64_t most_samples, double against_normals, double least_share)
      : distance_(std::move(distance)), attributes_(std::move(attributes)), diagonal_(diagonal), texture_size_(texture_size),
        most_samples_(most_samples), against_normals_(against_normals), least_share_(least_share) {}

  std::optional<SurfaceDistanceMeter> distance_;  // where there are several groups: of one the attributes' meter tells it on the way
  AttributeDistanceMeter attributes_;
  double diagonal_;
  double texture_size_;
  uint64_t most_samples_;
  double against_normals_;  // ShareAgainstNormals of the original
  double least_share_;      // of the area that has an attribute
};

}  // namespace lacerta

#endif  // LACERTA_REMESH_SURFACE_ERRORS_H_
