#include "remesh/attribute_fit.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "geometry/equal_rows.h"
#include "remesh/attribute_samples.h"
#include "remesh/attribute_values.h"

namespace lacerta {
namespace {

constexpr uint32_t kNone = MeshAttribute::kNoValue;
constexpr double kStiffness = 0.02;  // of staying in place, relative to the samples around

// The least squares problem of one attribute. Its unknowns are nodes, which are its values vertex by vertex; each component is a problem of its own
// with the same matrix.
class ValueFit {
 public:
  // Components that are solved together. Of dozens, as weights of joints have, each has values in a few places.
  static constexpr size_t kColumns = 4;

  // index: of the attribute in both; `samples` are of `mesh`. All must outlive the fit.
  ValueFit(const AttributedMesh& mesh, const AttributeSamples& samples, const GroupSurface& original, size_t index)
      : samples_(samples), attribute_(mesh.attributes[index]), wanted_(original.mesh().attributes[index]) {
    MakeNodes(mesh.surface);
    SetGoals(index);
    SumProducts();
  }

  // The attribute with the values of the original, as far as it can have them.
  MeshAttribute Solved() const {
    MeshAttribute result = attribute_;
    result.corners = nodes_;
    result.values.clear();
    for (const uint32_t row : rows_) result.values.insert(result.values.end(), ValueOf(row), ValueOf(row) + attribute_.components);
    const size_t num_blocks = (attribute_.components + kColumns - 1) / kColumns;
    tbb::parallel_for(size_t{0}, num_blocks, [&](size_t block) { SolveColumns(block * kColumns, &result.values); });
    if (wanted_.kind == AttributeKind::kTextureCoordinates && wanted_.components == 2) KeepUnmirrored(&result.values);
    const ValueRange range(wanted_);
    for (size_t i = 0; i < result.values.size(); i += attribute_.components) range.Legalize(&result.values[i]);
    return result;
  }

 private:
  using Columns = std::array<double, kColumns>;

  // What a sample is held to.
  struct Goal {
    const GroupSurface::Point* point = nullptr;  // of the original, on the side whose value is nearest; null: it has none
    double error = 0;                            // of the value that is there, squared
  };

  // Sums over the samples of a face of products of their weights: of corner k with itself, and of the two others.
  struct Products {
    std::array<double, 3> same{}, opposite{};
  };

  const float* ValueOf(uint32_t row) const { return &attribute_.values[size_t{row} * attribute_.components]; }

  void MakeNodes(const TriangleMesh& surface) {
    std::vector<uint32_t> table;
    for (size_t f = 0; f < attribute_.corners.size(); ++f) {
      for (size_t k = 0; k < 3; ++k) table.insert(table.end(), {surface.triangles[f][k], attribute_.corners[f][k]});
    }
    const std::vector<uint32_t> first = FirstEqualRow(Span<const uint32_t>(table), 2);
    std::vector<uint32_t> number(first.size(), kNone);
    nodes_.resize(attribute_.corners.size(), {kNone, kNone, kNone});
    for (size_t i = 0; i < first.size(); ++i) {
      const uint32_t row = table[2 * i + 1];
      if (row == kNone) continue;
      if (first[i] == i) {
        number[i] = static_cast<uint32_t>(rows_.size());
        rows_.push_back(row);
      }
      nodes_[i / 3][i % 3] = number[first[i]];
    }
  }

  // How many components are solved together from `first` on.
  size_t CountFrom(size_t first) const { return std::min(kColumns, attribute_.components - first); }

  // Some components of an interpolated value, from `first` on.
  Columns Interpolated(const MeshAttribute& attribute, uint32_t face, const std::array<float, 3>& weights, size_t first) const {
    const size_t count = CountFrom(first);
    Columns value{};
    for (size_t k = 0; k < 3; ++k) {
      const float* row = &attribute.values[size_t{attribute.corners[face][k]} * attribute.components + first];
      for (size_t c = 0; c < count; ++c) value[c] += static_cast<double>(weights[k]) * static_cast<double>(row[c]);
    }
    return value;
  }

