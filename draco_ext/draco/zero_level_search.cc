#include "draco/zero_level_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "draco/bounded_simplification.h"
#include "draco/decoded_distance.h"
#include "draco/simplified_size.h"
#include "draco/zero_level_candidate.h"
#include "geometry/for_each_branch.h"
#include "remesh/fitted_simplify.h"
#include "remesh/simplify.h"

namespace lacerta {
namespace {

constexpr double kMostRegular = 4;  // times the triangles of the best simplified mesh: the input may take fewer bytes as it is
constexpr double kFewestBytesPerTriangle = 0.85;
constexpr uint64_t kSizeSamples = 4000;  // that tell how far a mesh may be simplified

double Square(double x) { return x * x; }

// In fewer than those a stream without levels is better than one of so many bytes that has some.
double BytesToBeat(double bytes) {
  constexpr double kLevelsWorthBytes = 0.05;  // as a share
  return (1 - kLevelsWorthBytes) * bytes;
}

}  // namespace

class ZeroLevelSearch {
 public:
  ZeroLevelSearch(const TriangleMesh& mesh, const SimplificationSequence& sequence, const SurfaceDistanceMeter& meter,
                  const ResolvedTarget& target, const SearchEffort& effort)
      : mesh_(mesh), meter_(meter), target_(target), tries_(effort.zero_level_tries), sequence_(sequence),
        fit_target_(mesh, FewestSamples(mesh), sequence.original() ? sequence.original()->farthest() : 0) {
    if (!target.is_rate) distortion_ = Square(DistanceOfPsnr(target.psnr, meter.diagonal()));
  }

  // Looks for the best number of triangles, from what earlier calls found. most_bytes: of a stream that there is at the PSNR; false
  // where it is hopeless to become smaller than that.
  StatusOr<bool> FindSize(double most_bytes) {
    if (first_ == 0) first_ = FirstSize();
    if (tried_.empty() && IsOutOfReach(most_bytes)) return false;
    if (!simplified_) Begin();
    LACERTA_RETURN_IF_ERROR(Look({first_}));
    const ZeroLevelTrial& trial = tried_.at(first_);
    if (IsOver(kHopeless * most_bytes)) return false;
    const uint32_t usual = target_.is_rate ? 0 : SizeByShare(trial);
    if (usual > 0) LACERTA_RETURN_IF_ERROR(Look({usual}));
    if (IsOver(kHopelessAtUsual * most_bytes)) return false;
    // There the best is broad, and looking takes long. The usual size was better than its neighbors on 22 of 22 meshes.
    constexpr uint32_t kManyTriangles = 3000;
    const bool is_settled = best_ == usual && usual > kManyTriangles;
    for (double ratio = kWideRatio; ratio > kNarrowRatio && !is_settled; ratio = std::sqrt(ratio)) {
      for (int moves = 0; moves < kMostMoves; ++moves) {
        const uint32_t center = best_;
        LACERTA_RETURN_IF_ERROR(Look(UntriedBeside(center, ratio)));
        if (best_ == center) break;
      }
      if (best_ > kManyTriangles) break;
    }
    if (MayTakeFewerAsItIs(best_)) LACERTA_RETURN_IF_ERROR(Look({Clamped(1e18)}));
    return MayTakeFewerThan(most_bytes);
  }

  // Whether the best size so far does not tell otherwise; false where there is none.
  bool MayTakeFewerThan(double bytes) const { return !tried_.empty() && !IsOver(kHopelessAtBest * bytes); }

  // Of the stream of the best size, about; the fewest that so many triangles take where that seems to miss the PSNR.
  double BestBytes() const {
    const ZeroLevelTrial& best = tried_.at(best_);
    return best.meets ? static_cast<double>(best.bytes) : kFewestBytesPerTriangle * static_cast<double>(best.num_triangles);
  }

