#include "remesh/attribute_samples.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "geometry/triangle_points.h"
#include "geometry/vertex_area_vectors.h"

namespace lacerta {
namespace {

constexpr uint32_t kNone = MeshAttribute::kNoValue;

// Of every face, how many samples it gets; 0 without area. *shares: of the area, for each of them.
std::vector<uint32_t> CountSamples(const TriangleMesh& surface, size_t num_samples, std::vector<double>* shares) {
  std::vector<double>& areas = *shares;
  double total = 0;
  areas.clear();
  for (const Triangle& t : surface.triangles) {
    areas.push_back(Norm(AreaVector(surface.positions, t)));
    total += areas.back();
  }
  std::vector<uint32_t> counts(areas.size(), 0);
  for (size_t f = 0; f < areas.size() && total > 0; ++f) {
    if (!(areas[f] > 0)) continue;
    const double share = areas[f] / total;
    counts[f] = static_cast<uint32_t>(std::max<uint64_t>(3, static_cast<uint64_t>(share * static_cast<double>(num_samples))));
    areas[f] = share / static_cast<double>(counts[f]);
  }
  return counts;
}

}  // namespace

AttributeSamples::AttributeSamples(const AttributedMesh& mesh, const GroupSurface& original, size_t num_samples, double seam_distance) {
  const std::vector<uint32_t> counts = CountSamples(mesh.surface, num_samples, &shares_);
  samples_.reserve(std::accumulate(counts.begin(), counts.end(), size_t{0}));
  uint64_t n = 0;
  for (uint32_t f = 0; f < counts.size(); ++f) {
    for (uint32_t i = 0; i < counts[f]; ++i) {
      const Vec3d w = TrianglePoint(n++, 0.5);
      samples_.push_back({f, {static_cast<float>(w.x), static_cast<float>(w.y), static_cast<float>(w.z)}, {kNone, {}, 0, {}}, kNoSeam});
    }
  }
  across_.resize((samples_.size() + kBlockSize - 1) / kBlockSize);
  tbb::parallel_for(size_t{0}, across_.size(), [&](size_t block) { TakeBlock(mesh, original, seam_distance, block); });
}

// Looks for the points of the original near the samples of a block.
void AttributeSamples::TakeBlock(const AttributedMesh& mesh, const GroupSurface& original, double seam_distance, size_t block) {
  uint32_t hint = kNone;
  std::vector<GroupSurface::Point> near;
  for (size_t i = block * kBlockSize; i < std::min(samples_.size(), (block + 1) * kBlockSize); ++i) {
    Sample& sample = samples_[i];
    const Triangle& t = mesh.surface.triangles[sample.face];
    Vec3d p, corner[3];
    for (size_t k = 0; k < 3; ++k) {
      corner[k] = Vec3Cast<double>(mesh.surface.positions[t[k]]);
      p += corner[k] * static_cast<double>(sample.weights[k]);
    }
    const Vec3d normal = Cross(corner[1] - corner[0], corner[2] - corner[0]);
    original.PointsNear(mesh.GroupOf(sample.face), Vec3Cast<float>(p), normal, seam_distance, &hint, &near);
    if (near.empty()) continue;
    sample.closest = near[0];
    AcrossSeams across = KeepSides(original, near);
    if (across.seams.empty()) continue;
    sample.across = static_cast<uint32_t>(across_[block].size());
    across_[block].push_back(std::move(across));
  }
}

// Of all points near a sample, those that stand for a side of any attribute; nothing where no attribute has two.
AttributeSamples::AcrossSeams AttributeSamples::KeepSides(const GroupSurface& original, const std::vector<GroupSurface::Point>& near) {
  AcrossSeams result;
  uint64_t all = 1;
  std::vector<GroupSurface::Point> sides;
  const bool same_sides = original.AreSidesOfAllAttributes(near);
  for (size_t a = 0; a < original.mesh().attributes.size(); ++a) {
    const MeshAttribute& attribute = original.mesh().attributes[a];
    if (attribute.corners[near[0].face][0] == kNone) continue;
    if (sides.empty() || !same_sides) {
      sides = near;
      original.KeepOnePerSide(attribute, &sides);
    }
    if (sides.size() == 1) continue;
    uint64_t points = 0;
    for (size_t i = 0, side = 0; side < sides.size(); ++i) {
      if (near[i].face == sides[side].face) points |= uint64_t{1} << i, ++side;
    }
    result.seams.push_back({a, points});
    all |= points;
  }
  std::vector<Seam> seams(result.seams.size());  // by the numbers of the points that stay
  for (size_t i = 0; i < near.size(); ++i) {
    if ((all >> i & 1) == 0) continue;
    for (size_t s = 0; s < seams.size(); ++s) seams[s].points |= (result.seams[s].points >> i & 1) << result.points.size();
    result.points.push_back(near[i]);
  }
  for (size_t s = 0; s < seams.size(); ++s) result.seams[s].points = seams[s].points;
  return result;
}

const AttributeSamples::Seam* AttributeSamples::SeamAt(size_t i, size_t attribute) const {
  if (samples_[i].across == kNoSeam) return nullptr;
  const std::vector<Seam>& seams = AcrossAt(i).seams;
  const auto seam = std::find_if(seams.begin(), seams.end(), [&](const Seam& s) { return s.attribute == attribute; });
  return seam == seams.end() ? nullptr : &*seam;
}

}  // namespace lacerta
