#include "remesh/lattice_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/bounding_box.h"
#include "geometry/vertex_area_vectors.h"
#include "remesh/folds.h"
#include "remesh/retreat.h"

namespace lacerta {
namespace {

int32_t Round(double x) { return static_cast<int32_t>(std::lround(x)); }

LatticePoint NearestPoint(const Vec3d& p) { return {Round(p.x), Round(p.y), Round(p.z)}; }

// Of all flaps around a vertex: it is not known which ones predict.
class FlapPrices : public PointPrices {
 public:
  FlapPrices(const MeshNeighbors& neighbors, const RateModel& rate) : neighbors_(neighbors), rate_(rate) {}

  void Begin(const std::vector<LatticePoint>& points) override { points_ = points; }

  // Errors of the flaps around v but for its own part in them, in steps.
  void LookAround(uint32_t v) override {
    errors_.clear();
    for (const uint32_t i : neighbors_.vertex_flaps[v]) {
      const auto& flap = neighbors_.flaps[i];
      LatticePoint sum{};
      int sign = 1;
      for (size_t k = 0; k < 4; ++k) {
        const int s = k < 2 ? 1 : -1;
        if (flap[k] == v) {
          sign = s;
          continue;
        }
        for (size_t c = 0; c < 3; ++c) sum[c] += s * points_[flap[k]][c];
      }
      errors_.push_back({sign * sum[0], sign * sum[1], sign * sum[2]});  // the error is +-(p + this)
    }
  }

  double Bits(const LatticePoint& p, double enough) const override {
    double bits = 0;
    for (const LatticePoint& others : errors_) {
      if (bits >= enough) break;
      double r2 = 0;
      for (size_t c = 0; c < 3; ++c) r2 += static_cast<double>(p[c] + others[c]) * static_cast<double>(p[c] + others[c]);
      bits += rate_.BitsOfFlap(r2 * rate_.step * rate_.step);
    }
    return bits;
  }

  void Move(uint32_t v, const LatticePoint& p) override { points_[v] = p; }

 private:
  const MeshNeighbors& neighbors_;
  const RateModel& rate_;
  std::vector<LatticePoint> points_;
  std::vector<LatticePoint> errors_;
};

// Coordinate descent over lattice points.
class LatticeDescent {
 public:
  LatticeDescent(const FitTarget& target, const TriangleMesh& mesh, const DistanceModel& model, const MeshNeighbors& neighbors, const RateModel& rate, PointPrices* prices)
      : target_(target), mesh_(mesh), model_(model), neighbors_(neighbors), rate_(rate), prices_(*prices), origin_(Vec3Cast<double>(BoundsOf(mesh.positions).low)) {
    lattice_.reserve(mesh.positions.size());
    moves_.resize(mesh.positions.size());
    for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
      const Vec3d exact = (Vec3Cast<double>(mesh.positions[v]) - origin_) * (1 / rate_.step);
      lattice_.push_back(NearestPoint(exact));
      moves_[v] = MoveTo(v, lattice_[v]);
    }
  }

  void Sweep() {
    if (BitsMatter()) prices_.Begin(lattice_);
    for (uint32_t v = 0; v < lattice_.size(); ++v) Improve(v);
  }

  LatticeMesh Result() const {
    LatticeMesh result;
    LatticePoint low = lattice_[0];
    for (const LatticePoint& p : lattice_) {
      for (size_t c = 0; c < 3; ++c) low[c] = std::min(low[c], p[c]);
    }
    result.step = static_cast<float>(rate_.step);
    result.origin = Vec3Cast<float>(origin_ + Vec3d{1.0 * low[0], 1.0 * low[1], 1.0 * low[2]} * rate_.step);
    for (const LatticePoint& p : lattice_) result.lattice.push_back({p[0] - low[0], p[1] - low[1], p[2] - low[2]});
    result.triangles = mesh_.triangles;
    return result;
  }

 private:
  Vec3d MoveTo(uint32_t v, const LatticePoint& p) const {
    return origin_ + Vec3d{1.0 * p[0], 1.0 * p[1], 1.0 * p[2]} * rate_.step - Vec3Cast<double>(mesh_.positions[v]);
  }

  void Improve(uint32_t v) {
    // Of the model with all others as they stand: 2 slope . d + d . A d.
    Vec3d slope = model_.gradient[v];
    for (const uint32_t e : neighbors_.vertex_edges[v]) {
      const auto [a, b] = neighbors_.edges[e];
      slope += model_.off_diagonal[e] * moves_[a == v ? b : a];
    }
    Symmetric3 block = model_.diagonal[v];
    block.AddScaledIdentity(1e-2 * block.Trace() + std::numeric_limits<double>::min());
    const Vec3d optimum = -block.Solve(slope);
    if (BitsMatter()) prices_.LookAround(v);
    const LatticePoint current = lattice_[v];
    const int current_turned = NumTurned(v);
    LatticePoint best = current;
    const double current_excess = CostOfExcess(v, current);
    double best_cost = Cost(v, slope, best, std::numeric_limits<double>::infinity()) + CostOfTurned(current_turned) + current_excess;
    const Vec3d exact = (Vec3Cast<double>(mesh_.positions[v]) + optimum - origin_) * (1 / rate_.step);
    for (const LatticePoint& center : {current, NearestPoint(exact)}) {
      for (int i = 0; i < 27; ++i) {
        const LatticePoint p{center[0] + i % 3 - 1, center[1] + i / 3 % 3 - 1, center[2] + i / 9 - 1};
        if (SquaredNorm(MoveTo(v, p)) > kFarthest * kFarthest * rate_.step * rate_.step) continue;
        double cost = Cost(v, slope, p, best_cost);
        if (cost >= best_cost) continue;
        if (current_turned > 0) {  // by rounding: then what is best may turn it back, and must not turn more
          moves_[v] = MoveTo(v, p);
          const int turned = NumTurned(v);
          if (turned > current_turned) continue;
          cost += CostOfTurned(turned);
        }
        if (cost >= best_cost) continue;
        const double excess = CostOfExcess(v, p);
        cost += excess;
        if (cost >= best_cost || (excess >= current_excess && HasLeft(v, p))) continue;
        best_cost = cost;
        best = p;
      }
    }
    moves_[v] = MoveTo(v, best);
    if (NumTurned(v) > current_turned) {
      best = current;
      moves_[v] = MoveTo(v, best);
    }
    if (best == current) return;
    lattice_[v] = best;
    if (BitsMatter()) prices_.Move(v, best);
  }

