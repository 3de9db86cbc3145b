#include "remesh/attribute_fit.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "geometry/equal_rows.h"
#include "geometry/triangle_points.h"
#include "geometry/vertex_area_vectors.h"
#include "remesh/attribute_values.h"

namespace lacerta {
namespace {

constexpr uint32_t kNone = MeshAttribute::kNoValue;
constexpr size_t kBlockSize = 1024;
constexpr double kStiffness = 0.02;  // of staying in place, relative to the samples around

// An attribute with more than one side at a sample, and which of the points near it stand for them, by bits.
struct Sides {
  size_t attribute;
  uint64_t points;
};
static_assert(GroupSurface::kMostNear <= 64, "a bit for each point");

// Points near a sample that stand for sides of seams, the nearest first: one or two of dozens, which would fill the memory.
struct AcrossSeams {
  std::vector<GroupSurface::Point> points;
  std::vector<Sides> seams;  // ascending attributes
};

// A point of the mesh, and where the original is compared with it.
struct Sample {
  uint32_t face;
  std::array<float, 3> weights;
  GroupSurface::Point closest;  // its face is kNone where there is none
  uint32_t across;              // which of the AcrossSeams of the block, or kNone: no attribute has more than one side
};

// There are three samples and more on every triangle: they are most of the memory of a fit.
struct Samples {
  std::vector<Sample> samples;
  std::vector<double> shares;                     // of the faces: of the area, for each of its samples
  std::vector<std::vector<AcrossSeams>> across;  // of every block of samples

