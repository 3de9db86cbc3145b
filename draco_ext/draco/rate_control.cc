#include "draco/rate_control.h"

#include <algorithm>
#include <array>
#include <atomic>
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
#include "draco/usual_base.h"

namespace lacerta {
namespace {

// Base sizes tried: the rungs of a ladder, walked in strides from where streams of that quality usually have their base.
constexpr double kFirstRung = 48 / (1.5 * 1.5 * 1.5), kStrideRatio = 1.5;
constexpr int kStride = 2;  // rungs
constexpr double kUsualSize = 48;  // that every surface may have and where none begins below: streams on smaller bases may leap over their target

// A base that was tried.
struct TriedBase {
  std::unique_ptr<NormalMeshCandidate> candidate;  // null once it was let go of
  std::unique_ptr<CandidateSearch> search;
  Status status;  // why there is no candidate, if so
  double remesh_psnr = 0;
  std::unique_ptr<PiercedBase> pierced;  // as of FittedRemesh
  double score = std::numeric_limits<double>::infinity();  // of CandidateSearch::Score; infinite: cannot reach the target
  SearchStart start;                                       // of CandidateSearch::start, where there is a score
};

// Candidates that are taken to the target in all. No more are kept than are taken at a time: each is as large as the input.
constexpr size_t kMost = 4;
// dB: a remesh that is nearer to the target than that costs bytes and gets one level more: before it is taken to the target, and to be scored.
constexpr double kComfort = 12, kLittleComfort = 6;
// What the bytes of the stream in the end are at least: for a vertex of the base, against those of the best score of all, and against those of the
// best so far, where neighbors on both sides are no better, where only larger bases are missing, and where smaller ones are.
constexpr double kFewestBytesPerVertex = 1.8, kLeastShareAtEnd = 0.85, kLeastShareBetween = 0.8, kLeastShareOfLargest = 0.7, kLeastShare = 0.45;
constexpr double kUsualShareAtEnd = 0.93;  // of the bytes of the best score (0.94 to 0.99 at the default, 0.86 to 0.99 at --effort fast)
// What a PSNR costs, about: ln(bytes) per dB.
constexpr double kLogBytesPerDecibel = 0.11;

// The most promising bases, best first; at least one.
struct BestBases {
  std::vector<int> rungs;
  double score;  // of the first, in bytes, or the target's; infinite where no base reaches the target
};

Status Outdone() { return Unsupported("a stream without levels is much smaller"); }

class Ladder {
 public:
  Ladder(const RefinableSurface& surface, const SurfaceDistanceMeter& meter, const ResolvedTarget& target, EncodeMode mode, const SearchEffort& effort)
      : surface_(surface), meter_(meter), target_(target), mode_(mode), effort_(effort) {
    num_input_ = static_cast<double>(surface.surface.mesh().positions.size());
    constexpr double kLargestShare = 0.5;  // of the input's vertices
    first_ = RungOfSize(num_input_ - static_cast<double>(surface.history.num_collapses()));
    last_ = std::max(first_, RungOfSize(std::max(kUsualSize, kLargestShare * num_input_)));
  }

  // Scores the usual rung and the next and goes on until one on either side of the best is known to be much worse, or two to be
  // worse: one alone may be a fluke of its base. Fails where the rival, if there is one, outdoes it on the way.
  StatusOr<BestBases> FindBest(const std::function<void(double, const char*)>& progress, const RivalStream* rival) {
    const auto is_outdone = [&](double bytes) { return rival != nullptr && rival->takes_fewer_than(bytes); };
    const int first = UsualRung();
    if (is_outdone(LeastBytesFrom(std::max(first - kStride, first_)))) return Outdone();
    Visit(effort_.enough_bases == 1 ? std::vector<int>{first} : std::vector<int>{first, first + kStride});
    for (;;) {
      if (progress) progress(std::min(0.75, 0.1 + 0.08 * static_cast<double>(tried_.size())), "choosing the base mesh");
      const std::vector<int> ranking = Ranking();
      for (size_t i = effort_.at_a_time; i < ranking.size(); ++i) LetGo(&tried_[ranking[i]]);
      const int best = ranking.front();
      const bool is_scored = IsScored(best);
      const std::vector<int> next = NextRungs(best);
      const bool is_enough = next.empty() || (tried_.size() >= effort_.enough_bases && is_scored);
      if (is_enough) {
        LACERTA_ASSIGN_OR_RETURN(std::vector<int> bases, Promising(ranking));
        return BestBases{std::move(bases), target_.is_rate ? target_.bytes : std::exp(tried_[best].score)};
      }
      if (is_outdone(is_scored ? LeastShare(best) * std::exp(tried_.at(best).score) : LeastBytesFrom(HighestRung() + kStride))) return Outdone();
      Visit(next);
    }
  }

