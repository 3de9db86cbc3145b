#include "draco/rate_control.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace lacerta {
namespace {

// Base sizes tried: a ladder, walked from where streams of that quality have their base on typical surfaces.
constexpr double kFirstRung = 48, kRungRatio = 1.5;

uint32_t RungSize(int rung) { return static_cast<uint32_t>(std::lround(kFirstRung * std::pow(kRungRatio, rung))); }

int RungOfSize(double size) {
  return std::max(0, static_cast<int>(std::lround(std::log(size / kFirstRung) / std::log(kRungRatio))));
}

int TypicalRung(const ResolvedTarget& target, double num_input_vertices) {
  const double bits_per_vertex = 8 * target.bytes / num_input_vertices;
  const double psnr = target.is_rate ? 62 + 6 * std::log2(1 + 4 * bits_per_vertex) : target.psnr;
  return RungOfSize(180 * std::pow(2.0, (psnr - 70) / 7));
}

// A base size that was tried.
struct Rung {
  std::unique_ptr<NormalMeshCandidate> candidate;
  std::unique_ptr<CandidateSearch> search;
  double remesh_psnr = 0;
  double score = std::numeric_limits<double>::infinity();  // of CandidateSearch::Score; infinite: cannot reach the target
};

class Ladder {
 public:
  Ladder(const InputSurface& surface, const CollapseHistory& history, const SurfaceDistanceMeter& meter,
         const ResolvedTarget& target, EncodeMode mode)
      : surface_(surface), history_(history), meter_(meter), target_(target), mode_(mode) {
    const auto num_input = static_cast<double>(surface.mesh().positions.size());
    constexpr double kLargestBase = 0.5;  // of the input's vertices
    last_ = RungOfSize(std::max(kFirstRung, kLargestBase * num_input));
    first_ = std::min(TypicalRung(target, num_input), last_);
  }

  // Scores the rungs around the typical one, then goes on while the best one is the last tried on its side.
  StatusOr<Rung*> FindBest(const std::function<void(double, const char*)>& progress) {
    LACERTA_RETURN_IF_ERROR(Visit({first_ - 1, first_, first_ + 1}));
    for (;;) {
      if (progress) progress(std::min(0.75, 0.1 + 0.1 * static_cast<double>(rungs_.size())), "choosing the base mesh");
      const int best = Best();
      const int lowest = rungs_.begin()->first, highest = rungs_.rbegin()->first;
      const bool unreached = !std::isfinite(rungs_[best].score);
      if ((best == highest || unreached) && highest < last_) {
        LACERTA_RETURN_IF_ERROR(Visit({highest + 1, highest + 2}));
      } else if (best == lowest && lowest > 0 && !unreached) {
        LACERTA_RETURN_IF_ERROR(Visit({lowest - 1, lowest - 2}));
      } else {
        return &rungs_[best];
      }
    }
  }

 private:
  // Makes and scores the given rungs, in parallel; those off the ladder are left out.
  Status Visit(const std::vector<int>& numbers) {
    std::vector<std::pair<int, Rung>> made;
    for (const int r : numbers) {
      if (r >= 0 && r <= last_) made.emplace_back(r, Rung());
    }
    std::vector<Status> status(made.size());
    tbb::parallel_for(size_t{0}, made.size(), [&](size_t i) { status[i] = Make(made[i].first, &made[i].second); });
    for (const Status& s : status) LACERTA_RETURN_IF_ERROR(s);
    for (auto& [r, rung] : made) rungs_[r] = std::move(rung);
    return Status();
  }

  Status Make(int number, Rung* rung) const {
    LACERTA_ASSIGN_OR_RETURN(NormalMeshCandidate candidate, NormalMeshCandidate::Create(surface_, history_, RungSize(number)));
    rung->candidate = std::make_unique<NormalMeshCandidate>(std::move(candidate));
    SurfaceDistanceOptions rough;
    rough.num_samples = 30'000;
    rough.max_at_vertices = false;
    LACERTA_ASSIGN_OR_RETURN(const SurfaceDistance distance, meter_.Measure(rung->candidate->RemeshedSurface(), rough));
    rung->remesh_psnr = Psnr(distance.Rms(), meter_.diagonal());
    rung->search = std::make_unique<CandidateSearch>(*rung->candidate, rung->remesh_psnr, meter_, target_, mode_);
    constexpr double kHeadroom = 0.5;  // dB that quantization takes at least
    if (!target_.is_rate && rung->remesh_psnr < target_.psnr + kHeadroom) return Status();
    LACERTA_ASSIGN_OR_RETURN(rung->score, rung->search->Score());
    return Status();
  }

  // The rung with the lowest score, or, where none reaches the target, with the best remesh.
  int Best() const {
    const auto better = [](const auto& a, const auto& b) {
      if (std::isfinite(a.second.score) || std::isfinite(b.second.score)) return a.second.score < b.second.score;
      return a.second.remesh_psnr > b.second.remesh_psnr;
    };
    return std::min_element(rungs_.begin(), rungs_.end(), better)->first;
  }

  const InputSurface& surface_;
  const CollapseHistory& history_;
  const SurfaceDistanceMeter& meter_;
  const ResolvedTarget& target_;
  const EncodeMode mode_;
  int first_, last_;
  std::map<int, Rung> rungs_;
};

}  // namespace

StatusOr<ResolvedTarget> ResolveTarget(const EncodeTarget& target, uint64_t num_input_vertices) {
  const auto check = [&](double low, double high, const char* what) {
    if (target.value >= low && target.value <= high) return Status();
    return InvalidArgument("target of " + std::to_string(target.value) + " " + what + " is not between " +
                           std::to_string(low) + " and " + std::to_string(high));
  };
  switch (target.kind) {
    case EncodeTarget::Kind::kBytes:
      LACERTA_RETURN_IF_ERROR(check(100, 1e12, "bytes"));
      return ResolvedTarget{true, target.value, 0};
    case EncodeTarget::Kind::kBitsPerVertex:
      LACERTA_RETURN_IF_ERROR(check(1e-3, 96, "bits per vertex"));
      return ResolvedTarget{true, target.value * static_cast<double>(num_input_vertices) / 8, 0};
    case EncodeTarget::Kind::kPsnr:
      LACERTA_RETURN_IF_ERROR(check(20, 140, "dB"));
      return ResolvedTarget{false, 0, target.value};
    case EncodeTarget::Kind::kError:
      LACERTA_RETURN_IF_ERROR(check(1e-7, 0.1, "of the diagonal"));
      return ResolvedTarget{false, 0, -20 * std::log10(target.value)};
  }
  return InvalidArgument("unknown kind of target");
}

StatusOr<ChosenStream> CodeAtTarget(const InputSurface& surface, const CollapseHistory& history,
                                    const SurfaceDistanceMeter& meter, const ResolvedTarget& target, EncodeMode mode,
                                    const std::function<void(double, const char*)>& progress) {
  Ladder ladder(surface, history, meter, target, mode);
  LACERTA_ASSIGN_OR_RETURN(Rung* const best, ladder.FindBest(progress));
  if (progress) progress(0.8, "meeting the target");
  ChosenStream result;
  LACERTA_ASSIGN_OR_RETURN(result.measured, best->search->Meet());
  result.remesh_psnr = best->remesh_psnr;
  result.normal_share = NormalShare(best->candidate->normal_mesh());
  return result;
}

}  // namespace lacerta
