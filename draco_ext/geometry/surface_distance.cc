#include "lacerta/surface_distance.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "geometry/measured_surface.h"
#include "geometry/triangle_tree.h"

namespace lacerta {

struct SurfaceDistanceMeter::Original {
  std::unique_ptr<const MeasuredSurface> surface;
  double diagonal = 0.0;
};

namespace {

// Queries done in a row by one thread. Sums are taken per block and then in the order of the blocks.
constexpr uint64_t kBlockSize = 2048;

struct BlockSum {
  double sum2 = 0.0, max2 = 0.0;
};

// Sum and maximum of the squared distances to `surface` of the points 0 to count - 1.
//   make_points  () -> MeasuredSurface::Points
template <typename MakePoints>
BlockSum SumOverBlocks(uint64_t count, const MeasuredSurface& surface, const MakePoints& make_points) {
  std::vector<BlockSum> blocks((count + kBlockSize - 1) / kBlockSize);
  tbb::parallel_for(tbb::blocked_range<size_t>(0, blocks.size(), 1), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t block = range.begin(); block != range.end(); ++block) {
      const MeasuredSurface::Points point_at = make_points();
      uint32_t hint = SurfacePoint::kNone;
      const uint64_t first = block * kBlockSize, last = std::min(first + kBlockSize, count);
      for (uint64_t i = first; i < last; ++i) {
        const double d2 = surface.SquaredDistance(point_at(i), &hint);
        blocks[block].sum2 += d2;
        blocks[block].max2 = std::max(blocks[block].max2, d2);
      }
    }
  });
  BlockSum total;
  for (const BlockSum& block : blocks) {
    total.sum2 += block.sum2;
    total.max2 = std::max(total.max2, block.max2);
  }
  return total;
}

Status CheckMesh(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return InvalidData("the mesh has no triangles, so no surface to measure");
  for (size_t f = 0; f < mesh.triangles.size(); ++f) {
    for (const uint32_t v : mesh.triangles[f]) {
      if (v >= mesh.positions.size()) {
        return InvalidData("triangle " + std::to_string(f) + " uses vertex " + std::to_string(v) + " of " +
                           std::to_string(mesh.positions.size()) + "; indices must be below the number of vertices");
      }
      const Vec3f& p = mesh.positions[v];
      for (int k = 0; k < 3; ++k) {
        if (!(std::fabs(p[k]) <= TriangleTree::kMaxCoordinate)) {
          return InvalidData("vertex " + std::to_string(v) +
                             " has a coordinate that is not finite or beyond 1e18; repair or rescale the mesh");
        }
      }
    }
  }
  return {};
}

}  // namespace

double BoundingBoxDiagonal(const TriangleMesh& mesh) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Vec3d min{kInfinity, kInfinity, kInfinity}, max{-kInfinity, -kInfinity, -kInfinity};
  for (const Triangle& t : mesh.triangles) {
    if (std::max({t[0], t[1], t[2]}) >= mesh.positions.size()) continue;
    const Vec3f &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    if (a == b || b == c || c == a) continue;
    for (const uint32_t v : t) {
      for (int k = 0; k < 3; ++k) {
        const double x = static_cast<double>(mesh.positions[v][k]);
        min[k] = std::min(min[k], x);
        max[k] = std::max(max[k], x);
      }
    }
  }
  return min.x <= max.x ? Norm(max - min) : 0.0;
}

double Psnr(double distance, double diagonal) {
  if (std::isnan(distance) || std::isnan(diagonal)) return std::numeric_limits<double>::quiet_NaN();
  if (distance <= 0.0) return kMaxPsnr;
  if (diagonal <= 0.0) return -std::numeric_limits<double>::infinity();
  return std::min(20.0 * std::log10(diagonal / distance), kMaxPsnr);
}

double DistanceOfPsnr(double psnr, double diagonal) { return diagonal * std::pow(10.0, -psnr / 20.0); }

SurfaceDistanceMeter::SurfaceDistanceMeter(std::shared_ptr<const Original> original) : original_(std::move(original)) {}

StatusOr<SurfaceDistanceMeter> SurfaceDistanceMeter::Create(const TriangleMesh& original) {
  return Create(original, [&] { return MakeMeasuredSurface(original, /*with_vertices=*/true); });
}

StatusOr<SurfaceDistanceMeter> SurfaceDistanceMeter::CreateLean(const TriangleMesh& original) {
  return Create(original, [&] { return MakeLeanSurface(original); });
}

template <typename Make>
StatusOr<SurfaceDistanceMeter> SurfaceDistanceMeter::Create(const TriangleMesh& original, const Make& make) {
  LACERTA_RETURN_IF_ERROR(CheckMesh(original).WithContext("original"));
  auto made = std::make_shared<Original>();
  made->surface = make();
  made->diagonal = BoundingBoxDiagonal(original);
  if (!(made->surface->doubled_area() > 0.0)) {
    return InvalidData("original: all triangles are degenerate, there is no area to sample");
  }
  LACERTA_RETURN_IF_ERROR(CheckDiagonal(made->diagonal).WithContext("original"));
  return SurfaceDistanceMeter(std::move(made));
}

StatusOr<SurfaceDistance> SurfaceDistanceMeter::Measure(const TriangleMesh& mesh,
                                                        const SurfaceDistanceOptions& options) const {
  if (options.num_samples < 1 || options.num_samples > SurfaceDistanceOptions::kMaxSamples) {
    return InvalidArgument("num_samples is " + std::to_string(options.num_samples) + "; it must be from 1 to " +
                           std::to_string(SurfaceDistanceOptions::kMaxSamples));
  }
  LACERTA_RETURN_IF_ERROR(CheckMesh(mesh).WithContext("measured mesh"));
  const std::unique_ptr<const MeasuredSurface> other = MakeMeasuredSurface(mesh, options.max_at_vertices);
  if (!(other->doubled_area() > 0.0)) {
    return InvalidData("measured mesh: all triangles are degenerate, there is no area to sample");
  }
  const auto measure = [&options](const MeasuredSurface& from, const MeasuredSurface& to) {
    const BlockSum samples = SumOverBlocks(options.num_samples, to, [&] { return from.Samples(options.num_samples, options.seed); });
    const BlockSum vertices = SumOverBlocks(options.max_at_vertices ? from.num_vertices() : 0, to, [&] { return from.Vertices(); });
    return OneSidedDistance{std::sqrt(samples.sum2 / static_cast<double>(options.num_samples)),
                            std::sqrt(std::max(samples.max2, vertices.max2))};
  };
  return SurfaceDistance{measure(*original_->surface, *other), measure(*other, *original_->surface)};
}

double SurfaceDistanceMeter::diagonal() const { return original_->diagonal; }

StatusOr<SurfaceDistance> MeasureSurfaceDistance(const TriangleMesh& original, const TriangleMesh& mesh,
                                                 const SurfaceDistanceOptions& options) {
  LACERTA_ASSIGN_OR_RETURN(const SurfaceDistanceMeter meter, SurfaceDistanceMeter::Create(original));
  return meter.Measure(mesh, options);
}

}  // namespace lacerta