  // After FindBest: scores the sizes halfway to the neighbors of the best. Returns those that are promising beside all that were tried, best first.
  std::vector<int> FindHalfway() {
    const int best = Ranking().front();
    const std::array<int, 2> halfway = {best - kStride / 2, best + kStride / 2};
    Visit({halfway.begin(), halfway.end()});
    const std::vector<int> ranking = Ranking();
    std::vector<int> result;
    for (const int r : ranking) {
      if (std::find(halfway.begin(), halfway.end(), r) == halfway.end()) continue;
      if (result.size() < effort_.at_a_time && tried_.at(r).status.ok() && !IsHopeless(r, ranking.front())) {
        result.push_back(r);
      } else {
        LetGo(&tried_.at(r));
      }
    }
    return result;
  }

  // Takes a base of FindBest, with all its levels, to the target. Several may be in parallel; afterwards it is let go of.
  StatusOr<ChosenStream> Meet(int rung) {
    TriedBase& base = tried_.at(rung);
    if (!base.candidate || (base.pierced && base.remesh_psnr < TypicalPsnr(target_, num_input_) + kComfort)) {
      base.search.reset();
      base.candidate.reset();
      LACERTA_RETURN_IF_ERROR(Remesh(rung, kComfort, &base));
      if (std::isfinite(base.score)) base.search->BeginAt(base.start);
    }
    base.pierced.reset();  // as large as what comes now
    LACERTA_ASSIGN_OR_RETURN(MeasuredStream measured, base.search->Meet());
    ChosenStream chosen{std::move(measured), base.remesh_psnr, NormalShare(base.candidate->normal_mesh())};
    LetGo(&base);
    return chosen;
  }

  // Whether the scores leave little hope that base a takes fewer bytes than b.
  bool IsHopeless(int a, int b) const { return IsWorse(a, b, effort_.hopeless); }

 private:
  uint32_t RungSize(int rung) const { return static_cast<uint32_t>(std::lround(kFirstRung * std::pow(kStrideRatio, static_cast<double>(rung) / kStride))); }

  int RungOfSize(double size) const {
    return std::max(0, kStride * static_cast<int>(std::lround(std::log(size / kFirstRung) / std::log(kStrideRatio))));
  }

  // Where streams of that quality usually have their base: the smallest that is near enough to the surface by itself and has little of it askew.
  int UsualRung() const {
    constexpr int kMostLarger = 3 * kStride;  // noise is askew to any base
    const double psnr = TypicalPsnr(target_, num_input_), enough = UsualBasePsnr(psnr), most_askew = UsualAskewShare(psnr);
    int low = std::clamp(RungOfSize(kUsualSize), first_, last_), high = last_;
    while (low < high) {
      const int middle = low + (high - low) / (2 * kStride) * kStride;
      if (BasePsnr(surface_, RungSize(middle), meter_) >= enough) {
        high = middle;
      } else {
        low = middle + kStride;
      }
    }
    int rung = low;
    while (rung < std::min(last_, low + kMostLarger) && AskewShare(surface_, RungSize(rung)) > most_askew) rung += kStride;
    return rung;
  }

  // Of streams with a base of that rung or a larger one. Vertices of bases usually take three bytes and more.
  double LeastBytesFrom(int rung) const { return kFewestBytesPerVertex * RungSize(rung); }

  // Of the bytes of the best so far those that the stream takes in the end.
  double LeastShare(int best) const {
    if (IsMissing(best - kStride)) return kLeastShare;
    return IsMissing(best + kStride) ? kLeastShareOfLargest : kLeastShareBetween;
  }

  // What a share of the bytes is in units of scores.
  double ScoreOfShare(double share) const { return target_.is_rate ? share / kLogBytesPerDecibel : share; }

  // Whether a scores worse than b by that share of the bytes. By much_worse it hardly is a fluke: neighboring rungs are rarely farther from the
  // smooth curve of all rungs.
  bool IsWorse(int a, int b, double share) const { return tried_.at(a).score >= tried_.at(b).score + ScoreOfShare(share); }

