#include "draco/rate_control.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "draco/fitted_remesh.h"
#include "draco/for_each_candidate.h"

namespace lacerta {
namespace {

// Base sizes tried: a ladder, walked from where streams of that quality have their base on typical surfaces.
constexpr double kFirstRung = 48;

// A base size that was tried.
struct Rung {
  std::optional<FittedRemesh> remesh;              // until there is the candidate
  std::unique_ptr<NormalMeshCandidate> candidate;  // null once it was let go of
  std::unique_ptr<CandidateSearch> search;
  Status status;  // why there is no candidate, if so
  double remesh_psnr = 0;
  double score = std::numeric_limits<double>::infinity();  // of CandidateSearch::Score; infinite: cannot reach the target
  SearchStart start;                                       // of CandidateSearch::start, where there is a score
};

// Candidates that are taken to the target in all. No more are kept than are taken at a time: each is as large as the input.
constexpr size_t kMost = 4;
// What the bytes of the stream in the end are at least: against those of the best score so far, or of all, and for a vertex of the base.
constexpr double kLeastShare = 0.45, kLeastShareAtEnd = 0.85, kFewestBytesPerVertex = 1.0;
// What a PSNR costs, about: ln(bytes) per dB.
constexpr double kLogBytesPerDecibel = 0.11;

class Ladder {
 public:
  Ladder(const RefinableSurface& surface, const SurfaceDistanceMeter& meter, const ResolvedTarget& target, EncodeMode mode, const SearchEffort& effort)
      : surface_(surface), meter_(meter), target_(target), mode_(mode), effort_(effort) {
    num_input_ = static_cast<double>(surface.surface.mesh().positions.size());
    constexpr double kLargestBase = 0.5;  // of the input's vertices
    first_ = RungOfSize(num_input_ - static_cast<double>(surface.history.num_collapses()));
    last_ = std::max(first_, RungOfSize(std::max(kFirstRung, kLargestBase * num_input_)));
  }

  // Scores the rungs around the typical one and goes on until one on either side of the best is known to be much worse, or two to be
  // worse: one alone may be a fluke of its simplification. Returns the most promising rungs, best first; at least one.
  StatusOr<std::vector<int>> FindBest(const std::function<void(double, const char*)>& progress, const std::function<bool(double)>& is_outdone) {
    const int first = std::clamp(RungOfSize(TypicalBase(TypicalPsnr(target_, num_input_))), first_, last_);
    const Status outdone = Unsupported("a stream without levels is much smaller");
    if (is_outdone(LeastBytesFrom(std::max(first - 1, first_)))) return outdone;
    Visit(effort_.enough_sizes == 1 ? std::vector<int>{first} : std::vector<int>{first - 1, first, first + 1}, {});
    for (;;) {
      if (progress) progress(std::min(0.75, 0.1 + 0.08 * static_cast<double>(rungs_.size())), "choosing the base mesh");
      const std::vector<int> ranking = Ranking();
      for (size_t i = effort_.at_a_time; i < ranking.size(); ++i) LetGo(&rungs_[ranking[i]]);
      const int best = ranking.front(), highest = rungs_.rbegin()->first;
      const bool is_scored = std::isfinite(rungs_[best].score);
      std::vector<int> next, likely;  // likely: due after them, but where they are much worse
      if (is_scored) {
        for (const int r : {best - 1, best + 1}) {
          const int beyond = 2 * r - best;
          if (IsMissing(r)) {
            next.push_back(r);
            likely.push_back(beyond);
          } else if (IsMissing(beyond) && rungs_.count(r) > 0 && !IsMuchWorse(rungs_[r], rungs_[best])) {
            next.push_back(beyond);
          }
        }
      } else if (highest < last_) {  // nothing reaches the target yet: larger bases
        next = {highest + 1, highest + 2};
      }
      const bool is_enough = next.empty() || (rungs_.size() >= effort_.enough_sizes && is_scored);
      const double least_share = is_enough ? kLeastShareAtEnd : kLeastShare;
      // Where no base reaches the target any stream without levels that does outdoes them all.
      const double without_score = is_enough ? std::numeric_limits<double>::infinity() : LeastBytesFrom(highest + 1);
      if (is_outdone(is_scored ? least_share * std::exp(rungs_[best].score) : without_score)) return outdone;
      if (is_enough) {
        std::vector<int> result;
        for (const int r : ranking) {
          if (rungs_[r].status.ok()) result.push_back(r);
        }
        made_.clear();
        if (result.empty()) return rungs_[best].status.WithContext("no base mesh can be coded");
        return result;
      }
      Visit(next, next.size() == 1 ? likely : std::vector<int>());
    }
  }

  // Takes a rung of FindBest, with all its levels, to the target. Several may be in parallel; afterwards it is let go of.
  StatusOr<ChosenStream> Meet(int number) {
    Rung& rung = rungs_.at(number);
    if (!rung.candidate) {
      LACERTA_RETURN_IF_ERROR(Remesh(number, &rung));
      MakeCandidate(&rung);
      if (std::isfinite(rung.score)) rung.search->BeginAt(rung.start);
    }
    LACERTA_ASSIGN_OR_RETURN(MeasuredStream measured, rung.search->Meet());
    ChosenStream chosen{std::move(measured), rung.remesh_psnr, NormalShare(rung.candidate->normal_mesh())};
    LetGo(&rung);
    return chosen;
  }

