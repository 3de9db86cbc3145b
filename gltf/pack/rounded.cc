#include "pack/rounded.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace lacerta {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TriangleMesh Joined(const std::vector<const Primitive*>& primitives) {
  TriangleMesh all;
  for (const Primitive* primitive : primitives) {
    const TriangleMesh part = Surface(*primitive);
    const auto offset = static_cast<uint32_t>(all.positions.size());
    all.positions.insert(all.positions.end(), part.positions.begin(), part.positions.end());
    for (const Triangle& t : part.triangles) all.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
  return all;
}

// Bits beyond those that the vertices alone ask for.
struct Extra {
  int positions = 0;
  std::map<size_t, int> attributes;  // by the index in the surface
};

struct Trial {
  Extra extra;
  RoundedFamily family;
  std::vector<double> ratios;  // of the attributes' errors to their targets
  double ratio = kInfinity;    // the worst of all
  uint64_t bytes = 0;
};

class FamilyRounder {
 public:
  FamilyRounder(const std::vector<const Primitive*>& primitives, double error, const AttributeTargets& targets,
                const TexelScale& texels_per_unit)
      : primitives_(primitives), error_(error), targets_(targets), texels_per_unit_(texels_per_unit),
        surface_(Joined(primitives)), lattice_(FindPositionLattice(surface_, error)) {
    for (size_t m = 0; m < primitives.size(); ++m) {
      attributes_.push_back(
          FindAttributeBits(*primitives[m], targets, [&](uint64_t set) { return texels_per_unit(m, set); }));
    }
  }

  StatusOr<RoundedFamily> Run(uint64_t texel_side) {
    StatusOr<AttributedMesh> original = ToAttributedMesh(primitives_, texels_per_unit_, OtherAttributes::kLeaveOut);
    StatusOr<SurfaceErrorMeter> meter = original.status();
    if (original.ok()) meter = SurfaceErrorMeter::Create(original.value(), static_cast<double>(texel_side));
    if (meter.ok()) {
      original_ = &original.value();
      meter_ = &meter.value();
      error_targets_ = FamilyTargets(*original_, error_, targets_, texel_side);
    }
    LACERTA_ASSIGN_OR_RETURN(Trial best, Try({}));
    for (int step = 1; best.ratio > 1.0;) {
      std::optional<Trial> next;
      for (const Extra& extra : Finer(best, step)) {
        LACERTA_ASSIGN_OR_RETURN(Trial trial, Try(extra));
        if (!next.has_value() || IsBetter(trial, *next, best)) next = std::move(trial);
      }
      if (!next.has_value()) return Unsupported("rounding misses the errors at every precision");
      // Where a bit hardly helps, several may.
      step = next->ratio > 0.9 * best.ratio ? 2 * step : 1;
      best = std::move(*next);
    }
    return std::move(best.family);
  }

 private:
  StatusOr<Trial> Try(const Extra& extra) const {
    Trial trial;
    trial.extra = extra;
    RoundedFamily& family = trial.family;
    family.lattice =
        extra.positions == 0 ? lattice_ : FindPositionLattice(surface_, error_, lattice_.lattice.bits + extra.positions);
    std::vector<const Primitive*> decoded;
    for (size_t m = 0; m < primitives_.size(); ++m) {
      DracoPrecision precision{family.lattice.lattice, attributes_[m].bits};
      std::vector<AttributeReport> reports = attributes_[m].reports;
      for (AttributeReport& report : reports) {
        const auto bits = precision.bits.find(report.name);
        const auto more = extra.attributes.find(IndexOf(m, report.name).value_or(kNone));
        if (bits == precision.bits.end() || more == extra.attributes.end()) continue;
        bits->second += more->second;
        report.bits = bits->second <= kMostLatticeBits ? bits->second : 0;
        if (report.bits == 0) precision.bits.erase(bits);  // exact
      }
      LACERTA_ASSIGN_OR_RETURN(DracoEncoded encoded, EncodeDracoPrimitive(*primitives_[m], precision));
      trial.bytes += encoded.bytes.size();
      family.members.push_back(std::move(encoded));
      family.precisions.push_back(std::move(precision));
      family.reports.push_back(std::move(reports));
    }
    for (const DracoEncoded& member : family.members) decoded.push_back(&member.decoded);
    if (meter_ == nullptr) {
      trial.ratio = 0.0;
      return trial;
    }
    constexpr uint64_t kSamples = 100'000;
    LACERTA_ASSIGN_OR_RETURN(const AttributedMesh mesh,
                             ToAttributedMesh(decoded, texels_per_unit_, OtherAttributes::kLeaveOut));
    const StatusOr<SurfaceErrors> errors = meter_->Measure(mesh, kSamples);
    trial.ratios.assign(original_->attributes.size(), 0.0);
    if (errors.ok()) Judge(errors.value(), &trial);  // else a group has lost its area
    return trial;
  }