  // Of the value that is there, and of the original.
  Columns Here(const AttributeSamples::Sample& sample, size_t first) const { return Interpolated(attribute_, sample.face, sample.weights, first); }
  Columns There(const GroupSurface::Point& point, size_t first) const { return Interpolated(wanted_, point.face, point.barycentric, first); }

  // The squared difference of the value that is there to that of the original.
  double ErrorAt(const AttributeSamples::Sample& sample, const GroupSurface::Point& point) const {
    double error = 0;
    for (size_t first = 0; first < attribute_.components; first += kColumns) {
      const Columns here = Here(sample, first), there = There(point, first);
      for (size_t c = 0; c < kColumns; ++c) error += (there[c] - here[c]) * (there[c] - here[c]);
    }
    return error;
  }

  void SetGoals(size_t index) {
    goals_.resize(samples_.size());
    tbb::parallel_for(tbb::blocked_range<size_t>(0, goals_.size(), 1024), [&](const tbb::blocked_range<size_t>& range) {
      for (size_t i = range.begin(); i != range.end(); ++i) {
        const AttributeSamples::Sample& sample = samples_[i];
        if (nodes_[sample.face][0] == kNone || sample.closest.face == kNone || wanted_.corners[sample.closest.face][0] == kNone) continue;
        samples_.ForEachSide(i, index, [&](const GroupSurface::Point& point) {
          const double error = ErrorAt(sample, point);
          if (goals_[i].point == nullptr || error < goals_[i].error) goals_[i] = {&point, error};
        });
      }
    });
    far_error_ = FarError();
  }

  // Weights of joints and morph targets are stored where they are not 0.
  bool IsSparse() const { return attribute_.kind == AttributeKind::kWeights || attribute_.kind == AttributeKind::kGeneric; }

  // Beyond this squared error a sample counts less and less: what is far off is another part of the surface. Where sparse values are equal, to the last
  // digits, there is nothing to tell what is usual: a morph target moves a small part of a surface.
  double FarError() const {
    constexpr double kFar = 16, kDigits = 1e-6;
    double largest = 0;
    for (const float x : wanted_.values) largest = std::max(largest, std::fabs(static_cast<double>(x)));
    const double nothing = (kDigits * largest) * (kDigits * largest);
    std::vector<double> errors;
    for (const Goal& goal : goals_) {
      if (goal.point != nullptr && (!IsSparse() || goal.error > nothing)) errors.push_back(goal.error);
    }
    if (errors.empty()) return nothing;
    const auto usual = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() * 3 / 4);
    std::nth_element(errors.begin(), usual, errors.end());
    return kFar * *usual;
  }

  double WeightOf(size_t i) const {
    const double weight = samples_.ShareOf(i);
    return goals_[i].error > far_error_ ? weight * (far_error_ / goals_[i].error) : weight;
  }

  void SumProducts() {
    products_.resize(nodes_.size());
    for (size_t i = 0; i < goals_.size(); ++i) {
      if (goals_[i].point == nullptr) continue;
      const double weight = WeightOf(i);
      const std::array<float, 3>& w = samples_[i].weights;
      Products& sums = products_[samples_[i].face];
      for (size_t k = 0; k < 3; ++k) {
        sums.same[k] += weight * static_cast<double>(w[k]) * static_cast<double>(w[k]);
        sums.opposite[k] += weight * static_cast<double>(w[(k + 1) % 3]) * static_cast<double>(w[(k + 2) % 3]);
      }
    }
    diagonal_.assign(rows_.size(), 0.0);
    for (size_t f = 0; f < nodes_.size(); ++f) {
      for (size_t k = 0; k < 3 && nodes_[f][0] != kNone; ++k) diagonal_[nodes_[f][k]] += products_[f].same[k];
    }
  }

