#include "remesh/attribute_fit.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
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

// A point of the mesh, and where the original is compared with it: the nearest point first, then those that stand for further sides of seams.
struct Sample {
  uint32_t face;
  std::array<float, 3> weights;
  double share;  // of the area
  std::vector<GroupSurface::Point> near;
  std::vector<Sides> seams;  // ascending attributes
};

bool HasValue(const MeshAttribute& attribute, const GroupSurface::Point& point) { return attribute.corners[point.face][0] != kNone; }

// Of all points near a sample, keeps those that stand for a side of any attribute: one or two of dozens, which would fill the memory.
void KeepSides(const GroupSurface& original, const std::vector<GroupSurface::Point>& near, Sample* sample) {
  if (near.empty()) return;
  uint64_t all = 1;
  std::vector<GroupSurface::Point> sides;
  for (size_t a = 0; a < original.mesh().attributes.size(); ++a) {
    const MeshAttribute& attribute = original.mesh().attributes[a];
    if (!HasValue(attribute, near[0])) continue;
    sides = near;
    original.KeepOnePerSide(attribute, &sides);
    if (sides.size() == 1) continue;
    uint64_t points = 0;
    for (size_t i = 0, side = 0; side < sides.size(); ++i) {
      if (near[i].face == sides[side].face) points |= uint64_t{1} << i, ++side;
    }
    sample->seams.push_back({a, points});
    all |= points;
  }
  std::vector<Sides> seams(sample->seams.size());  // by the numbers of the points that stay
  for (size_t i = 0; i < near.size(); ++i) {
    if ((all >> i & 1) == 0) continue;
    for (size_t s = 0; s < seams.size(); ++s) seams[s].points |= (sample->seams[s].points >> i & 1) << sample->near.size();
    sample->near.push_back(near[i]);
  }
  for (size_t s = 0; s < seams.size(); ++s) sample->seams[s].points = seams[s].points;
}

// The points that stand for the sides of an attribute.
void SidesOf(const Sample& sample, size_t attribute, std::vector<GroupSurface::Point>* sides) {
  sides->clear();
  const auto seam = std::find_if(sample.seams.begin(), sample.seams.end(), [&](const Sides& s) { return s.attribute == attribute; });
  const uint64_t points = seam == sample.seams.end() ? 1 : seam->points;
  for (size_t i = 0; i < sample.near.size(); ++i) {
    if ((points >> i & 1) != 0) sides->push_back(sample.near[i]);
  }
}