  const AcrossSeams* AcrossAt(size_t i) const { return samples[i].across == kNone ? nullptr : &across[i / kBlockSize][samples[i].across]; }
};

bool HasValue(const MeshAttribute& attribute, const GroupSurface::Point& point) { return attribute.corners[point.face][0] != kNone; }

// Of all points near a sample, those that stand for a side of any attribute; nothing where no attribute has two.
AcrossSeams KeepSides(const GroupSurface& original, const std::vector<GroupSurface::Point>& near) {
  AcrossSeams result;
  uint64_t all = 1;
  std::vector<GroupSurface::Point> sides;
  const bool same_sides = original.AreSidesOfAllAttributes(near);
  for (size_t a = 0; a < original.mesh().attributes.size(); ++a) {
    const MeshAttribute& attribute = original.mesh().attributes[a];
    if (!HasValue(attribute, near[0])) continue;
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
  std::vector<Sides> seams(result.seams.size());  // by the numbers of the points that stay
  for (size_t i = 0; i < near.size(); ++i) {
    if ((all >> i & 1) == 0) continue;
    for (size_t s = 0; s < seams.size(); ++s) seams[s].points |= (result.seams[s].points >> i & 1) << result.points.size();
    result.points.push_back(near[i]);
  }
  for (size_t s = 0; s < seams.size(); ++s) result.seams[s].points = seams[s].points;
  return result;
}

// The points of sample i that stand for the sides of an attribute.
void SidesOf(const Samples& samples, size_t i, size_t attribute, std::vector<GroupSurface::Point>* sides) {
  sides->assign(1, samples.samples[i].closest);
  const AcrossSeams* const across = samples.AcrossAt(i);
  if (across == nullptr) return;
  const auto seam = std::find_if(across->seams.begin(), across->seams.end(), [&](const Sides& s) { return s.attribute == attribute; });
  if (seam == across->seams.end()) return;
  sides->clear();
  for (size_t k = 0; k < across->points.size(); ++k) {
    if ((seam->points >> k & 1) != 0) sides->push_back(across->points[k]);
  }
}

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

Samples TakeSamples(const AttributedMesh& mesh, const GroupSurface& original, const AttributeFitOptions& options) {
  const TriangleMesh& surface = mesh.surface;
  Samples result;
  const std::vector<uint32_t> counts = CountSamples(surface, options.num_samples, &result.shares);
  std::vector<Sample>& samples = result.samples;
  samples.reserve(std::accumulate(counts.begin(), counts.end(), size_t{0}));
  uint64_t n = 0;
  for (uint32_t f = 0; f < counts.size(); ++f) {
    for (uint32_t i = 0; i < counts[f]; ++i) {
      const Vec3d w = TrianglePoint(n++, 0.5);
      samples.push_back({f, {static_cast<float>(w.x), static_cast<float>(w.y), static_cast<float>(w.z)}, {kNone, {}, 0, {}}, kNone});
    }
  }
  result.across.resize((samples.size() + kBlockSize - 1) / kBlockSize);
  tbb::parallel_for(tbb::blocked_range<size_t>(0, result.across.size(), 1), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t block = range.begin(); block != range.end(); ++block) {
      uint32_t hint = kNone;
      std::vector<GroupSurface::Point> near;
      for (size_t i = block * kBlockSize; i < std::min(samples.size(), (block + 1) * kBlockSize); ++i) {
        Sample& sample = samples[i];
        const Triangle& t = surface.triangles[sample.face];
        Vec3d p, corner[3];
        for (size_t k = 0; k < 3; ++k) {
          corner[k] = Vec3Cast<double>(surface.positions[t[k]]);
          p += corner[k] * static_cast<double>(sample.weights[k]);
        }
        const Vec3d normal = Cross(corner[1] - corner[0], corner[2] - corner[0]);
        original.PointsNear(mesh.GroupOf(sample.face), Vec3Cast<float>(p), normal, options.seam_distance * options.diagonal, &hint, &near);
        if (near.empty()) continue;
        sample.closest = near[0];
        AcrossSeams across = KeepSides(original, near);
        if (across.seams.empty()) continue;
        sample.across = static_cast<uint32_t>(result.across[block].size());
        result.across[block].push_back(std::move(across));
      }
    }
  });
  return result;
}

// The least squares problem of one attribute: numbers of nodes, which are its values vertex by vertex.
class ValueFit {
 public:
  ValueFit(const AttributedMesh& mesh, const MeshAttribute& attribute) : columns_(attribute.components) {
    std::vector<uint32_t> table;
    for (size_t f = 0; f < attribute.corners.size(); ++f) {
      for (size_t k = 0; k < 3; ++k) table.insert(table.end(), {mesh.surface.triangles[f][k], attribute.corners[f][k]});
    }
    const std::vector<uint32_t> first = FirstEqualRow(Span<const uint32_t>(table), 2);
    std::vector<uint32_t> number(first.size(), kNone);
    nodes_.resize(attribute.corners.size(), {kNone, kNone, kNone});
    for (size_t i = 0; i < first.size(); ++i) {
      const uint32_t row = table[2 * i + 1];
      if (row == kNone) continue;
      if (first[i] == i) {
        number[i] = static_cast<uint32_t>(values_.size() / columns_);
        for (size_t c = 0; c < columns_; ++c) values_.push_back(static_cast<double>(attribute.values[row * columns_ + c]));
      }
      nodes_[i / 3][i % 3] = number[first[i]];
    }
  }

  // Conjugate gradients from the values that are there to those of the original at the samples.
  void Solve(const Samples& samples, const GroupSurface& original, size_t index) {
    constexpr int kIterations = 15;
    std::vector<double> residual = Residual(samples, original, index);
    std::vector<double> direction(values_.size(), 0.0), moves(values_.size(), 0.0);
    double energy = 0, first_energy = 0;
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      double next_energy = 0;
      std::vector<double> conditioned(values_.size(), 0.0);
      for (size_t j = 0; j < values_.size(); ++j) {
        const double d = diagonal_[j / columns_];
        if (d > 0) conditioned[j] = residual[j] / (d * (1 + kStiffness));
        next_energy += conditioned[j] * residual[j];
      }
      if (iteration == 0) first_energy = next_energy;
      if (!(next_energy > 1e-8 * first_energy)) break;
      const double keep = iteration == 0 ? 0 : next_energy / energy;
      energy = next_energy;
      for (size_t j = 0; j < direction.size(); ++j) direction[j] = conditioned[j] + keep * direction[j];
      const std::vector<double> product = Multiply(direction);
      double curvature = 0;
      for (size_t j = 0; j < direction.size(); ++j) curvature += direction[j] * product[j];
      if (!(curvature > 0)) break;
      const double length = energy / curvature;
      for (size_t j = 0; j < moves.size(); ++j) {
        moves[j] += length * direction[j];
        residual[j] -= length * product[j];
      }
    }
    before_ = values_;
    for (size_t j = 0; j < values_.size(); ++j) values_[j] += moves[j];
  }