  // The stream of the best size, or where that misses the PSNR after all, of a larger one that meets it, as long as it takes fewer than
  // `most_bytes`; and where it takes more than another size seemed to, of that, if it is smaller: few samples judge sizes, and may overlook a small part
  // of the surface that is far off.
  StatusOr<ZeroLevelStream> Finish(double most_bytes) {
    LACERTA_ASSIGN_OR_RETURN(ZeroLevelStream stream, FinishBest());
    std::set<uint32_t> finished{best_};
    uint32_t size = best_;  // of the stream
    const auto compare_with_best = [&]() -> Status {
      finished.insert(best_);
      LACERTA_ASSIGN_OR_RETURN(ZeroLevelStream other, FinishBest());
      const int measurements = stream.measurements + other.measurements;
      if (IsBetter(OutcomeOf(other), OutcomeOf(stream), target_)) {
        stream = std::move(other);
        size = best_;
      }
      stream.measurements = measurements;
      return Status();
    };
    const auto is_to_grow = [&] {
      return !target_.is_rate && !stream.meets_target && best_ < mesh_.triangles.size() && static_cast<double>(stream.stream.size()) < most_bytes;
    };
    while (is_to_grow()) {
      LACERTA_RETURN_IF_ERROR(Grow(Square(stream.distance)));
      if (IsOver(kHopelessAtBest * most_bytes)) break;
      LACERTA_RETURN_IF_ERROR(compare_with_best());
    }
    while (const std::optional<uint32_t> next = SmallestOtherThan(finished, stream.stream.size())) {
      Choose(*next);
      LACERTA_RETURN_IF_ERROR(compare_with_best());
    }
    if (best_ != size) Choose(size);
    return stream;
  }

 private:
  static constexpr size_t kMostSamples = 80000;
  static constexpr double kSamplesPerTriangle = 4;
  static constexpr size_t kMostTrianglesAtATime = 20'000;  // beyond, memory counts for more than time
  // By which the numbers of triangles differ that are compared.
  static constexpr double kWideRatio = 1.25, kNarrowRatio = 1.1;
  static constexpr int kMostMoves = 4;
  // Against what there is: the first size tried is not yet the best, nor the usual one, and the last steps gain some bytes too (27 meshes at 62, 70 and 75 dB: 5 to 20 % from
  // the first size on, 4 to 15 from the usual one).
  static constexpr double kHopeless = 1.26, kHopelessAtUsual = 1.18, kHopelessAtBest = 1.15;
  // The squared distance falls by about 5 dB as triangles double: by this power of their number.
  static constexpr double kFall = 1.75;

  // Whether the input, if its many triangles are regular, may take fewer bytes than a simplified mesh of so many.
  bool MayTakeFewerAsItIs(double triangles) const { return static_cast<double>(mesh_.triangles.size()) < kMostRegular * triangles; }

  // Whether the first size alone, before anything is fitted, tells that no stream takes fewer than so many bytes at a PSNR: those of 24 meshes at 55, 62, 70 and 76 dB took a byte for each
  // of its triangles and more, but for one (0.94), and a sixth less with a compact base.
  bool IsOutOfReach(double most_bytes) const {
    const double fewest_bytes = target_.base_coding == BaseCoding::kCompact ? 0.8 : 1.0;  // per triangle
    return !target_.is_rate && !MayTakeFewerAsItIs(first_) && fewest_bytes * first_ >= most_bytes;
  }

  // Whether the best size so far takes more than so many bytes at a PSNR.
  bool IsOver(double bytes) const {
    const ZeroLevelTrial& best = tried_.at(best_);
    return !target_.is_rate && best.meets && static_cast<double>(best.bytes) > bytes;
  }

  // Small inputs have little to sample.
  static size_t FewestSamples(const TriangleMesh& mesh) {
    constexpr size_t kPerTriangle = 6;
    return std::clamp<size_t>(kPerTriangle * mesh.triangles.size(), 1500, 6000);
  }

  void TakeSamples(double per_triangle, size_t triangles) {
    const auto wanted = static_cast<size_t>(per_triangle * static_cast<double>(triangles));
    fit_target_.Resample(std::clamp(wanted, FewestSamples(mesh_), kMostSamples));
  }

