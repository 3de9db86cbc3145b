// What values on a lattice cost in a stock Draco stream, about: from where they are predicted, and how often residuals of a size come up.
#ifndef LACERTA_PACK_VALUE_PREDICTIONS_H_
#define LACERTA_PACK_VALUE_PREDICTIONS_H_

#include <draco/compression/attributes/prediction_schemes/prediction_scheme_normal_octahedron_canonicalized_encoding_transform.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "pack/lattice_points.h"
#include "pack/value_wedges.h"

namespace lacerta {

// What residuals cost, from how often those of their size come up.
class ResidualCosts {
 public:
  void Count(int32_t residual) { ++counts_[Bin(residual)]; }

  void Settle() {
    constexpr double kUnseen = 0.02;
    constexpr int kSmoothing = 4;  // sizes within a fourth of each other are taken together
    std::vector<double> before(1, 0.0);  // counts of smaller ones
    for (const double count : counts_) before.push_back(before.back() + count);
    const double sum = 1.0 + before.back();
    for (int r = 0; r < kNumBins; ++r) {
      const int reach = r / kSmoothing, low = std::max(std::min(r, 1), r - reach), high = std::min(kNumBins - 1, r + reach);
      const double near = before[static_cast<size_t>(high) + 1] - before[static_cast<size_t>(low)];
      const double signs = r == 0 ? 1.0 : 2.0;
      bits_[static_cast<size_t>(r)] = -std::log2((near / (high - low + 1) / signs + kUnseen / (1 + r)) / sum);
    }
  }

  double operator()(int32_t residual) const { return bits_[Bin(residual)]; }

  // Of all that were counted.
  double Sum() const { return std::inner_product(counts_.begin(), counts_.end(), bits_.begin(), 0.0); }

 private:
  static constexpr int kNumBins = 1024;
  static size_t Bin(int32_t residual) { return static_cast<size_t>(std::min(std::abs(residual), kNumBins - 1)); }

  std::vector<double> counts_ = std::vector<double>(kNumBins), bits_ = std::vector<double>(kNumBins);
};

// Of everything that a prediction counts.
template <typename Prediction>
double BitsOf(const Prediction& prediction, const std::vector<LatticePoint>& points) {
  ResidualCosts costs;
  prediction.Count(points, &costs);
  costs.Settle();
  return costs.Sum();
}

// From the triangles around a vertex, whichever way they look: MESH_PREDICTION_GEOMETRIC_NORMAL.
class NormalPrediction {
 public:
  static constexpr bool kIsNormal = true;

  NormalPrediction(const ValueWedges& wedges, const LatticeDirections& points, const std::vector<LatticePoint>&) : box_(points.box()), transform_(box_.max_quantized_value()) {
    std::vector<Vec3d> sums(wedges.size());
    for (const std::array<uint32_t, 3>& t : wedges.triangles) {
      const Vec3d area = Cross(wedges.positions[t[1]] - wedges.positions[t[0]], wedges.positions[t[2]] - wedges.positions[t[0]]);
      for (const uint32_t w : t) sums[w] += area;
    }
    constexpr double kLength = 1 << 29;
    for (const Vec3d& sum : sums) {
      const double length = std::fabs(sum.x) + std::fabs(sum.y) + std::fabs(sum.z);
      int32_t vector[3] = {};
      for (int axis = 0; axis < 3 && length > 0.0; ++axis) vector[axis] = static_cast<int32_t>(sum[axis] / length * kLength);
      box_.CanonicalizeIntegerVector(vector);
      predicted_.emplace_back();
      for (LatticePoint& point : predicted_.back()) {
        box_.IntegerVectorToQuantizedOctahedralCoords(vector, point.data(), point.data() + 1);
        for (int32_t& x : vector) x = -x;
      }
    }
  }

  std::optional<LatticePoint> Predicted(size_t wedge) const { return predicted_[wedge][0]; }

  void Count(const std::vector<LatticePoint>& points, ResidualCosts* costs) const {
    for (size_t w = 0; w < points.size(); ++w) {
      for (const int32_t residual : ResidualOf(w, points[w])) costs->Count(residual);
    }
  }

  // What a wedge takes at a point, all others where they are.
  auto BitsNear(size_t wedge, const std::vector<LatticePoint>&, const ResidualCosts& costs) const {
    return [this, wedge, &costs](const LatticePoint& point) {
      const std::array<int32_t, 2> residual = ResidualOf(wedge, point);
      return costs(residual[0]) + costs(residual[1]);
    };
  }