  // Takes back the values of texture triangles that are mirrored now.
  void KeepUnmirrored() {
    const auto doubled_area = [&](const Triangle& t, const std::vector<double>& v) {
      const double *a = &v[2 * size_t{t[0]}], *b = &v[2 * size_t{t[1]}], *c = &v[2 * size_t{t[2]}];
      return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    };
    constexpr int kRounds = 8;  // of taking back what the others make necessary; then everything
    for (int round = 0; round <= kRounds; ++round) {
      bool any = false;
      for (const Triangle& t : nodes_) {
        if (t[0] == kNone) continue;
        const double before = doubled_area(t, before_);
        if (before == 0 || before * doubled_area(t, values_) > 0) continue;
        any = true;
        for (const uint32_t node : t) std::copy_n(&before_[2 * size_t{node}], 2, &values_[2 * size_t{node}]);
      }
      if (!any) return;
    }
    values_ = before_;
  }

  void Write(MeshAttribute* attribute, const ValueRange& range) const {
    attribute->corners = nodes_;
    attribute->values.clear();
    for (const double x : values_) attribute->values.push_back(static_cast<float>(x));
    for (size_t i = 0; i < attribute->values.size(); i += columns_) range.Legalize(&attribute->values[i]);
  }

 private:
  void ValueAt(const Sample& sample, std::vector<double>* value) const {
    std::fill(value->begin(), value->end(), 0.0);
    for (size_t k = 0; k < 3; ++k) {
      const double* row = &values_[nodes_[sample.face][k] * columns_];
      for (size_t c = 0; c < columns_; ++c) (*value)[c] += static_cast<double>(sample.weights[k]) * row[c];
    }
  }

  // What a sample is held to.
  struct Goal {
    static constexpr double kNothing = -1;
    double error = kNothing;  // of the value that is there, squared; kNothing: the original has none
    uint8_t side = 0;         // of SidesOf, whose value is nearest
  };

  std::vector<Goal> GoalsOf(const Samples& samples, const GroupSurface& original, size_t index) const {
    const MeshAttribute& attribute = original.mesh().attributes[index];
    std::vector<Goal> goals(samples.samples.size());
    std::vector<double> value(columns_), here(columns_);
    std::vector<GroupSurface::Point> sides;
    for (size_t i = 0; i < goals.size(); ++i) {
      const Sample& sample = samples.samples[i];
      if (nodes_[sample.face][0] == kNone || sample.closest.face == kNone || !HasValue(attribute, sample.closest)) continue;
      ValueAt(sample, &here);
      SidesOf(samples, i, index, &sides);
      goals[i].error = INFINITY;
      for (size_t side = 0; side < sides.size(); ++side) {
        InterpolateValue(attribute, sides[side], value.data());
        double error = 0;
        for (size_t c = 0; c < columns_; ++c) error += (value[c] - here[c]) * (value[c] - here[c]);
        if (error < goals[i].error) goals[i] = {error, static_cast<uint8_t>(side)};
      }
    }
    return goals;
  }