  // Sizes at that ratio below and above one, but for those that hardly differ from one that was tried.
  std::vector<uint32_t> UntriedBeside(uint32_t center, double ratio) const {
    constexpr double kSame = 0.01;
    std::vector<uint32_t> sizes;
    for (const double size : {center / ratio, center * ratio}) {
      const auto next = tried_.lower_bound(Clamped((1 - kSame) * size));
      if (next == tried_.end() || next->first > (1 + kSame) * size) sizes.push_back(Clamped(size));
    }
    return sizes;
  }

  // Tries sizes that were not tried yet, small ones at a time.
  Status Look(std::vector<uint32_t> sizes) {
    if (sizes.size() > 1 && *std::max_element(sizes.begin(), sizes.end()) > kMostTrianglesAtATime) {
      for (const uint32_t size : sizes) LACERTA_RETURN_IF_ERROR(Look({size}));
      return Status();
    }
    sizes.erase(std::remove_if(sizes.begin(), sizes.end(), [&](uint32_t size) { return tried_.count(size) != 0; }), sizes.end());
    if (sizes.empty()) return Status();
    std::vector<TriangleMesh> meshes;
    meshes.reserve(sizes.size());
    for (const uint32_t size : sizes) meshes.push_back(simplified_->MeshWith(size));
    TakeSamples(kSamplesPerTriangle, *std::max_element(sizes.begin(), sizes.end()));
    std::vector<std::unique_ptr<ZeroLevelCandidate>> candidates(sizes.size());
    std::vector<StatusOr<ZeroLevelTrial>> trials(sizes.size(), ZeroLevelTrial());
    ForEachBranch(sizes.size(), [&](size_t i) {
      candidates[i] = std::make_unique<ZeroLevelCandidate>(fit_target_, std::move(meshes[i]), SourceOf(sizes[i]));
      trials[i] = TrySteps(target_, meter_, bias_, candidates[i].get());
    });
    for (size_t i = 0; i < sizes.size(); ++i) {
      LACERTA_ASSIGN_OR_RETURN(const ZeroLevelTrial trial, std::move(trials[i]));
      if (tried_.empty() || trial.score < tried_.at(best_).score) {
        best_ = sizes[i];
        best_candidate_ = std::move(candidates[i]);
      }
      tried_.emplace(sizes[i], trial);
    }
    return Status();
  }

  ZeroLevelCandidate::Source SourceOf(uint32_t triangles) const {
    using Source = ZeroLevelCandidate::Source;
    return triangles >= mesh_.triangles.size() ? Source::kInput : simplified_->IsOfStep(triangles) ? Source::kFitted : Source::kSimplified;
  }

  // Goes on from the best size, of this squared distance, to one that may well meet the PSNR.
  Status Grow(double distortion) {
    uint32_t larger = best_;
    do {
      const double ratio = std::clamp(std::pow(distortion / distortion_, 1 / kFall), kNarrowRatio, 2.0);
      larger = std::max(Clamped(larger * ratio), Clamped(larger + 1.0));
      LACERTA_RETURN_IF_ERROR(Look({larger}));
      distortion = bias_ * tried_.at(larger).fit_distortion;
    } while (!tried_.at(larger).meets && larger < mesh_.triangles.size());
    if (best_ != larger) Choose(larger);
    return Status();
  }

  void Choose(uint32_t triangles) {
    best_ = triangles;
    TriangleMesh simplified = simplified_->MeshWith(triangles);
    TakeSamples(kSamplesPerTriangle, triangles);
    best_candidate_ = std::make_unique<ZeroLevelCandidate>(fit_target_, std::move(simplified), SourceOf(triangles));  // FinishBest fits it for its rate
  }

  // The size, of those that were tried and seemed to meet the PSNR in fewer than so many bytes, that seemed to take the fewest; none at a rate.
  std::optional<uint32_t> SmallestOtherThan(const std::set<uint32_t>& finished, size_t bytes) const {
    std::optional<uint32_t> smallest;
    if (target_.is_rate) return smallest;
    for (const auto& [size, trial] : tried_) {
      if (!trial.meets || bias_ * trial.fit_distortion > distortion_ || trial.bytes >= bytes || finished.count(size) != 0) continue;
      bytes = trial.bytes;
      smallest = size;
    }
    return smallest;
  }