 private:
  uint32_t RungSize(int rung) const { return static_cast<uint32_t>(std::lround(kFirstRung * std::pow(effort_.size_ratio, rung))); }

  int RungOfSize(double size) const {
    return std::max(0, static_cast<int>(std::lround(std::log(size / kFirstRung) / std::log(effort_.size_ratio))));
  }

  // Of streams with a base of that rung or a larger one. Vertices of bases usually take three bytes and more.
  double LeastBytesFrom(int rung) const { return kFewestBytesPerVertex * RungSize(rung); }

  // Whether rung a scores so much worse than b that it hardly is a fluke: neighbouring rungs are rarely further from the smooth curve
  // of all rungs.
  bool IsMuchWorse(const Rung& a, const Rung& b) const { return a.score >= b.score + effort_.much_worse * (target_.is_rate ? 10 : 1); }

  static void LetGo(Rung* rung) {
    rung->search.reset();
    rung->candidate.reset();
  }

  bool IsMissing(int r) const { return r >= first_ && r <= last_ && rungs_.count(r) == 0; }

  // Where to begin the search at a rung: where the nearest one that was scored ended.
  std::optional<SearchStart> StartOf(int number) const {
    std::optional<SearchStart> start;
    int least = std::numeric_limits<int>::max();
    for (const auto& [r, rung] : rungs_) {
      if (!std::isfinite(rung.score) || std::abs(r - number) >= least) continue;
      least = std::abs(r - number);
      start = rung.start;
    }
    return start;
  }

  // Makes and scores the given rungs; those off the ladder are left out. A base that fails costs only itself. likely: to be visited later,
  // made now where there are threads for it. What is found does not depend on it.
  void Visit(const std::vector<int>& numbers, const std::vector<int>& likely) {
    struct Visited {
      int number;
      bool is_scored;
      Rung rung;
    };
    std::vector<Visited> visited;
    for (const int r : numbers) {
      if (r < first_ || r > last_) continue;
      const auto made = made_.extract(r);
      visited.push_back({r, true, made.empty() ? Rung() : std::move(made.mapped())});
    }
    for (const int r : likely) {
      if (IsMissing(r) && made_.count(r) == 0 && AreInParallel(num_input_)) visited.push_back({r, false, Rung()});
    }
    ForEachCandidate(num_input_, visited.size(), [&](size_t i) {
      Rung& rung = visited[i].rung;
      if (!rung.remesh && rung.status.ok()) rung.status = Remesh(visited[i].number, &rung);
      if (visited[i].is_scored && rung.status.ok()) rung.status = Score(visited[i].number, &rung);
    });
    for (Visited& v : visited) (v.is_scored ? rungs_ : made_)[v.number] = std::move(v.rung);
  }

  Status Remesh(int number, Rung* rung) const {
    LACERTA_ASSIGN_OR_RETURN(rung->remesh, RemeshForPsnr(surface_, RungSize(number), TypicalPsnr(target_, num_input_), target_.base_coding, meter_));
    return Status();
  }

  void MakeCandidate(Rung* rung) const {
    rung->remesh_psnr = rung->remesh->psnr;
    rung->candidate = std::make_unique<NormalMeshCandidate>(std::move(rung->remesh->base), std::move(rung->remesh->mesh));
    rung->remesh.reset();
    rung->search = std::make_unique<CandidateSearch>(*rung->candidate, rung->remesh_psnr, meter_, target_, mode_, effort_);
  }

  Status Score(int number, Rung* rung) const {
    MakeCandidate(rung);
    constexpr double kHeadroom = 0.5;  // dB that quantization takes at least
    if (const std::optional<SearchStart> start = StartOf(number)) rung->search->BeginAt(*start);
    if (!target_.is_rate && rung->remesh_psnr < target_.psnr + kHeadroom) return Status();
    LACERTA_ASSIGN_OR_RETURN(rung->score, rung->search->Score());
    if (target_.quality_layers > 1) {  // a large base comes before all else: it costs prefixes what it saves at the end
      constexpr double kPrefixCost = 0.03;  // of ln(bytes), per rung
      rung->score += kPrefixCost * number * (target_.is_rate ? 1 / kLogBytesPerDecibel : 1.0);
    }
    rung->start = rung->search->start();
    return Status();
  }

  // Rungs by score, the lowest first, or, where none reaches the target, by the quality of the remesh.
  std::vector<int> Ranking() const {
    std::vector<int> numbers;
    for (const auto& [r, rung] : rungs_) numbers.push_back(r);
    std::stable_sort(numbers.begin(), numbers.end(), [&](int a, int b) {
      const Rung &x = rungs_.at(a), &y = rungs_.at(b);
      if (std::isfinite(x.score) || std::isfinite(y.score)) return x.score < y.score;
      return x.remesh_psnr > y.remesh_psnr;
    });
    return numbers;
  }