 private:
  std::array<int32_t, 2> ResidualOf(size_t wedge, const LatticePoint& point) const {
    std::array<int32_t, 2> smallest = {};
    int32_t least = std::numeric_limits<int32_t>::max();
    for (const LatticePoint& predicted : predicted_[wedge]) {
      int32_t residual[2];
      transform_.ComputeCorrection(point.data(), predicted.data(), residual);
      const std::array<int32_t, 2> both = {box_.ModMax(residual[0]), box_.ModMax(residual[1])};
      const int32_t size = std::abs(both[0]) + std::abs(both[1]);
      if (size < least) least = size, smallest = both;
    }
    return smallest;
  }

  const draco::OctahedronToolBox& box_;
  draco::PredictionSchemeNormalOctahedronCanonicalizedEncodingTransform<int32_t> transform_;
  std::vector<std::array<LatticePoint, 2>> predicted_;
};

// From the other two corners of a triangle, as if the texture were stretched alike along and across: MESH_PREDICTION_TEX_COORDS_PORTABLE. Which triangle is
// not known, so that all around a vertex count alike.
class TexturePrediction {
 public:
  static constexpr bool kIsNormal = false;

  TexturePrediction(const ValueWedges& wedges, const LatticeNumbers&, const std::vector<LatticePoint>& points) : wedges_(wedges) {
    for (const std::array<uint32_t, 3>& t : wedges.triangles) {
      for (size_t k = 0; k < 3; ++k) {
        const Vec3d next = wedges.positions[t[(k + 1) % 3]], base = wedges.positions[t[(k + 2) % 3]] - next, tip = wedges.positions[t[k]] - next;
        Frame frame;
        if (const double length2 = lacerta::Dot(base, base); length2 > 0.0) {
          frame.along = lacerta::Dot(tip, base) / length2;
          frame.across = std::sqrt(lacerta::Dot(tip - base * frame.along, tip - base * frame.along) / length2);
        }
        frames_.push_back(frame);
        const auto mirrored = [&](double sign) {  // the side of the texture on which the triangle lies
          frames_.back().across = sign * frame.across;
          const std::array<int32_t, 2> residual = ResidualOf(frames_.size() - 1, points[t[k]], points[t[(k + 1) % 3]], points[t[(k + 2) % 3]]);
          return std::abs(residual[0]) + std::abs(residual[1]);
        };
        if (mirrored(-1.0) > mirrored(1.0)) continue;
        frames_.back().across = -frame.across;
      }
    }
    weight_ = static_cast<double>(wedges.size()) / std::max(1.0, static_cast<double>(frames_.size()));
  }

  static std::optional<LatticePoint> Predicted(size_t) { return std::nullopt; }

  double Bits(const std::vector<LatticePoint>& points) const { return weight_ * BitsOf(*this, points); }

  void Count(const std::vector<LatticePoint>& points, ResidualCosts* costs) const {
    for (size_t f = 0; f < frames_.size(); ++f) {
      const std::array<uint32_t, 3>& t = wedges_.triangles[f / 3];
      for (const int32_t residual : ResidualOf(f, points[t[f % 3]], points[t[(f + 1) % 3]], points[t[(f + 2) % 3]])) costs->Count(residual);
    }
  }

  auto BitsNear(size_t wedge, const std::vector<LatticePoint>& points, const ResidualCosts& costs) const {
    return [this, wedge, &points, &costs](const LatticePoint& point) { return BitsAt(wedge, point, points, costs); };
  }

 private:
  double BitsAt(size_t wedge, const LatticePoint& point, const std::vector<LatticePoint>& points, const ResidualCosts& costs) const {
    double bits = 0.0;
    for (const uint32_t corner : wedges_.corners[wedge]) {
      const uint32_t first = corner - corner % 3;
      const std::array<uint32_t, 3>& t = wedges_.triangles[corner / 3];
      std::array<const LatticePoint*, 3> at;
      for (size_t k = 0; k < 3; ++k) at[k] = t[k] == wedge ? &point : &points[t[k]];
      for (uint32_t k = 0; k < 3; ++k) {
        for (const int32_t residual : ResidualOf(first + k, *at[k], *at[(k + 1) % 3], *at[(k + 2) % 3])) bits += costs(residual);
      }
    }
    return weight_ * bits;
  }

  struct Frame {
    double along = 0.0, across = 0.0;  // of the tip, over the length of the base
  };

  std::array<int32_t, 2> ResidualOf(size_t frame, const LatticePoint& tip, const LatticePoint& next, const LatticePoint& previous) const {
    const auto [along, across] = frames_[frame];
    const double u = previous[0] - next[0], v = previous[1] - next[1];
    return {static_cast<int32_t>(std::lrint(tip[0] - next[0] - along * u - across * v)), static_cast<int32_t>(std::lrint(tip[1] - next[1] - along * v + across * u))};
  }

