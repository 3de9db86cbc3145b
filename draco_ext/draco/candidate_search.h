// The search over slopes of the rate-distortion curve that makes one candidate meet a target.
#ifndef LACERTA_DRACO_CANDIDATE_SEARCH_H_
#define LACERTA_DRACO_CANDIDATE_SEARCH_H_

#include <map>
#include <optional>

#include "draco/base_coding.h"
#include "draco/normal_mesh_candidate.h"
#include "draco/search_effort.h"
#include "lacerta/codec.h"
#include "lacerta/status.h"
#include "lacerta/surface_distance.h"

namespace lacerta {

// A target with its unit resolved: either bytes or PSNR.
struct ResolvedTarget {
  bool is_rate = false;
  double bytes = 0;  // where is_rate: at most
  double psnr = 0;   // else: at least, dB
  BaseCoding base_coding = BaseCoding::kStock;
  int quality_layers = 1;
};

// A stream with what is known of its quality.
struct MeasuredStream {
  CodedStream stream;
  double psnr = 0;  // dB, two-sided, to the input: measured at a PSNR target, estimated at a rate
  bool meets_target = false;
  int measurements = 0;  // of the surface distance, rough ones too, that led to the stream
};

// Where on its curve a surface is thought to meet a target.
struct SearchStart {
  double log_lambda = 0;             // ln of squared model units per bit
  double log_bytes_per_decibel = 0;  // slope of the curve there; the typical one until attempts have told
};

// The slope of the rate-distortion curve at which streams usually are of that PSNR, squared model units per bit.
double UsualLambda(double psnr, double diagonal);

// All referenced objects must outlive the search.
class CandidateSearch {
 public:
  // remesh_psnr: of the unquantized remesh, dB.
  CandidateSearch(const NormalMeshCandidate& candidate, double remesh_psnr, const SurfaceDistanceMeter& meter,
                  const ResolvedTarget& target, EncodeMode mode, const SearchEffort& effort = SearchEffort());

  static constexpr int kMostMeasurements = 6;

  // Codes near the target with an attempt or two and extrapolates to it: ln(bytes) at the PSNR, or -PSNR at the bytes. Smaller is
  // better.
  StatusOr<double> Score();

  // Another search of the same surface may begin there.
  const SearchStart& start() const { return start_; }
  void BeginAt(const SearchStart& start) { start_ = start; }

  // Codes until the target is met: bytes within 2 % and never over, or a PSNR less than 0.3 dB over and never under. Where that
  // fails, the attempt that comes nearest, with meets_target telling whether it keeps to the side promised. The surface distance is
  // measured kMostMeasurements times at most, those of Score included, but where the curve of a small mesh jumps so much that none of them
  // is within the promise.
  StatusOr<MeasuredStream> Meet();

 private:
  struct Attempt {
    CodedStream stream;
    double log_lambda = 0;
    double psnr = 0;   // dB: estimated, or measured once it was
    double value = 0;  // as in values_
  };
  // How the steps follow from the slope of the coefficients: the slopes that give them, as multiples of it.
  struct StepChoice {
    double details = 1, base = 1;
  };
  // passes: of the descent; from: as for NormalMeshCandidate::Code.
  StatusOr<Attempt> Code(const StepChoice& steps, double log_lambda, int passes, int quality_layers, const CodedSurface* from = nullptr) const;
  // With the steps as they are; the first attempt is measured.
  StatusOr<Attempt> Try(double log_lambda, int passes, int quality_layers, const CodedSurface* from = nullptr);
  double EstimatePsnr(const CodedStream& stream) const;
  double MeasurePsnr(const Attempt& attempt, uint64_t num_samples);
  double Goal() const;  // the value aimed at
  // Of the distance that quantization alone may have where all have `psnr`: it follows the slope, while that of the remesh stays.
  double CodingPsnr(double psnr) const;
  double Miss(const Attempt& attempt) const;   // dB between it and the goal, >= 0
  double Merit(const Attempt& attempt) const;  // what Score returns, as one attempt lets think
  void LearnSlope(const Attempt& a, const Attempt& b);  // of the same surface at two values of lambda
  // An attempt of SuitSteps, or where it is far off the goal, one nearer to that.
  StatusOr<Attempt> NearGoal(StatusOr<Attempt> attempt, const StepChoice& steps) const;
  void SuitSteps();
  StatusOr<Attempt> Draw();
  std::optional<CodedSurface> SettleFrom(const Attempt& drawn) const;
  StatusOr<Attempt> Settle(const std::optional<CodedSurface>& from);
  StatusOr<MeasuredStream> MeetRate(Attempt drawn);
  StatusOr<MeasuredStream> MeetQuality(Attempt drawn);
  double TypicalSlope() const;
  // The attempts next to the goal: the coarsest that is not under it and the finest that is under it; values fall as lambda
  // grows, but for noise. Either may be missing.
  struct Bracket {
    std::map<double, double>::const_iterator above, below;
  };
  Bracket AroundGoal() const;
  bool IsBracket(const Bracket& bracket) const;
  double NextGuess() const;
  bool JumpsOverGoal() const;
  bool CannotReach() const;

  const NormalMeshCandidate& candidate_;
  const double remesh_psnr_;
  const SurfaceDistanceMeter& meter_;
  const ResolvedTarget target_;
  const EncodeMode mode_;
  const SearchEffort effort_;
  SearchStart start_;
  std::map<double, double> values_;  // of the attempts so far, by ln(lambda): ln(bytes) at a rate, else CodingPsnr of the estimate
  std::optional<double> offset_;     // dB that a measure showed more than the estimate, which hardly depends on lambda
  StepChoice steps_;
  int last_detailed_ = 1;  // level, 1 .. L
  bool values_are_measured_ = false;  // dB, where estimates do not lead to the target
  int measurements_ = 0;
};

}  // namespace lacerta

#endif  // LACERTA_DRACO_CANDIDATE_SEARCH_H_