  // Beyond this squared error a sample counts less and less: what is far off is another part of the surface.
  static double FarError(const std::vector<Goal>& goals) {
    constexpr double kFar = 16;
    std::vector<double> errors;
    for (const Goal& goal : goals) {
      if (goal.error != Goal::kNothing) errors.push_back(goal.error);
    }
    if (errors.empty()) return 0;
    const auto usual = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() * 3 / 4);
    std::nth_element(errors.begin(), usual, errors.end());
    return kFar * *usual;
  }

  // Sums up products_ and diagonal_, too.
  std::vector<double> Residual(const Samples& samples, const GroupSurface& original, size_t index) {
    const MeshAttribute& attribute = original.mesh().attributes[index];
    const std::vector<Goal> goals = GoalsOf(samples, original, index);
    const double far_error = FarError(goals);
    products_.assign(nodes_.size(), {});
    std::vector<double> residual(values_.size(), 0.0), value(columns_), here(columns_);
    std::vector<GroupSurface::Point> sides;
    for (size_t i = 0; i < goals.size(); ++i) {
      if (goals[i].error == Goal::kNothing) continue;
      const Sample& sample = samples.samples[i];
      double weight = samples.shares[sample.face];
      if (goals[i].error > far_error) weight *= far_error / goals[i].error;
      ValueAt(sample, &here);
      SidesOf(samples, i, index, &sides);
      InterpolateValue(attribute, sides[goals[i].side], value.data());
      const std::array<float, 3>& w = sample.weights;
      for (size_t k = 0; k < 3; ++k) {
        const double own = weight * static_cast<double>(w[k]);
        products_[sample.face].same[k] += own * static_cast<double>(w[k]);
        products_[sample.face].opposite[k] += weight * static_cast<double>(w[(k + 1) % 3]) * static_cast<double>(w[(k + 2) % 3]);
        double* const sum = &residual[nodes_[sample.face][k] * columns_];
        for (size_t c = 0; c < columns_; ++c) sum[c] += own * (value[c] - here[c]);
      }
    }
    diagonal_.assign(values_.size() / columns_, 0.0);
    for (size_t f = 0; f < nodes_.size(); ++f) {
      for (size_t k = 0; k < 3 && nodes_[f][0] != kNone; ++k) diagonal_[nodes_[f][k]] += products_[f].same[k];
    }
    return residual;
  }

  std::vector<double> Multiply(const std::vector<double>& x) const {
    std::vector<double> result(x.size());
    for (size_t j = 0; j < x.size(); ++j) result[j] = kStiffness * diagonal_[j / columns_] * x[j];
    for (size_t f = 0; f < nodes_.size(); ++f) {
      if (nodes_[f][0] == kNone) continue;
      const Products& p = products_[f];
      const std::array<size_t, 3> row = {nodes_[f][0] * columns_, nodes_[f][1] * columns_, nodes_[f][2] * columns_};
      for (size_t c = 0; c < columns_; ++c) {
        const double x0 = x[row[0] + c], x1 = x[row[1] + c], x2 = x[row[2] + c];
        result[row[0] + c] += p.same[0] * x0 + p.opposite[2] * x1 + p.opposite[1] * x2;
        result[row[1] + c] += p.opposite[2] * x0 + p.same[1] * x1 + p.opposite[0] * x2;
        result[row[2] + c] += p.opposite[1] * x0 + p.opposite[0] * x1 + p.same[2] * x2;
      }
    }
    return result;
  }

  // Sums over the samples of a face of products of their weights: of corner k with itself, and of the two others.
  struct Products {
    std::array<double, 3> same{}, opposite{};
  };

  const size_t columns_;
  std::vector<Triangle> nodes_;  // of the corners
  std::vector<double> values_, before_;
  std::vector<Products> products_;  // of the faces
  std::vector<double> diagonal_;
};

}  // namespace

void FitAttributes(const GroupSurface& original, const AttributeFitOptions& options, AttributedMesh* mesh) {
  const Samples samples = TakeSamples(*mesh, original, options);
  tbb::parallel_for(size_t{0}, mesh->attributes.size(), [&](size_t a) {
    const MeshAttribute& wanted = original.mesh().attributes[a];
    ValueFit fit(*mesh, mesh->attributes[a]);
    fit.Solve(samples, original, a);
    if (wanted.kind == AttributeKind::kTextureCoordinates && wanted.components == 2) fit.KeepUnmirrored();
    fit.Write(&mesh->attributes[a], ValueRange(wanted));
  });
  WeldExactly(mesh);
}

}  // namespace lacerta