  // Where the fit takes the share of the distance that it takes at the best sizes of most surfaces.
  uint32_t SizeByShare(const ZeroLevelTrial& trial) const {
    constexpr double kBestShare = 0.78;
    const double ratio = std::pow(trial.fit_distortion / (kBestShare * distortion_), 1 / kFall);
    return Clamped(static_cast<double>(trial.num_triangles) * std::clamp(ratio, 0.4, 2.5));
  }

  uint32_t Clamped(double triangles) const {
    return static_cast<uint32_t>(std::clamp(triangles, static_cast<double>(sequence_.fewest_triangles()),
                                            static_cast<double>(mesh_.triangles.size())));
  }

  void Begin() {
    constexpr double kLargest = 1.6;  // times the first size: the best one is hardly ever larger, and steps from above gain no more
    constexpr double kMostStepped = 20'000;  // triangles: fits of more take long
    const double largest = std::min({kLargest * first_, static_cast<double>(mesh_.triangles.size()), kMostStepped});
    simplified_.emplace(sequence_, FittedSimplification::Options{static_cast<uint32_t>(largest), FewestSamples(mesh_), kMostSamples}, &fit_target_);
  }

  // The size at which the simplified mesh, before the fit, is at the target but for what the fit usually gains.
  uint32_t FirstSize() const {
    constexpr double kUsualBytesPerTriangle = 1.1, kUsualGain = 1.5;
    if (target_.is_rate) return Clamped(target_.bytes / kUsualBytesPerTriangle);
    constexpr double kTolerance = 0.1;
    return Clamped(SimplifiedSize(sequence_, meter_, std::sqrt(kUsualGain * distortion_), kSizeSamples, kTolerance));
  }

  StatusOr<ZeroLevelStream> FinishBest() {
    ZeroLevelCandidate& candidate = *best_candidate_;
    constexpr int kFitRounds = 2;
    TakeSamples(8, std::max(candidate.num_triangles(), FewestSamples(mesh_)));
    const double added = target_.is_rate ? candidate.fit_distortion() : distortion_ / bias_ - candidate.fit_distortion();
    candidate.FitForRate(std::max(added, 0.05 * candidate.fit_distortion()), kFitRounds);
    const double step = tried_.at(best_).step;
    if (target_.base_coding == BaseCoding::kStock) candidate.FitForStream(step);
    LACERTA_ASSIGN_OR_RETURN(FinishedZeroLevel finished, FinishSteps(target_, meter_, candidate, step, tries_));
    bias_ = finished.bias;
    return std::move(finished.stream);
  }