  // The nodes around which some components differ from what is wanted, numbered anew, and the triangles that have any. All others stay as they are.
  struct Part {
    std::vector<uint32_t> nodes;
    std::vector<std::array<uint32_t, 4>> triangles;  // three nodes of the part, or nodes.size() for others; and the face
    std::vector<Columns> residual, divisor;          // of the nodes: what is wanted, and by what it is divided at first
  };

  // Infinite for what stays.
  Columns DivisorOf(uint32_t node, size_t first) const {
    Columns result;
    result.fill(diagonal_[node] > 0 ? diagonal_[node] * (1 + kStiffness) : INFINITY);
    const float* const row = ValueOf(rows_[node]) + first;
    for (size_t c = 0; c < CountFrom(first); ++c) {
      if (IsSparse() && row[c] == 0) result[c] = INFINITY;
    }
    return result;
  }

  Part PartOf(size_t first) const {
    std::vector<Columns> sums(rows_.size(), Columns{});
    std::vector<uint32_t> number(rows_.size(), kNone);
    for (size_t i = 0; i < goals_.size(); ++i) {
      if (goals_[i].point == nullptr) continue;
      const AttributeSamples::Sample& sample = samples_[i];
      const Columns here = Here(sample, first), there = There(*goals_[i].point, first);
      if (here == there) continue;
      const double weight = WeightOf(i);
      for (size_t k = 0; k < 3; ++k) {
        const double own = weight * static_cast<double>(sample.weights[k]);
        const uint32_t node = nodes_[sample.face][k];
        number[node] = 0;
        for (size_t c = 0; c < kColumns; ++c) sums[node][c] += own * (there[c] - here[c]);
      }
    }
    Part part;
    for (uint32_t node = 0; node < number.size(); ++node) {
      if (number[node] == kNone) continue;
      number[node] = static_cast<uint32_t>(part.nodes.size());
      part.nodes.push_back(node);
      part.residual.push_back(sums[node]);
      part.divisor.push_back(DivisorOf(node, first));
    }
    const auto others = static_cast<uint32_t>(part.nodes.size());
    for (uint32_t f = 0; f < nodes_.size(); ++f) {
      if (nodes_[f][0] == kNone) continue;
      std::array<uint32_t, 4> triangle{others, others, others, f};
      bool any = false;
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t n = number[nodes_[f][k]];
        if (n != kNone) triangle[k] = n, any = true;
      }
      if (any) part.triangles.push_back(triangle);
    }
    return part;
  }