  const RefinableSurface& surface_;
  const SurfaceDistanceMeter& meter_;
  const ResolvedTarget& target_;
  const EncodeMode mode_;
  const SearchEffort effort_;
  double num_input_;
  int first_, last_;  // rungs: of the coarsest base that the history has, and of the largest worth trying
  std::map<int, Rung> rungs_, made_;  // made_: not yet scored
};

}  // namespace

bool IsBetter(const Outcome& a, const Outcome& b, const ResolvedTarget& target) {
  if (a.meets_target != b.meets_target) return a.meets_target;
  return target.is_rate == a.meets_target ? a.psnr > b.psnr : a.bytes < b.bytes;
}

double TypicalBase(double psnr) { return 200 * std::pow(2.0, (psnr - 70) / 6); }

double TypicalPsnr(const ResolvedTarget& target, double num_input_vertices) {
  if (!target.is_rate) return target.psnr;
  const double bits_per_vertex = 8 * target.bytes / num_input_vertices;
  return 62 + 6 * std::log2(1 + 4 * bits_per_vertex);
}

StatusOr<ResolvedTarget> ResolveTarget(const EncodeTarget& target, uint64_t num_input_vertices, double diagonal) {
  const auto shown = [](double value) {
    std::array<char, 32> text;
    std::snprintf(text.data(), text.size(), "%g", value);
    return std::string(text.data());
  };
  const auto check = [&](double low, double high, const char* what) {
    if (target.value >= low && target.value <= high) return Status();
    return InvalidArgument("target of " + shown(target.value) + " " + what + " is not between " + shown(low) + " and " + shown(high));
  };
  constexpr double kLeastError = 1e-7, kLargestError = 0.1;  // shares of the diagonal
  switch (target.kind) {
    case EncodeTarget::Kind::kBytes:
      LACERTA_RETURN_IF_ERROR(check(100, 1e12, "bytes"));
      return ResolvedTarget{true, target.value, 0, BaseCoding::kStock};
    case EncodeTarget::Kind::kBitsPerVertex:
      LACERTA_RETURN_IF_ERROR(check(1e-3, 96, "bits per vertex"));
      return ResolvedTarget{true, target.value * static_cast<double>(num_input_vertices) / 8, 0, BaseCoding::kStock};
    case EncodeTarget::Kind::kPsnr:
      LACERTA_RETURN_IF_ERROR(check(20, 140, "dB"));
      return ResolvedTarget{false, 0, target.value, BaseCoding::kStock};
    case EncodeTarget::Kind::kError:
      LACERTA_RETURN_IF_ERROR(check(kLeastError, kLargestError, "of the diagonal"));
      return ResolvedTarget{false, 0, -20 * std::log10(target.value), BaseCoding::kStock};
    case EncodeTarget::Kind::kDistance:
      LACERTA_RETURN_IF_ERROR(check(kLeastError * diagonal, kLargestError * diagonal, "units of a mesh of this size"));
      return ResolvedTarget{false, 0, Psnr(target.value, diagonal), BaseCoding::kStock};
  }
  return InvalidArgument("unknown kind of target");
}

StatusOr<ChosenStream> CodeAtTarget(const RefinableSurface& surface, const SurfaceDistanceMeter& meter, const ResolvedTarget& target, EncodeMode mode,
                                    const std::function<void(double, const char*)>& progress, const SearchEffort& effort,
                                    const std::function<bool(double)>& is_outdone) {
  Ladder ladder(surface, meter, target, mode, effort);
  const bool may_be_outdone = is_outdone && !target.is_rate;
  LACERTA_ASSIGN_OR_RETURN(const std::vector<int> rungs, ladder.FindBest(progress, may_be_outdone ? is_outdone : [](double) { return false; }));
  if (progress) progress(0.8, "meeting the target");
  // Scores are estimates: a few candidates at a time are taken to the target until one meets it, and the better of them is kept.
  StatusOr<ChosenStream> best = InternalError("no base was taken to the target");
  const size_t at_a_time = target.quality_layers > 1 ? 1 : effort.at_a_time;  // with layers the fewest bytes are not all that counts
  for (size_t first = 0; first < std::min(kMost, rungs.size()); first += at_a_time) {
    const size_t count = std::min(at_a_time, rungs.size() - first);
    std::vector<StatusOr<ChosenStream>> met(count, InternalError("not tried"));
    ForEachCandidate(static_cast<double>(surface.surface.mesh().positions.size()), count,
                     [&](size_t i) { met[i] = ladder.Meet(rungs[first + i]); });
    for (StatusOr<ChosenStream>& tried : met) {  // one that fails costs only itself
      const bool is_better = !best.ok() || (tried.ok() && IsBetter(OutcomeOf(tried.value().measured), OutcomeOf(best.value().measured), target));
      if (is_better) best = std::move(tried);
    }
    if (best.ok() && best.value().measured.meets_target) break;
  }
  return best;
}

}  // namespace lacerta
