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
#include <set>
#include <string>
#include <tuple>
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

// A base mesh: the one that a simplification of the surface has at a rung of the ladder.
struct BaseChoice {
  size_t simplification = 0;
  int rung = 0;

  bool operator<(const BaseChoice& other) const { return std::tie(simplification, rung) < std::tie(other.simplification, other.rung); }
  BaseChoice At(int other_rung) const { return {simplification, other_rung}; }
};

// A base that was tried.
struct TriedBase {
  std::optional<FittedRemesh> remesh;              // until there is the candidate
  std::unique_ptr<NormalMeshCandidate> candidate;  // null once it was let go of
  std::unique_ptr<CandidateSearch> search;
  Status status;  // why there is no candidate, if so
  double remesh_psnr = 0;
  bool may_grow = false;  // as of FittedRemesh
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
// What a PSNR costs, about: ln(bytes) per dB.
constexpr double kLogBytesPerDecibel = 0.11;

// The most promising bases, best first; at least one.
struct BestBases {
  std::vector<BaseChoice> choices;
  double bytes;  // of the stream over the first, about; infinite where no base reaches the target
};

Status Outdone() { return Unsupported("a stream without levels is much smaller"); }

class Ladder {
 public:
  Ladder(const std::vector<RefinableSurface>& simplifications, const SurfaceDistanceMeter& meter, const ResolvedTarget& target, EncodeMode mode,
         const SearchEffort& effort)
      : simplifications_(simplifications), meter_(meter), target_(target), mode_(mode), effort_(effort) {
    num_input_ = static_cast<double>(simplifications.front().surface.mesh().positions.size());
    constexpr double kLargestShare = 0.5;  // of the input's vertices
    for (const RefinableSurface& s : simplifications) first_.push_back(RungOfSize(num_input_ - static_cast<double>(s.history.num_collapses())));
    last_ = std::max(first_.front(), RungOfSize(std::max(kUsualSize, kLargestShare * num_input_)));
  }

  // Scores the rungs around the usual one and goes on until one on either side of the best is known to be much worse, or two to be
  // worse: one alone may be a fluke of its simplification. Other simplifications are looked at where the best one is. Fails where the rival, if
  // there is one, outdoes it on the way.
  StatusOr<BestBases> FindBest(const std::function<void(double, const char*)>& progress, const RivalStream* rival) {
    const auto is_outdone = [&](double bytes) { return rival != nullptr && rival->takes_fewer_than(bytes); };
    const int first = UsualRung();
    if (is_outdone(LeastBytesFrom(std::max(first - kStride, first_.front())))) return Outdone();
    Visit(effort_.enough_bases == 1 ? std::vector<BaseChoice>{{0, first}} : std::vector<BaseChoice>{{0, first - kStride}, {0, first}, {0, first + kStride}}, {});
    for (;;) {
      if (progress) progress(std::min(0.75, 0.1 + 0.08 * static_cast<double>(tried_.size())), "choosing the base mesh");
      const std::vector<BaseChoice> ranking = Ranking();
      for (size_t i = effort_.at_a_time; i < ranking.size(); ++i) LetGo(&tried_[ranking[i]]);
      const BaseChoice best = ranking.front();
      const bool is_scored = IsScored(best);
      std::vector<BaseChoice> likely;
      const std::vector<BaseChoice> next = NextChoices(best, &likely);
      const bool is_enough = next.empty() || (tried_.size() >= effort_.enough_bases && is_scored);
      if (is_enough) {
        made_.clear();
        LACERTA_ASSIGN_OR_RETURN(std::vector<BaseChoice> bases, Promising(ranking));
        return BestBases{std::move(bases), target_.is_rate ? target_.bytes : std::exp(tried_[best].score)};
      }
      if (is_outdone(is_scored ? LeastShare(best) * std::exp(tried_.at(best).score) : LeastBytesFrom(HighestRung() + kStride))) return Outdone();
      Visit(next, next.size() == 1 ? likely : std::vector<BaseChoice>());
    }
  }

  // After FindBest: scores the sizes halfway to the neighbors of the best, over all simplifications. Returns those that are promising beside all that
  // were tried, best first.
  std::vector<BaseChoice> FindHalfway() {
    const BaseChoice best = Ranking().front();
    std::set<BaseChoice> halfway;
    for (size_t s = 0; s < simplifications_.size(); ++s) {
      for (const int r : {best.rung - kStride / 2, best.rung + kStride / 2}) {
        if (IsMissing({s, r})) halfway.insert({s, r});
      }
    }
    Visit({halfway.begin(), halfway.end()}, {});
    const std::vector<BaseChoice> ranking = Ranking();
    std::vector<BaseChoice> result;
    for (const BaseChoice& c : ranking) {
      if (halfway.count(c) == 0) continue;
      if (result.size() < effort_.at_a_time && tried_.at(c).status.ok() && !IsHopeless(c, ranking.front())) {
        result.push_back(c);
      } else {
        LetGo(&tried_.at(c));
      }
    }
    return result;
  }