std::vector<Sample> TakeSamples(const AttributedMesh& mesh, const GroupSurface& original, const AttributeFitOptions& options) {
  const TriangleMesh& surface = mesh.surface;
  std::vector<double> areas;
  double total = 0;
  for (const Triangle& t : surface.triangles) {
    areas.push_back(Norm(AreaVector(surface.positions, t)));
    total += areas.back();
  }
  std::vector<Sample> samples;
  if (!(total > 0)) return samples;
  uint64_t n = 0;
  for (uint32_t f = 0; f < areas.size(); ++f) {
    if (!(areas[f] > 0)) continue;
    const double share = areas[f] / total;
    const auto count = std::max<uint64_t>(3, static_cast<uint64_t>(share * static_cast<double>(options.num_samples)));
    for (uint64_t i = 0; i < count; ++i) {
      const Vec3d w = TrianglePoint(n++, 0.5);
      samples.push_back({f, {static_cast<float>(w.x), static_cast<float>(w.y), static_cast<float>(w.z)}, share / static_cast<double>(count), {}, {}});
    }
  }
  tbb::parallel_for(tbb::blocked_range<size_t>(0, (samples.size() + kBlockSize - 1) / kBlockSize, 1), [&](const tbb::blocked_range<size_t>& range) {
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
        KeepSides(original, near, &sample);
      }
    }
  });
  return samples;
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

  // Chooses for each sample the side of the original whose value is nearest.
  void SetTargets(const std::vector<Sample>& samples, const GroupSurface& original, size_t index) {
    const MeshAttribute& attribute = original.mesh().attributes[index];
    std::vector<double> value(columns_), here(columns_), target(columns_);
    std::vector<GroupSurface::Point> sides;
    std::vector<double> errors;
    for (const Sample& sample : samples) {
      if (nodes_[sample.face][0] == kNone || sample.near.empty() || !HasValue(attribute, sample.near[0])) continue;
      ValueAt(sample, &here);
      SidesOf(sample, index, &sides);
      double least = INFINITY;
      std::fill(target.begin(), target.end(), 0.0);
      for (const GroupSurface::Point& side : sides) {
        InterpolateValue(attribute, side, value.data());
        double error = 0;
        for (size_t c = 0; c < columns_; ++c) error += (value[c] - here[c]) * (value[c] - here[c]);
        if (error >= least) continue;
        least = error;
        target = value;
      }
      samples_.push_back(&sample);
      weights_.push_back(sample.share);
      targets_.insert(targets_.end(), target.begin(), target.end());
      errors.push_back(least);
    }
    if (errors.empty()) return;
    // What is far off is another part of the surface.
    std::vector<double> sorted = errors;
    const auto usual = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() * 3 / 4);
    std::nth_element(sorted.begin(), usual, sorted.end());
    constexpr double kFar = 16;  // squared
    for (size_t i = 0; i < weights_.size(); ++i) {
      if (errors[i] > kFar * *usual) weights_[i] *= kFar * *usual / errors[i];
    }
  }

  // Conjugate gradients from the values that are there.
  void Solve() {
    constexpr int kIterations = 15;
    SumProducts();
    std::vector<double> residual = Residual();
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

  // Of the samples of every face, what products of the weights of two corners come to; and of every node those of one corner with itself.
  void SumProducts() {
    products_.assign(nodes_.size(), {});
    for (size_t i = 0; i < samples_.size(); ++i) {
      Products& products = products_[samples_[i]->face];
      const std::array<float, 3>& w = samples_[i]->weights;
      for (size_t k = 0; k < 3; ++k) {
        const double weight = weights_[i] * static_cast<double>(w[k]);
        products.same[k] += weight * static_cast<double>(w[k]);
        products.opposite[k] += weights_[i] * static_cast<double>(w[(k + 1) % 3]) * static_cast<double>(w[(k + 2) % 3]);
      }
    }
    diagonal_.assign(values_.size() / columns_, 0.0);
    for (size_t f = 0; f < nodes_.size(); ++f) {
      for (size_t k = 0; k < 3 && nodes_[f][0] != kNone; ++k) diagonal_[nodes_[f][k]] += products_[f].same[k];
    }
  }

  std::vector<double> Residual() const {
    std::vector<double> residual(values_.size(), 0.0), here(columns_);
    for (size_t i = 0; i < samples_.size(); ++i) {
      const Sample& sample = *samples_[i];
      ValueAt(sample, &here);
      for (size_t k = 0; k < 3; ++k) {
        const double weight = weights_[i] * static_cast<double>(sample.weights[k]);
        double* const sum = &residual[nodes_[sample.face][k] * columns_];
        for (size_t c = 0; c < columns_; ++c) sum[c] += weight * (targets_[i * columns_ + c] - here[c]);
      }
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

  // Of corner k with itself, and of the two others.
  struct Products {
    std::array<double, 3> same{}, opposite{};
  };

  const size_t columns_;
  std::vector<Triangle> nodes_;  // of the corners
  std::vector<double> values_, before_;
  std::vector<const Sample*> samples_;
  std::vector<double> weights_, targets_;  // of those
  std::vector<Products> products_;  // of the faces
  std::vector<double> diagonal_;
};

}  // namespace

void FitAttributes(const GroupSurface& original, const AttributeFitOptions& options, AttributedMesh* mesh) {
  const std::vector<Sample> samples = TakeSamples(*mesh, original, options);
  tbb::parallel_for(size_t{0}, mesh->attributes.size(), [&](size_t a) {
    const MeshAttribute& wanted = original.mesh().attributes[a];
    ValueFit fit(*mesh, mesh->attributes[a]);
    fit.SetTargets(samples, original, a);
    fit.Solve();
    if (wanted.kind == AttributeKind::kTextureCoordinates && wanted.components == 2) fit.KeepUnmirrored();
    fit.Write(&mesh->attributes[a], ValueRange(wanted));
  });
  WeldExactly(mesh);
}

}  // namespace lacerta