  const TriangleMesh& mesh_;
  const SurfaceDistanceMeter& meter_;
  const ResolvedTarget target_;
  const double tries_;  // SearchEffort::zero_level_tries
  const SimplificationSequence& sequence_;
  FitTarget fit_target_;
  std::optional<FittedSimplification> simplified_;
  double distortion_ = 0;  // of a PSNR target
  double bias_ = 1;        // of squared distances measured in full against those by few samples, at the size that was finished last
  std::map<uint32_t, ZeroLevelTrial> tried_;  // by number of triangles asked for
  uint32_t first_ = 0, best_ = 0;    // of those
  std::unique_ptr<ZeroLevelCandidate> best_candidate_;  // the only one that is kept: each is as large as its mesh
};

StatusOr<ZeroLevelStream> CodeZeroLevel(const TriangleMesh& mesh, const SurfaceDistanceMeter& meter, const ResolvedTarget& target,
                                        const SearchEffort& effort) {
  return CodeZeroLevel(mesh, BoundedSimplification(mesh, meter, target), meter, target, effort);
}

StatusOr<ZeroLevelStream> CodeZeroLevel(const TriangleMesh& mesh, const SimplificationSequence& sequence, const SurfaceDistanceMeter& meter,
                                        const ResolvedTarget& target, const SearchEffort& effort) {
  ZeroLevelSearch search(mesh, sequence, meter, target, effort);
  LACERTA_RETURN_IF_ERROR(search.FindSize(std::numeric_limits<double>::infinity()).status());
  return search.Finish(std::numeric_limits<double>::infinity());
}

SimplerStream::SimplerStream(const TriangleMesh& mesh, const SimplificationSequence& sequence, const SurfaceDistanceMeter& meter,
                             const ResolvedTarget& target, const SearchEffort& effort)
    : mesh_(mesh), sequence_(sequence), meter_(meter), target_(target), effort_(effort) {}

SimplerStream::~SimplerStream() = default;

StatusOr<bool> SimplerStream::Find(double most_bytes) {
  if (!search_) search_ = std::make_unique<ZeroLevelSearch>(mesh_, sequence_, meter_, target_, effort_);
  return search_->FindSize(most_bytes);
}

// As one look tells at a mesh that is larger than any that does. Never certain at a rate, nor where the input may be so regular that it takes
// hardly any bytes.
bool SimplerStream::IsHopeless(double bytes) {
  constexpr double kMostGain = 2;  // of the fit, in squared distance
  if (bytes <= hopeless_bytes_) return true;
  const double triangles = std::max(bytes / kFewestBytesPerTriangle, static_cast<double>(sequence_.fewest_triangles()));
  if (target_.is_rate || kMostRegular * triangles > static_cast<double>(sequence_.num_input_triangles())) return false;
  const TriangleMesh simplified = sequence_.MeshWith(static_cast<uint32_t>(triangles));
  const double distance = DecodedDistance(meter_, simplified, SurfaceDistanceOptions::RmsOnly(kSizeSamples));
  if (!(Square(distance) > kMostGain * Square(DistanceOfPsnr(target_.psnr, meter_.diagonal())))) return false;
  hopeless_bytes_ = bytes;
  return true;
}

bool SimplerStream::MayTakeFewerThan(double bytes) const { return search_ && search_->MayTakeFewerThan(bytes); }

StatusOr<bool> SimplerStream::TakesFewerThan(double bytes) {
  const auto does = [&](const ZeroLevelStream& stream) { return stream.meets_target && static_cast<double>(stream.stream.size()) < bytes; };
  if (stream_) return does(*stream_);
  if (target_.is_rate || IsHopeless(bytes)) return false;
  LACERTA_ASSIGN_OR_RETURN(const bool may_be, Find(bytes));
  if (!may_be || search_->BestBytes() >= bytes) return false;
  LACERTA_ASSIGN_OR_RETURN(ZeroLevelStream stream, search_->Finish(bytes));
  if (!stream.meets_target) return false;  // it may yet, in more bytes
  stream_ = std::move(stream);
  return does(*stream_);
}

Status SimplerStream::Look(double most_bytes) {
  if (stream_ || IsHopeless(most_bytes)) return Status();
  LACERTA_ASSIGN_OR_RETURN(const bool may_be_better, Find(most_bytes));
  if (!may_be_better) return Status();
  LACERTA_ASSIGN_OR_RETURN(stream_, search_->Finish(most_bytes));
  return Status();
}

void SimplerStream::PrepareBeside(double bytes) {
  const Status looked = Look(BytesToBeat(bytes));  // what fails does so again in IsBetterThan
  // It may yet have to come nearer to the target than one that misses it.
  if (!looked.ok() || (stream_ && !stream_->meets_target)) stream_.reset();
}

StatusOr<bool> SimplerStream::IsBetterThan(const MeasuredStream& coded) {
  const double bytes_to_beat = BytesToBeat(static_cast<double>(coded.stream.size()));
  LACERTA_RETURN_IF_ERROR(Look(coded.meets_target ? bytes_to_beat : std::numeric_limits<double>::infinity()));
  if (!stream_) return false;
  constexpr double kLevelsWorthPsnr = 0.3;
  return IsBetter(OutcomeOf(*stream_), {coded.meets_target, static_cast<size_t>(bytes_to_beat), coded.psnr + kLevelsWorthPsnr}, target_);
}

}  // namespace lacerta