  // Takes a base of FindBest, with all its levels, to the target. Several may be in parallel; afterwards it is let go of.
  StatusOr<ChosenStream> Meet(const BaseChoice& choice) {
    TriedBase& base = tried_.at(choice);
    if (!base.candidate || (base.may_grow && base.remesh_psnr < TypicalPsnr(target_, num_input_) + kComfort)) {
      LetGo(&base);
      LACERTA_RETURN_IF_ERROR(Remesh(choice, kComfort, &base));
      MakeCandidate(&base);
      if (std::isfinite(base.score)) base.search->BeginAt(base.start);
    }
    LACERTA_ASSIGN_OR_RETURN(MeasuredStream measured, base.search->Meet());
    ChosenStream chosen{std::move(measured), base.remesh_psnr, NormalShare(base.candidate->normal_mesh())};
    LetGo(&base);
    return chosen;
  }

  // Whether the scores leave little hope that base a takes fewer bytes than b.
  bool IsHopeless(const BaseChoice& a, const BaseChoice& b) const { return IsWorse(a, b, effort_.hopeless); }

 private:
  uint32_t RungSize(int rung) const { return static_cast<uint32_t>(std::lround(kFirstRung * std::pow(kStrideRatio, static_cast<double>(rung) / kStride))); }

  int RungOfSize(double size) const {
    return std::max(0, kStride * static_cast<int>(std::lround(std::log(size / kFirstRung) / std::log(kStrideRatio))));
  }

  // Where streams of that quality usually have their base: the smallest that is near enough to the surface by itself.
  int UsualRung() const {
    const double enough = UsualBasePsnr(TypicalPsnr(target_, num_input_));
    int low = std::clamp(RungOfSize(kUsualSize), first_.front(), last_), high = last_;
    while (low < high) {
      const int middle = low + (high - low) / (2 * kStride) * kStride;
      if (BasePsnr(simplifications_.front(), RungSize(middle), meter_) >= enough) {
        high = middle;
      } else {
        low = middle + kStride;
      }
    }
    return low;
  }

  // Of streams with a base of that rung or a larger one. Vertices of bases usually take three bytes and more.
  double LeastBytesFrom(int rung) const { return kFewestBytesPerVertex * RungSize(rung); }

  // Of the bytes of the best so far those that the stream takes in the end.
  double LeastShare(const BaseChoice& best) const {
    if (IsMissing(best.At(best.rung - kStride))) return kLeastShare;
    return IsMissing(best.At(best.rung + kStride)) ? kLeastShareOfLargest : kLeastShareBetween;
  }

  // What a share of the bytes is in units of scores.
  double ScoreOfShare(double share) const { return target_.is_rate ? share / kLogBytesPerDecibel : share; }

  // Whether a scores worse than b by that share of the bytes. By much_worse it hardly is a fluke: neighboring rungs are rarely farther from the
  // smooth curve of all rungs.
  bool IsWorse(const BaseChoice& a, const BaseChoice& b, double share) const { return tried_.at(a).score >= tried_.at(b).score + ScoreOfShare(share); }

  static void LetGo(TriedBase* base) {
    base->search.reset();
    base->candidate.reset();
  }

  bool IsOnLadder(const BaseChoice& c) const { return c.rung >= first_[c.simplification] && c.rung <= last_; }
  bool IsMissing(const BaseChoice& c) const { return IsOnLadder(c) && tried_.count(c) == 0; }

  bool IsScored(const BaseChoice& c) const { return std::isfinite(tried_.at(c).score); }
  int HighestRung() const {
    int highest = 0;
    for (const auto& [c, base] : tried_) highest = std::max(highest, c.rung);
    return highest;
  }

  // What to visit next; nothing where enough is known. likely: due after that, unless it turns out to be much worse than the best.
  std::vector<BaseChoice> NextChoices(const BaseChoice& best, std::vector<BaseChoice>* likely) const {
    if (!IsScored(best)) {  // nothing reaches the target yet: larger bases
      const int highest = HighestRung();
      return highest < last_ ? std::vector<BaseChoice>{{0, highest + kStride}, {0, highest + 2 * kStride}} : std::vector<BaseChoice>();
    }
    std::vector<BaseChoice> next = Beside(best, likely);
    return next.empty() ? OfOtherSimplifications(best) : next;
  }