  static void LetGo(TriedBase* base) {
    base->search.reset();
    base->candidate.reset();
    base->pierced.reset();
  }

  bool IsOnLadder(int rung) const { return rung >= first_ && rung <= last_; }
  bool IsMissing(int rung) const { return IsOnLadder(rung) && tried_.count(rung) == 0; }

  bool IsScored(int rung) const { return std::isfinite(tried_.at(rung).score); }
  int HighestRung() const { return tried_.rbegin()->first; }

  // What to visit next; nothing where enough is known.
  std::vector<int> NextRungs(int best) const {
    if (IsScored(best)) return Beside(best);
    const int highest = HighestRung();  // nothing reaches the target yet: larger bases
    return highest < last_ ? std::vector<int>{highest + kStride, highest + 2 * kStride} : std::vector<int>();
  }

  // Whether its remesh is so far off that it, and not the size of the base, may be to blame for a bad score.
  bool IsFarOff(int rung) const { return tried_.at(rung).remesh_psnr < TypicalPsnr(target_, num_input_) + kLittleComfort; }

  // Rungs on either side of the best.
  std::vector<int> Beside(int best) const {
    std::vector<int> result;
    for (const int side : {-kStride, kStride}) {
      const int neighbor = best + side, beyond = best + 2 * side;
      if (IsMissing(neighbor)) {
        result.push_back(neighbor);
      } else if (IsMissing(beyond) && tried_.count(neighbor) > 0 && (!IsWorse(neighbor, best, effort_.much_worse) || (side > 0 && IsFarOff(neighbor)))) {
        result.push_back(beyond);
      }
    }
    return result;
  }

  // Where to begin the search at a base: where that of the nearest size that was scored ended.
  std::optional<SearchStart> StartOf(int rung) const {
    std::optional<SearchStart> start;
    int least = std::numeric_limits<int>::max();
    for (const auto& [r, base] : tried_) {
      if (!std::isfinite(base.score) || std::abs(r - rung) >= least) continue;
      least = std::abs(r - rung);
      start = base.start;
    }
    return start;
  }

  // Makes and scores the given bases; those off the ladder and those that were tried are left out. A base that fails costs only itself.
  void Visit(std::vector<int> rungs) {
    rungs.erase(std::remove_if(rungs.begin(), rungs.end(), [&](int r) { return !IsMissing(r); }), rungs.end());
    std::vector<TriedBase> visited(rungs.size());
    const double comfort = effort_.enough_bases == 1 ? kComfort : kLittleComfort;  // a single one is taken to the target anyway
    ForEachCandidate(num_input_, rungs.size(), [&](size_t i) {
      visited[i].status = Remesh(rungs[i], comfort, &visited[i]);
      if (visited[i].status.ok()) visited[i].status = Score(rungs[i], &visited[i]);
    });
    for (size_t i = 0; i < rungs.size(); ++i) tried_[rungs[i]] = std::move(visited[i]);
  }

  // Makes the candidate, with a search of its own.
  Status Remesh(int rung, double comfort, TriedBase* base) const {
    const double psnr = TypicalPsnr(target_, num_input_) + comfort;
    LACERTA_ASSIGN_OR_RETURN(FittedRemesh remesh, RemeshForPsnr(surface_, RungSize(rung), psnr, target_.base_coding, meter_, std::move(base->pierced)));
    base->remesh_psnr = remesh.psnr;
    base->pierced = std::move(remesh.pierced);
    base->candidate = std::make_unique<NormalMeshCandidate>(std::move(remesh.base), std::move(remesh.mesh));
    base->search = std::make_unique<CandidateSearch>(*base->candidate, base->remesh_psnr, meter_, target_, mode_, effort_);
    return Status();
  }

  Status Score(int rung, TriedBase* base) const {
    constexpr double kHeadroom = 0.5;  // dB that quantization takes at least
    if (const std::optional<SearchStart> start = StartOf(rung)) base->search->BeginAt(*start);
    if (!target_.is_rate && base->remesh_psnr < target_.psnr + kHeadroom) return Status();
    LACERTA_ASSIGN_OR_RETURN(base->score, base->search->Score());
    if (target_.quality_layers > 1) {  // a large base comes before all else: it costs prefixes what it saves at the end
      constexpr double kPrefixCost = 0.015;  // of ln(bytes), per rung
      base->score += ScoreOfShare(kPrefixCost * rung);
    }
    base->start = base->search->start();
    return Status();
  }

