#include "draco/zero_level_candidate.h"

#include <algorithm>
#include <utility>

#include "draco/component_order.h"
#include "draco/parallelogram_prices.h"
#include "remesh/edge_flips.h"
#include "remesh/mesh_fit.h"

namespace lacerta {
namespace {

// More would take samples without end, and gain little: what is so fine is near the input anyway.
constexpr size_t kMostFittedTriangles = 60000;

double Distortion(const DistanceModel& model) { return std::max(model.forward, model.backward); }

}  // namespace

ZeroLevelCandidate::ZeroLevelCandidate(const FitTarget& target, TriangleMesh mesh, Source source)
    : target_(target), mesh_(std::move(mesh)), source_(source) {
  const int rounds = source_ == Source::kFitted ? 1 : 2;
  if (mesh_.triangles.size() <= kMostFittedTriangles) {
    mesh_.triangles = ByNearestComponents(mesh_, kManyComponents);
    neighbors_.emplace(mesh_);
    if (source_ != Source::kInput) FitToSurface(target_, *neighbors_, RateModel(), rounds, &mesh_);
    model_ = target_.ModelAt(mesh_, *neighbors_);
  }
  if (source_ != Source::kInput) fit_distortion_ = neighbors_ ? Distortion(model_) : target_.DistortionAt(mesh_);
}

void ZeroLevelCandidate::FitForRate(double lattice_distortion, int rounds) {
  if (!neighbors_) return;
  order_.reset();
  const RateModel rate = RateModel::For(lattice_distortion, mesh_.positions.size());
  distortion_per_bit_ = rate.distortion_per_bit;
  if (source_ != Source::kInput) {
    if (EdgeFlipper(target_, &mesh_).Flip(rate) > 0) neighbors_.emplace(mesh_);
    FitToSurface(target_, *neighbors_, rate, rounds, &mesh_);
  }
  model_ = target_.ModelAt(mesh_, *neighbors_);
  if (source_ != Source::kInput) fit_distortion_ = Distortion(model_);
}

// Draco rounds in floats, which hold no finer lattice than kFinest. And decoders compute in floats.
double ZeroLevelCandidate::StepNear(double step) const {
  constexpr double kFinest = 1.0 / (1 << 21);
  return static_cast<double>(static_cast<float>(std::max(step, kFinest * target_.diagonal())));
}

void ZeroLevelCandidate::FitForStream(double wanted_step) {
  if (!neighbors_) return;
  const double step = StepNear(wanted_step);
  order_.reset();
  const RateModel rate{step, distortion_per_bit_};
  LatticeMesh lattice = FitToLattice(target_, mesh_, model_, *neighbors_, rate);
  StatusOr<PositionStream> order = SmallestOrder(lattice);
  if (!order.ok()) return;
  order_ = std::move(order).value();
  if (source_ == Source::kInput) return;
  ParallelogramPrices prices(*order_, mesh_.positions.size());
  constexpr int kChoices = 2, kRounds = 2;
  for (int i = 0; i < kChoices; ++i) {
    prices.Begin(lattice.lattice);
    FitToSurface(target_, *neighbors_, rate, prices.Predictions(), kRounds, &mesh_);
    model_ = target_.ModelAt(mesh_, *neighbors_);
    if (i + 1 < kChoices) lattice = FitToLattice(target_, mesh_, model_, *neighbors_, rate, &prices);
  }
  fit_distortion_ = Distortion(model_);
}

StatusOr<ZeroLevelCandidate::Coding> ZeroLevelCandidate::Code(double step, int rounds, CodingEffort effort,
                                                                    BaseCoding base_coding) const {
  Coding coding;
  coding.step = StepNear(step);
  const LatticeMesh lattice = neighbors_ ? FitLattice(coding.step, rounds, &coding.distortion) : NearestOnLattice(mesh_, coding.step);
  if (!neighbors_) coding.distortion = target_.DistortionAt(lattice.ToMesh());
  LACERTA_ASSIGN_OR_RETURN(coding.coded, Encode(lattice, effort, base_coding));
  coding.bytes = coding.coded.stream.size();
  return coding;
}

StatusOr<CodedZeroLevel> ZeroLevelCandidate::Encode(const LatticeMesh& lattice, CodingEffort effort, BaseCoding coding) const {
  if (order_) {
    StatusOr<CodedZeroLevel> coded = EncodeInOrder(*order_, lattice);
    if (coded.ok()) return coded;
  }
  return EncodeLatticeMesh(lattice, effort, coding);
}

LatticeMesh ZeroLevelCandidate::FitLattice(double step, int rounds, double* distortion) const {
  const RateModel rate{step, distortion_per_bit_};
  std::optional<ParallelogramPrices> known;
  if (order_) known.emplace(*order_, mesh_.positions.size());
  PointPrices* const prices = known ? &*known : nullptr;
  LatticeMesh lattice = FitToLattice(target_, mesh_, model_, *neighbors_, rate, prices);
  DistanceModel model = target_.ModelAt(lattice.ToMesh(), *neighbors_);
  for (int i = 1; i < rounds; ++i) {
    LatticeMesh again = FitToLattice(target_, lattice.ToMesh(), model, *neighbors_, rate, prices);
    DistanceModel model_again = target_.ModelAt(again.ToMesh(), *neighbors_);
    lattice = std::move(again);
    model = std::move(model_again);
  }
  *distortion = Distortion(model);
  return lattice;
}

}  // namespace lacerta