  // Conjugate gradients from the values that are there to those of the original at the samples. *values: of the nodes.
  void SolveColumns(size_t first, std::vector<float>* values) const {
    constexpr int kIterations = 15;
    Part part = PartOf(first);
    const size_t size = part.nodes.size();
    std::vector<Columns>& residual = part.residual;
    std::vector<Columns> direction(size + 1, Columns{}), moves(size, Columns{}), product;
    double energy = 0, first_energy = 0;
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      const auto conditioned = [&](size_t n, size_t c) { return residual[n][c] / part.divisor[n][c]; };
      double next_energy = 0;
      for (size_t n = 0; n < size; ++n) {
        for (size_t c = 0; c < kColumns; ++c) next_energy += conditioned(n, c) * residual[n][c];
      }
      if (iteration == 0) first_energy = next_energy;
      if (!(next_energy > 1e-8 * first_energy)) break;
      const double keep = iteration == 0 ? 0 : next_energy / energy;
      energy = next_energy;
      for (size_t n = 0; n < size; ++n) {
        for (size_t c = 0; c < kColumns; ++c) direction[n][c] = conditioned(n, c) + keep * direction[n][c];
      }
      Multiply(part, direction, &product);
      double curvature = 0;
      for (size_t n = 0; n < size; ++n) {
        for (size_t c = 0; c < kColumns; ++c) curvature += direction[n][c] * product[n][c];
      }
      if (!(curvature > 0)) break;
      const double length = energy / curvature;
      for (size_t n = 0; n < size; ++n) {
        for (size_t c = 0; c < kColumns; ++c) {
          moves[n][c] += length * direction[n][c];
          residual[n][c] -= length * product[n][c];
        }
      }
    }
    for (size_t n = 0; n < size; ++n) {
      float* const row = &(*values)[part.nodes[n] * size_t{attribute_.components} + first];
      for (size_t c = 0; c < CountFrom(first); ++c) row[c] = static_cast<float>(static_cast<double>(row[c]) + moves[n][c]);
    }
  }

  // x: of the nodes of the part and, 0, of all others.
  void Multiply(const Part& part, const std::vector<Columns>& x, std::vector<Columns>* product) const {
    std::vector<Columns>& result = *product;
    result.resize(x.size());
    for (size_t n = 0; n < part.nodes.size(); ++n) {
      for (size_t c = 0; c < kColumns; ++c) result[n][c] = kStiffness * diagonal_[part.nodes[n]] * x[n][c];
    }
    for (const std::array<uint32_t, 4>& t : part.triangles) {
      const Products& p = products_[t[3]];
      const Columns &x0 = x[t[0]], &x1 = x[t[1]], &x2 = x[t[2]];
      for (size_t c = 0; c < kColumns; ++c) {
        result[t[0]][c] += p.same[0] * x0[c] + p.opposite[2] * x1[c] + p.opposite[1] * x2[c];
        result[t[1]][c] += p.opposite[2] * x0[c] + p.same[1] * x1[c] + p.opposite[0] * x2[c];
        result[t[2]][c] += p.opposite[1] * x0[c] + p.opposite[0] * x1[c] + p.same[2] * x2[c];
      }
    }
  }

  // Takes back the values of texture triangles that are mirrored now.
  void KeepUnmirrored(std::vector<float>* values) const {
    std::vector<float> before;
    for (const uint32_t row : rows_) before.insert(before.end(), ValueOf(row), ValueOf(row) + 2);
    const auto doubled_area = [](const Triangle& t, const std::vector<float>& v) {
      const auto at = [&](size_t k, size_t c) { return static_cast<double>(v[2 * size_t{t[k]} + c]); };
      return (at(1, 0) - at(0, 0)) * (at(2, 1) - at(0, 1)) - (at(1, 1) - at(0, 1)) * (at(2, 0) - at(0, 0));
    };
    constexpr int kRounds = 8;  // of taking back what the others make necessary; then everything
    for (int round = 0; round <= kRounds; ++round) {
      bool any = false;
      for (const Triangle& t : nodes_) {
        if (t[0] == kNone) continue;
        const double area = doubled_area(t, before);
        if (area == 0 || area * doubled_area(t, *values) > 0) continue;
        any = true;
        for (const uint32_t node : t) std::copy_n(&before[2 * size_t{node}], 2, &(*values)[2 * size_t{node}]);
      }
      if (!any) return;
    }
    *values = before;
  }

  const AttributeSamples& samples_;
  const MeshAttribute &attribute_, &wanted_;
  std::vector<Triangle> nodes_;  // of the corners
  std::vector<uint32_t> rows_;   // of the nodes: where attribute_ has their value
  std::vector<Goal> goals_;      // of the samples
  double far_error_ = 0;
  std::vector<Products> products_;  // of the faces
  std::vector<double> diagonal_;
};

}  // namespace

void FitAttributes(const GroupSurface& original, const AttributeFitOptions& options, AttributedMesh* mesh) {
  const AttributeSamples samples(*mesh, original, options.num_samples, options.seam_distance * options.diagonal);
  tbb::parallel_for(size_t{0}, mesh->attributes.size(), [&](size_t a) { mesh->attributes[a] = ValueFit(*mesh, samples, original, a).Solved(); });
  WeldExactly(mesh);
}

}  // namespace lacerta