  // Bases of the same simplification on either side of the best.
  std::vector<BaseChoice> Beside(const BaseChoice& best, std::vector<BaseChoice>* likely) const {
    std::vector<BaseChoice> result;
    for (const int side : {-kStride, kStride}) {
      const BaseChoice neighbor = best.At(best.rung + side), beyond = best.At(best.rung + 2 * side);
      if (IsMissing(neighbor)) {
        result.push_back(neighbor);
        likely->push_back(beyond);
      } else if (IsMissing(beyond) && tried_.count(neighbor) > 0 && !IsWorse(neighbor, best, effort_.much_worse)) {
        result.push_back(beyond);
      }
    }
    return result;
  }

  // Bases that other simplifications have at the size of the best, and then beside it where they are near or where the best has no neighbor.
  std::vector<BaseChoice> OfOtherSimplifications(const BaseChoice& best) const {
    std::vector<BaseChoice> result;
    for (size_t s = 0; s < simplifications_.size(); ++s) {
      const BaseChoice other{s, best.rung};
      if (IsMissing(other)) {
        result.push_back(other);
        continue;
      }
      const bool is_near = tried_.count(other) > 0 && !IsWorse(other, best, effort_.much_worse / 2);
      for (const int r : {best.rung - kStride, best.rung + kStride}) {
        if ((is_near || !IsOnLadder(best.At(r))) && IsMissing(other.At(r))) result.push_back(other.At(r));
      }
    }
    return result;
  }

  // Where to begin the search at a base: where that of the nearest size that was scored ended.
  std::optional<SearchStart> StartOf(const BaseChoice& choice) const {
    std::optional<SearchStart> start;
    int least = std::numeric_limits<int>::max();
    for (const auto& [c, base] : tried_) {
      if (!std::isfinite(base.score) || std::abs(c.rung - choice.rung) >= least) continue;
      least = std::abs(c.rung - choice.rung);
      start = base.start;
    }
    return start;
  }

  // Makes and scores the given bases; those off the ladder are left out. A base that fails costs only itself. likely: to be visited later,
  // made now where there are threads for it. What is found does not depend on it.
  void Visit(const std::vector<BaseChoice>& choices, const std::vector<BaseChoice>& likely) {
    struct Visited {
      BaseChoice choice;
      bool is_scored;
      TriedBase base;
    };
    std::vector<Visited> visited;
    for (const BaseChoice& c : choices) {
      if (!IsOnLadder(c)) continue;
      const auto made = made_.extract(c);
      visited.push_back({c, true, made.empty() ? TriedBase() : std::move(made.mapped())});
    }
    for (const BaseChoice& c : likely) {
      if (IsMissing(c) && made_.count(c) == 0 && AreInParallel(num_input_)) visited.push_back({c, false, TriedBase()});
    }
    const double comfort = effort_.enough_bases == 1 ? kComfort : kLittleComfort;  // a single one is taken to the target anyway
    ForEachCandidate(num_input_, visited.size(), [&](size_t i) {
      TriedBase& base = visited[i].base;
      if (!base.remesh && base.status.ok()) base.status = Remesh(visited[i].choice, comfort, &base);
      if (visited[i].is_scored && base.status.ok()) base.status = Score(visited[i].choice, &base);
    });
    for (Visited& v : visited) (v.is_scored ? tried_ : made_)[v.choice] = std::move(v.base);
  }

  Status Remesh(const BaseChoice& choice, double comfort, TriedBase* base) const {
    const double psnr = TypicalPsnr(target_, num_input_) + comfort;
    LACERTA_ASSIGN_OR_RETURN(base->remesh, RemeshForPsnr(simplifications_[choice.simplification], RungSize(choice.rung), psnr, target_.base_coding, meter_));
    return Status();
  }

  void MakeCandidate(TriedBase* base) const {
    base->remesh_psnr = base->remesh->psnr;
    base->may_grow = base->remesh->may_grow;
    base->candidate = std::make_unique<NormalMeshCandidate>(std::move(base->remesh->base), std::move(base->remesh->mesh));
    base->remesh.reset();
    base->search = std::make_unique<CandidateSearch>(*base->candidate, base->remesh_psnr, meter_, target_, mode_, effort_);
  }

  Status Score(const BaseChoice& choice, TriedBase* base) const {
    MakeCandidate(base);
    constexpr double kHeadroom = 0.5;  // dB that quantization takes at least
    if (const std::optional<SearchStart> start = StartOf(choice)) base->search->BeginAt(*start);
    if (!target_.is_rate && base->remesh_psnr < target_.psnr + kHeadroom) return Status();
    LACERTA_ASSIGN_OR_RETURN(base->score, base->search->Score());
    if (target_.quality_layers > 1) {  // a large base comes before all else: it costs prefixes what it saves at the end
      constexpr double kPrefixCost = 0.015;  // of ln(bytes), per rung
      base->score += ScoreOfShare(kPrefixCost * choice.rung);
    }
    base->start = base->search->start();
    return Status();
  }