  void Judge(const SurfaceErrors& errors, Trial* trial) const {
    RoundedFamily& family = trial->family;
    trial->ratio = WorstRatio(errors, error_targets_);
    for (size_t a = 0; a < original_->attributes.size(); ++a) {
      trial->ratios[a] = errors.attributes[a].rms_99 / error_targets_.attributes[a];
      const AttributeKind kind = original_->attributes[a].kind;
      const bool direction = kind == AttributeKind::kNormal || kind == AttributeKind::kTangent;
      family.everywhere.push_back(direction ? std::max(errors.attributes[a].rms, error_targets_.attributes[a])
                                            : kInfinity);
    }
    family.lattice.error = std::max(family.lattice.error, errors.distance);
    for (size_t m = 0; m < family.reports.size(); ++m) {
      for (AttributeReport& report : family.reports[m]) {
        const std::optional<size_t> a = IndexOf(m, report.name);
        if (!a.has_value()) continue;
        report.error = std::max(report.error, ReportedError(*original_, errors, error_targets_, targets_, *a));
      }
    }
  }

  // Finer positions, or finer values of what misses its target.
  std::vector<Extra> Finer(const Trial& trial, int step) const {
    std::vector<Extra> result;
    const int room = kMostLatticeBits - trial.family.lattice.lattice.bits;
    if (room > 0) {
      result.push_back(trial.extra);
      result.back().positions += std::min(step, room);
    }
    for (size_t a = 0; a < trial.ratios.size(); ++a) {
      if (trial.ratios[a] <= 1.0 || IsExact(trial, a)) continue;
      result.push_back(trial.extra);
      result.back().attributes[a] += step;
    }
    return result;
  }

  bool IsExact(const Trial& trial, size_t attribute) const {
    for (size_t m = 0; m < primitives_.size(); ++m) {
      for (const AttributeReport& report : trial.family.reports[m]) {
        if (report.bits > 0 && IndexOf(m, report.name) == attribute) return false;
      }
    }
    return true;
  }

  // The smaller of two that meet the targets; else the one that comes nearer to them for the bytes it adds.
  static bool IsBetter(const Trial& a, const Trial& b, const Trial& before) {
    if (a.ratio <= 1.0 || b.ratio <= 1.0) {
      return a.ratio <= 1.0 && (b.ratio > 1.0 || a.bytes < b.bytes);
    }
    const auto gain = [&](const Trial& trial) {
      if (!std::isfinite(before.ratio)) return -trial.ratio;
      const double bytes = static_cast<double>(trial.bytes) - static_cast<double>(before.bytes);
      return std::log(before.ratio / trial.ratio) / std::max(bytes, 1.0);
    };
    return gain(a) > gain(b);
  }

  std::optional<size_t> IndexOf(size_t member, const std::string& name) const {
    if (original_ == nullptr) return std::nullopt;
    return AttributeOf(*original_, *primitives_[member], name, member, texels_per_unit_);
  }

  static constexpr size_t kNone = ~size_t{0};
  const std::vector<const Primitive*>& primitives_;
  const double error_;
  const AttributeTargets& targets_;
  const TexelScale& texels_per_unit_;
  const TriangleMesh surface_;
  const SharedLattice lattice_;
  std::vector<AttributePrecision> attributes_;  // parallel to the primitives
  const AttributedMesh* original_ = nullptr;    // null where there is nothing to measure
  const SurfaceErrorMeter* meter_ = nullptr;
  ErrorTargets error_targets_;
};

}  // namespace

StatusOr<RoundedFamily> RoundFamily(const std::vector<const Primitive*>& primitives, double error,
                                    const AttributeTargets& targets, uint64_t texel_side,
                                    const TexelScale& texels_per_unit) {
  return FamilyRounder(primitives, error, targets, texels_per_unit).Run(texel_side);
}

}  // namespace lacerta