  // Bases by score, the lowest first, or, where none reaches the target, by the quality of the remesh.
  std::vector<int> Ranking() const {
    std::vector<int> rungs;
    for (const auto& [rung, base] : tried_) rungs.push_back(rung);
    std::stable_sort(rungs.begin(), rungs.end(), [&](int a, int b) {
      const TriedBase &x = tried_.at(a), &y = tried_.at(b);
      if (std::isfinite(x.score) || std::isfinite(y.score)) return x.score < y.score;
      return x.remesh_psnr > y.remesh_psnr;
    });
    return rungs;
  }

  // Of a ranking those that can be coded.
  StatusOr<std::vector<int>> Promising(const std::vector<int>& ranking) const {
    std::vector<int> result;
    for (const int r : ranking) {
      if (tried_.at(r).status.ok()) result.push_back(r);
    }
    if (result.empty()) return tried_.at(ranking.front()).status.WithContext("no base mesh can be coded");
    return result;
  }

  const RefinableSurface& surface_;
  const SurfaceDistanceMeter& meter_;
  const ResolvedTarget& target_;
  const EncodeMode mode_;
  const SearchEffort effort_;
  double num_input_;
  int first_, last_;  // rungs of the coarsest base that there is, and of the largest one worth trying
  std::map<int, TriedBase> tried_;  // by rung
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

StatusOr<ChosenStream> CodeAtTarget(const RefinableSurface& surface, const SurfaceDistanceMeter& meter, const ResolvedTarget& target,
                                    EncodeMode mode, const std::function<void(double, const char*)>& progress, const SearchEffort& effort,
                                    const RivalStream* rival) {
  Ladder ladder(surface, meter, target, mode, effort);
  const RivalStream* const outdoing = target.is_rate ? nullptr : rival;  // at a rate all take as many bytes
  LACERTA_ASSIGN_OR_RETURN(const BestBases bases, ladder.FindBest(progress, outdoing));
  if (progress) progress(0.8, "meeting the target");
  StatusOr<ChosenStream> best = InternalError("no base was taken to the target");
  const auto num_input = static_cast<double>(surface.surface.mesh().positions.size());
  const auto meet = [&](Span<const int> rungs) {
    std::vector<StatusOr<ChosenStream>> met(rungs.size(), InternalError("not tried"));
    ForEachCandidate(num_input, met.size(), [&](size_t i) { met[i] = ladder.Meet(rungs[i]); });
    for (StatusOr<ChosenStream>& tried : met) {  // one that fails costs only itself
      const bool is_better = !best.ok() || (tried.ok() && IsBetter(OutcomeOf(tried.value().measured), OutcomeOf(best.value().measured), target));
      if (is_better) best = std::move(tried);
    }
  };
  // Scores are estimates: a few candidates at a time are taken to the target until one meets it, and the better of them is kept.
  const auto meet_best = [&] {
    const Span<const int> rungs = bases.rungs;
    const size_t at_a_time = target.quality_layers > 1 ? 1 : effort.at_a_time;  // with layers the fewest bytes are not all that counts
    for (size_t first = 0; first < std::min(kMost, rungs.size());) {
      size_t count = 1;
      while (count < at_a_time && first + count < rungs.size() && !ladder.IsHopeless(rungs[first + count], rungs[first])) ++count;
      meet(rungs.Subspan(first).First(count));
      if (best.ok() && best.value().measured.meets_target) break;
      first += count;
    }
    if (effort.every_size) meet(ladder.FindHalfway());
  };
  // Both take a while, mostly on one thread each: they are done at once, in vain for the bases where these are outdone, unless that is likely.
  const bool is_in_reach = std::isfinite(bases.score);
  const double least_bytes = kLeastShareAtEnd * bases.score;
  const bool may_be_outdone = outdoing != nullptr && (!is_in_reach || outdoing->may_take_fewer_than(least_bytes));
  std::atomic<bool> is_outdone{false};
  ForEachCandidate(may_be_outdone ? kOneCandidateAtATime : num_input, 2, [&](size_t i) {
    if (i == 0) {
      is_outdone = outdoing != nullptr && outdoing->takes_fewer_than(least_bytes);
      if (!is_outdone && rival != nullptr && is_in_reach) rival->prepare_beside(target.is_rate ? target.bytes : kUsualShareAtEnd * bases.score);
    } else if (!is_outdone) {
      meet_best();
    }
  });
  if (is_outdone) return Outdone();
  return best;
}

}  // namespace lacerta