  // Bases by score, the lowest first, or, where none reaches the target, by the quality of the remesh.
  std::vector<BaseChoice> Ranking() const {
    std::vector<BaseChoice> choices;
    for (const auto& [c, base] : tried_) choices.push_back(c);
    std::stable_sort(choices.begin(), choices.end(), [&](const BaseChoice& a, const BaseChoice& b) {
      const TriedBase &x = tried_.at(a), &y = tried_.at(b);
      if (std::isfinite(x.score) || std::isfinite(y.score)) return x.score < y.score;
      return x.remesh_psnr > y.remesh_psnr;
    });
    return choices;
  }

  // Of a ranking those that can be coded.
  StatusOr<std::vector<BaseChoice>> Promising(const std::vector<BaseChoice>& ranking) const {
    std::vector<BaseChoice> result;
    for (const BaseChoice& c : ranking) {
      if (tried_.at(c).status.ok()) result.push_back(c);
    }
    if (result.empty()) return tried_.at(ranking.front()).status.WithContext("no base mesh can be coded");
    return result;
  }

  const std::vector<RefinableSurface>& simplifications_;
  const SurfaceDistanceMeter& meter_;
  const ResolvedTarget& target_;
  const EncodeMode mode_;
  const SearchEffort effort_;
  double num_input_;
  std::vector<int> first_;  // rung of the coarsest base that each simplification has
  int last_;                // rung of the largest base worth trying
  std::map<BaseChoice, TriedBase> tried_, made_;  // made_: not yet scored
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

StatusOr<ChosenStream> CodeAtTarget(const std::vector<RefinableSurface>& simplifications, const SurfaceDistanceMeter& meter, const ResolvedTarget& target,
                                    EncodeMode mode, const std::function<void(double, const char*)>& progress, const SearchEffort& effort,
                                    const RivalStream* rival) {
  Ladder ladder(simplifications, meter, target, mode, effort);
  const RivalStream* const outdoing = target.is_rate ? nullptr : rival;  // at a rate all take as many bytes
  LACERTA_ASSIGN_OR_RETURN(const BestBases bases, ladder.FindBest(progress, outdoing));
  if (progress) progress(0.8, "meeting the target");
  StatusOr<ChosenStream> best = InternalError("no base was taken to the target");
  const auto num_input = static_cast<double>(simplifications.front().surface.mesh().positions.size());
  const auto meet = [&](Span<const BaseChoice> choices) {
    std::vector<StatusOr<ChosenStream>> met(choices.size(), InternalError("not tried"));
    ForEachCandidate(num_input, met.size(), [&](size_t i) { met[i] = ladder.Meet(choices[i]); });
    for (StatusOr<ChosenStream>& tried : met) {  // one that fails costs only itself
      const bool is_better = !best.ok() || (tried.ok() && IsBetter(OutcomeOf(tried.value().measured), OutcomeOf(best.value().measured), target));
      if (is_better) best = std::move(tried);
    }
  };
  // Scores are estimates: a few candidates at a time are taken to the target until one meets it, and the better of them is kept.
  const auto meet_best = [&] {
    const Span<const BaseChoice> choices = bases.choices;
    const size_t at_a_time = target.quality_layers > 1 ? 1 : effort.at_a_time;  // with layers the fewest bytes are not all that counts
    for (size_t first = 0; first < std::min(kMost, choices.size());) {
      size_t count = 1;
      while (count < at_a_time && first + count < choices.size() && !ladder.IsHopeless(choices[first + count], choices[first])) ++count;
      meet(choices.Subspan(first).First(count));
      if (best.ok() && best.value().measured.meets_target) break;
      first += count;
    }
    if (effort.every_size) meet(ladder.FindHalfway());
  };
  // Both take a while, mostly on one thread each: they are done at once, in vain for the bases where these are outdone, unless that is likely.
  const bool is_in_reach = std::isfinite(bases.bytes);
  const double least_bytes = kLeastShareAtEnd * bases.bytes;
  const bool may_be_outdone = outdoing != nullptr && (!is_in_reach || outdoing->may_take_fewer_than(least_bytes));
  std::atomic<bool> is_outdone{false};
  ForEachCandidate(may_be_outdone ? kOneCandidateAtATime : num_input, 2, [&](size_t i) {
    if (i == 0) {
      is_outdone = outdoing != nullptr && outdoing->takes_fewer_than(least_bytes);
      if (!is_outdone && rival != nullptr && is_in_reach) rival->prepare_beside(bases.bytes);
    } else if (!is_outdone) {
      meet_best();
    }
  });
  if (is_outdone) return Outdone();
  return best;
}

}  // namespace lacerta
