#include "pack/family_meter.h"

#include <algorithm>
#include <utility>

#include "draco/crowded_input.h"
#include "geometry/close_seams.h"
#include "geometry/triangle_tree.h"
#include "remesh/attributed_proxy.h"

namespace lacerta {
namespace {

// Of every attribute's target: sides of a seam that differ by less, as arithmetic of other tools leaves them, are no seam.
constexpr double kUnseen = 0.05;

constexpr uint64_t kSamples = 100'000;
constexpr uint64_t kPoseSamples = 50'000;  // in each pose

uint64_t SamplesOn(const TriangleMesh& surface) {
  const double crowding = TriangleTree(surface).Crowding();
  return crowding > kMostCrowding ? SamplesInCrowd(crowding, kSamples) : kSamples;
}

}  // namespace

void CloseUnseenSeams(std::vector<double> targets, double texture_size, AttributedMesh* mesh) {
  for (double& target : targets) target *= kUnseen;
  CloseSeams(targets, texture_size, mesh);
}

FamilyMeter::FamilyMeter(std::vector<const Primitive*> primitives, double error, const AttributeTargets& targets,
                         uint64_t texel_side, TexelScale texels_per_unit, const Skin* skin)
    : primitives_(std::move(primitives)), error_(error), attribute_targets_(targets),
      texels_per_unit_(std::move(texels_per_unit)), skin_(skin) {
  if (targets.custom > 0.0) custom_ = CustomAttributesOf(primitives_);
  StatusOr<AttributedMesh> original = ToAttributedMesh(primitives_, texels_per_unit_, OtherAttributes::kLeaveOut, skin_, custom_);
  status_ = original.status();
  if (!original.ok()) return;
  StatusOr<SurfaceErrorMeter> meter = SurfaceErrorMeter::Create(original.value(), static_cast<double>(texel_side));
  status_ = meter.status();
  if (!meter.ok()) return;
  for (size_t pose = 0; skin_ != nullptr && pose < skin_->poses.size(); ++pose) {
    StatusOr<TriangleMesh> surface = PosedSurface(primitives_, *skin_, pose);
    status_ = surface.status();
    if (!status_.ok()) return;
    StatusOr<SurfaceDistanceMeter> posed = SurfaceDistanceMeter::Create(surface.value());
    status_ = posed.status();
    if (!status_.ok()) return;
    poses_.push_back(std::move(posed).value());
  }
  original_ = std::move(original).value();
  num_samples_ = SamplesOn(original_.surface);
  meter_ = std::move(meter).value();
  targets_ = FamilyTargets(original_, error, targets, texel_side);
  // Errors are measured against what came in.
  CloseUnseenSeams(targets_.attributes, static_cast<double>(texel_side), &original_);
  leaves_out_ = HasOtherAttributes(primitives_, skin_, custom_);
}

Status FamilyMeter::UseProxy() {
  if (!status_.ok()) return Status();
  LACERTA_ASSIGN_OR_RETURN(proxy_, AttributedProxy(original_, *meter_, targets_));
  return Status();
}

StatusOr<SurfaceErrors> FamilyMeter::Measure(const std::vector<const Primitive*>& stored) const {
  LACERTA_ASSIGN_OR_RETURN(const AttributedMesh mesh,
                           ToAttributedMesh(stored, texels_per_unit_, OtherAttributes::kLeaveOut, skin_, custom_));
  LACERTA_ASSIGN_OR_RETURN(SurfaceErrors errors, meter_->Measure(mesh, num_samples_));
  // What has turned is a handful of samples: more of them where they are all that tells whether the targets are met.
  constexpr double kNear = 0.8;
  constexpr uint64_t kTimesMore = 3;
  if (errors.turned > kNear * targets_.turned && WorstRatio(errors, targets_) <= 1.0) {
    LACERTA_ASSIGN_OR_RETURN(errors, meter_->Measure(mesh, kTimesMore * num_samples_));
  }
  if (skin_ == nullptr) return errors;
  AttributeError& poses = errors.attributes[*IndexOf(kPosesName)];
  LACERTA_ASSIGN_OR_RETURN(poses.rms, WorstPose(stored));
  poses.rms_99 = poses.rms;
  return errors;
}

ErrorTargets FamilyMeter::TargetsWith(const std::vector<double>& everywhere) const {
  ErrorTargets targets = targets_;
  if (targets.everywhere.empty()) targets.everywhere = everywhere;
  for (size_t a = 0; a < everywhere.size(); ++a) targets.everywhere[a] = std::min(targets.everywhere[a], everywhere[a]);
  return targets;
}

StatusOr<double> FamilyMeter::WorstPose(const std::vector<const Primitive*>& stored) const {
  return WorstPose([&](size_t pose) { return PosedSurface(stored, *skin_, pose); }, kPoseSamples);
}

StatusOr<double> FamilyMeter::WorstPose(const std::function<StatusOr<TriangleMesh>(size_t pose)>& posed,
                                        uint64_t num_samples) const {
  double worst = 0.0;
  for (size_t pose = 0; pose < poses_.size(); ++pose) {
    LACERTA_ASSIGN_OR_RETURN(const TriangleMesh surface, posed(pose));
    LACERTA_ASSIGN_OR_RETURN(const SurfaceDistance distance,
                             poses_[pose].Measure(surface, SurfaceDistanceOptions::RmsOnly(num_samples)));
    worst = std::max(worst, distance.Rms());
  }
  return worst;
}

std::optional<size_t> FamilyMeter::IndexOf(const std::string& soup_name) const {
  for (size_t a = 0; a < original_.attributes.size(); ++a) {
    if (original_.attributes[a].name == soup_name) return a;
  }
  return std::nullopt;
}

double FamilyMeter::Reported(const SurfaceErrors& errors, size_t attribute) const {
  const double error = errors.attributes[attribute].rms_99;
  if (original_.attributes[attribute].kind != AttributeKind::kTextureCoordinates) return error;
  return error * attribute_targets_.uv_texels / targets_.attributes[attribute];  // of the scale that the target is in
}

}  // namespace lacerta