  bool BitsMatter() const { return rate_.distortion_per_bit > 0; }

  // The cost of v at p, or a part of it that comes to `enough` already.
  double Cost(uint32_t v, const Vec3d& slope, const LatticePoint& p, double enough) const {
    const Vec3d move = MoveTo(v, p);
    const double distortion = 2 * Dot(slope, move) + Dot(move, model_.diagonal[v] * move);
    if (!BitsMatter() || distortion >= enough) return distortion;
    return distortion + rate_.distortion_per_bit * prices_.Bits(p, (enough - distortion) / rate_.distortion_per_bit);
  }

  Vec3d Moved(uint32_t v) const { return Vec3Cast<double>(mesh_.positions[v]) + moves_[v]; }

  // The number of triangles of v that look the other way than before rounding, and of edges around it that were not folded then.
  int NumTurned(uint32_t v) const {
    int turned = 0;
    for (const uint32_t f : neighbors_.vertex_faces[v]) {
      const Triangle& t = mesh_.triangles[f];
      const Vec3d corner = Moved(t[0]);
      turned += Dot(AreaVector(mesh_.positions, t), Cross(Moved(t[1]) - corner, Moved(t[2]) - corner)) < 0;
    }
    const auto moved = [&](uint32_t u) { return Moved(u); };
    for (const uint32_t i : neighbors_.vertex_flaps[v]) turned += IsFolded(neighbors_.flaps[i], moved) && !IsFolded(neighbors_.flaps[i], mesh_.positions);
    return turned;
  }

  // A fold is seen, though hardly measured.
  double CostOfTurned(int turned) const {
    constexpr double kBits = 3;
    return kBits * turned * rate_.distortion_per_bit;
  }

  // What is far off and small is not even that.
  double CostOfExcess(uint32_t v, const LatticePoint& p) const {
    constexpr double kBits = 20;
    const Vec3d position = Vec3Cast<double>(mesh_.positions[v]) + MoveTo(v, p);
    return kBits * target_.Excess(Vec3Cast<float>(position)) * rate_.distortion_per_bit;
  }

  // What is small and pointed gets no shorter.
  bool HasLeft(uint32_t v, const LatticePoint& p) {
    const Vec3d kept = moves_[v];
    moves_[v] = MoveTo(v, p);
    const bool has_left = HasRetreated(Vec3Cast<double>(mesh_.positions[v]), v, mesh_.triangles, neighbors_, target_.most_retreat(), [&](uint32_t u) { return Moved(u); });
    moves_[v] = kept;
    return has_left;
  }

  static constexpr double kFarthest = 3;  // steps from where the model was made

  const FitTarget& target_;
  const TriangleMesh& mesh_;
  const DistanceModel& model_;
  const MeshNeighbors& neighbors_;
  const RateModel& rate_;
  PointPrices& prices_;
  const Vec3d origin_;
  std::vector<LatticePoint> lattice_;
  std::vector<Vec3d> moves_;  // from mesh_ to the lattice points
};

}  // namespace

TriangleMesh LatticeMesh::ToMesh() const {
  TriangleMesh result;
  result.triangles = triangles;
  result.positions.reserve(lattice.size());
  for (const LatticePoint& p : lattice) {
    result.positions.push_back(
        {origin.x + step * static_cast<float>(p[0]), origin.y + step * static_cast<float>(p[1]), origin.z + step * static_cast<float>(p[2])});
  }
  return result;
}

LatticeMesh NearestOnLattice(const TriangleMesh& mesh, double step) {
  LatticeMesh result;
  result.origin = BoundsOf(mesh.positions).low;
  result.step = static_cast<float>(step);
  result.triangles = mesh.triangles;
  result.lattice.reserve(mesh.positions.size());
  const Vec3d origin = Vec3Cast<double>(result.origin);
  for (const Vec3f& p : mesh.positions) result.lattice.push_back(NearestPoint((Vec3Cast<double>(p) - origin) * (1 / static_cast<double>(result.step))));
  return result;
}

LatticeMesh FitToLattice(const FitTarget& target, const TriangleMesh& mesh, const DistanceModel& model, const MeshNeighbors& neighbors, const RateModel& rate,
                         PointPrices* prices) {
  FlapPrices flaps(neighbors, rate);
  LatticeDescent descent(target, mesh, model, neighbors, rate, prices != nullptr ? prices : &flaps);
  constexpr int kSweeps = 3;
  for (int i = 0; i < kSweeps; ++i) descent.Sweep();
  return descent.Result();
}

}  // namespace lacerta
