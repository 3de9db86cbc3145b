// The smallest simplified surface that stays within errors of positions and attributes.
#ifndef LACERTA_REMESH_SIMPLIFY_TO_ERRORS_H_
#define LACERTA_REMESH_SIMPLIFY_TO_ERRORS_H_

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
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

  double MostTurned() const { return std::max(turned, against_normals); }
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

class SurfaceErrorMeter {
 public:
  // Copies the original. Fails as SurfaceDistanceMeter and AttributeDistanceMeter do.
  static StatusOr<SurfaceErrorMeter> Create(const AttributedMesh& original, double texture_size = 1024);

  // num_samples: on each of the two surfaces, fewer where the original is small, more where a small part of it has an attribute.
  StatusOr<SurfaceErrors> Measure(const AttributedMesh& mesh, uint64_t num_samples) const;

  double diagonal() const { return distance_.diagonal(); }
  double texture_size() const { return texture_size_; }

 private:
  SurfaceErrorMeter(SurfaceDistanceMeter distance, AttributeDistanceMeter attributes, double texture_size, uint64_t most_samples,
                    double against_normals, double least_share)
      : distance_(std::move(distance)), attributes_(std::move(attributes)), texture_size_(texture_size), most_samples_(most_samples),
        against_normals_(against_normals), least_share_(least_share) {}

  SurfaceDistanceMeter distance_;
  AttributeDistanceMeter attributes_;
  double texture_size_;
  uint64_t most_samples_;
  double against_normals_;  // ShareAgainstNormals of the original
  double least_share_;      // of the area that has an attribute
};

struct SimplifyToErrorsOptions {
  uint64_t num_samples = 100'000;        // of the measure that the result is held to
  uint64_t num_search_samples = 10'000;  // while the size is looked for
  int num_weightings = 5;                // at most: weights of attributes are set anew by what limited the size while that pays
  // Makes of a fitted surface what will be stored of it, before it is measured: for values that something else follows from.
  std::function<void(AttributedMesh*)> finish = nullptr;
};

struct SimplifiedSurface {
  AttributedMesh mesh;
  SurfaceErrors errors;       // measured with num_samples
  bool meets_targets = true;  // false only where even the input's own triangles do not, by the precision of the measure
};

// The smallest mesh found of those that AttributedSimplification makes of the original and that meet the targets. meter: of the
// original. The weight of each attribute against positions is what the targets say, then changed by which of them limits the size.
StatusOr<SimplifiedSurface> SimplifyToErrors(const AttributedMesh& original, const SurfaceErrorMeter& meter, const ErrorTargets& targets,
                                             const SimplifyToErrorsOptions& options = {});

}  // namespace lacerta

#endif  // LACERTA_REMESH_SIMPLIFY_TO_ERRORS_H_
