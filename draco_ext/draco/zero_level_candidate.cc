#include "draco/zero_level_candidate.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lacerta {
namespace {

// More would take samples without end, and gain little: what is so fine is near the input anyway.
constexpr size_t kMostFittedTriangles = 60000;

double Distortion(const DistanceModel& model) { return std::max(model.forward, model.backward); }

// Says nothing about the vertices, so that each stays at the lattice point next to it.
DistanceModel WithoutOpinion(size_t num_vertices, size_t num_edges) {
  DistanceModel model;
  model.gradient.resize(num_vertices);
  model.diagonal.resize(num_vertices);
  model.off_diagonal.resize(num_edges);
  return model;
}

}  // namespace

ZeroLevelCandidate::ZeroLevelCandidate(const FitTarget& target, TriangleMesh mesh, Source source)
    : target_(target),
      mesh_(std::move(mesh)),
      source_(source),
      is_small_(mesh_.triangles.size() <= kMostFittedTriangles),
      neighbors_(mesh_) {
  constexpr int kRounds = 2;
  if (source_ == Source::kSimplified && is_small_) FitToSurface(target_, neighbors_, RateModel(), kRounds, &mesh_);
  if (is_small_ || source_ == Source::kSimplified) {
    model_ = target_.ModelAt(mesh_, neighbors_);
    fit_distortion_ = source_ == Source::kInput ? 0 : Distortion(model_);
  }
  if (!is_small_) model_ = WithoutOpinion(mesh_.positions.size(), neighbors_.edges.size());
}

double ZeroLevelCandidate::StepFor(double lattice_distortion) {
  // Rounding alone errs by step / sqrt(12) along the normal; the descent leaves an eighth of its square.
  constexpr double kSquaredStep = 12 * 8;
  return std::sqrt(kSquaredStep * lattice_distortion);
}

void ZeroLevelCandidate::FitForRate(double lattice_distortion, int rounds) {
  if (!is_small_) return;
  // D ~ 4^-b in the b bits of each coordinate: the slope of D over all bits.
  constexpr double kLn2 = 0.6931471805599453;
  distortion_per_bit_ = 2 * kLn2 * lattice_distortion / (3 * static_cast<double>(mesh_.positions.size()));
  if (source_ == Source::kSimplified) {
    FitToSurface(target_, neighbors_, {StepFor(lattice_distortion), distortion_per_bit_}, rounds, &mesh_);
  }
  model_ = target_.ModelAt(mesh_, neighbors_);
  if (source_ == Source::kSimplified) fit_distortion_ = Distortion(model_);
}

StatusOr<ZeroLevelCandidate::Coding> ZeroLevelCandidate::Code(double step, int rounds, CodingEffort effort,
                                                                    BaseCoding base_coding) const {
  Coding coding;
  // Draco rounds in floats, which hold no finer lattice. And decoders compute in floats.
  constexpr double kFinest = 1.0 / (1 << 21);
  coding.step = static_cast<double>(static_cast<float>(std::max(step, kFinest * target_.diagonal())));
  const RateModel rate{coding.step, distortion_per_bit_};
  coding.lattice = FitToLattice(mesh_, model_, neighbors_, rate);
  DistanceModel model = target_.ModelAt(coding.lattice.ToMesh(), neighbors_);
  for (int i = 1; i < rounds && is_small_; ++i) {
    LatticeMesh again = FitToLattice(coding.lattice.ToMesh(), model, neighbors_, rate);
    DistanceModel model_again = target_.ModelAt(again.ToMesh(), neighbors_);
    coding.lattice = std::move(again);
    model = std::move(model_again);
  }
  coding.distortion = Distortion(model);
  LACERTA_ASSIGN_OR_RETURN(coding.coded, EncodeLatticeMesh(coding.lattice, effort, base_coding));
  coding.bytes = coding.coded.stream.size();
  return coding;
}

}  // namespace lacerta