  const ValueWedges& wedges_;
  std::vector<Frame> frames_;  // of every corner
  double weight_ = 0.0;        // of one of these
};

// By parallelograms. Which of those around a vertex is not known, so that all count alike.
class FlapPrediction {
 public:
  static constexpr bool kIsNormal = false;

  FlapPrediction(const ValueWedges& wedges, const LatticeNumbers& lattice, const std::vector<LatticePoint>& points) : FlapPrediction(wedges, Varying(points, lattice.coordinates())) {}

  FlapPrediction(const ValueWedges& wedges, std::vector<uint32_t> coordinates) : coordinates_(std::move(coordinates)) {
    struct HalfEdge {
      uint32_t low, high, tip;
      bool is_reversed;
    };
    std::vector<HalfEdge> edges;
    edges.reserve(3 * wedges.triangles.size());
    for (const std::array<uint32_t, 3>& t : wedges.triangles) {
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t from = t[k], to = t[(k + 1) % 3];
        edges.push_back({std::min(from, to), std::max(from, to), t[(k + 2) % 3], from > to});
      }
    }
    const auto key = [](const HalfEdge& e) { return std::make_tuple(e.low, e.high, e.is_reversed, e.tip); };
    std::sort(edges.begin(), edges.end(), [&](const HalfEdge& a, const HalfEdge& b) { return key(a) < key(b); });
    for (size_t i = 1; i < edges.size(); ++i) {  // where sides of one edge meet that run in opposite directions
      const HalfEdge &a = edges[i - 1], &b = edges[i];
      if (a.low == b.low && a.high == b.high && a.is_reversed != b.is_reversed) flaps_.push_back({a.tip, b.tip, a.low, a.high});
    }
    places_ = PlacesByVertex(flaps_, wedges.size());
    weight_ = std::min(1.0, static_cast<double>(wedges.size()) / std::max(1.0, static_cast<double>(flaps_.size())));
  }

  static std::optional<LatticePoint> Predicted(size_t) { return std::nullopt; }

  double Bits(const std::vector<LatticePoint>& points) const { return weight_ * BitsOf(*this, points); }

  void Count(const std::vector<LatticePoint>& points, ResidualCosts* costs) const {
    for (const std::array<uint32_t, 4>& flap : flaps_) {
      for (const uint32_t c : coordinates_) costs->Count(ResidualOf(flap, c, points));
    }
  }

  // Of points no more than a step off in any of the coordinates, each of which takes its bits apart.
  class BitsAround {
   public:
    BitsAround(const FlapPrediction& prediction, size_t wedge, const std::vector<LatticePoint>& points, const ResidualCosts& costs) : around_(points[wedge]) {
      for (const uint32_t place : prediction.places_[wedge]) {
        const std::array<uint32_t, 4>& flap = prediction.flaps_[place / 4];
        const int32_t sign = place % 4 < 2 ? 1 : -1;
        for (const uint32_t c : prediction.coordinates_) {
          const int32_t residual = ResidualOf(flap, c, points);
          int32_t step = -1;
          for (double& bits : bits_[c]) bits += prediction.weight_ * costs(residual + sign * step++);
        }
      }
    }

    double operator()(const LatticePoint& point) const {
      double bits = 0.0;
      for (size_t c = 0; c < bits_.size(); ++c) {
        const int32_t step = point[c] - around_[c];
        bits += step == 0 ? bits_[c][1] : bits_[c][step < 0 ? 0 : 2];
      }
      return bits;
    }

   private:
    const LatticePoint around_;
    std::array<std::array<double, 3>, kMostComponents> bits_ = {};
  };

  BitsAround BitsNear(size_t wedge, const std::vector<LatticePoint>& points, const ResidualCosts& costs) const { return {*this, wedge, points, costs}; }

 private:
  // Coordinates that are the same everywhere take no bits, and say nothing of others.
  static std::vector<uint32_t> Varying(const std::vector<LatticePoint>& points, uint32_t coordinates) {
    std::vector<uint32_t> varying;
    for (uint32_t c = 0; c < coordinates; ++c) {
      if (std::any_of(points.begin(), points.end(), [&](const LatticePoint& point) { return point[c] != points[0][c]; })) varying.push_back(c);
    }
    return varying;
  }

  static int32_t ResidualOf(const std::array<uint32_t, 4>& flap, uint32_t c, const std::vector<LatticePoint>& points) {
    return points[flap[0]][c] + points[flap[1]][c] - points[flap[2]][c] - points[flap[3]][c];
  }

  std::vector<uint32_t> coordinates_;
  std::vector<std::array<uint32_t, 4>> flaps_;  // two tips, two ends of an edge
  ByVertex places_;                             // of each wedge: 4 * flap + which of the four
  double weight_ = 0.0;                         // of one flap
};

}  // namespace lacerta

#endif  // LACERTA_PACK_VALUE_PREDICTIONS_H_
