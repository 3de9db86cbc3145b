// What a viewer sees of a family of primitives once they are stored anew, held against the originals.
#ifndef LACERTA_PACK_FAMILY_METER_H_
#define LACERTA_PACK_FAMILY_METER_H_

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "document/primitive.h"
#include "lacerta/attributed_mesh.h"
#include "lacerta/gltf.h"
#include "lacerta/status.h"
#include "lacerta/surface_distance.h"
#include "pack/attributed_family.h"
#include "remesh/simplify_to_errors.h"

namespace lacerta {

class FamilyMeter {
 public:
  // `error` (d_S, mesh units) and `targets` (RMS over the 99 % of the area where it is least) are what is allowed;
  // `texel_side` is the side of the texture that texels are of. With a skin, `error` is allowed in all its poses, too. Refers to
  // the primitives and to the skin.
  FamilyMeter(std::vector<const Primitive*> primitives, double error, const AttributeTargets& targets,
              uint64_t texel_side, TexelScale texels_per_unit, const Skin* skin = nullptr);

  // Not OK where there is no area, so nothing to measure: nothing below but the first six is to be called then.
  const Status& status() const { return status_; }
  const std::vector<const Primitive*>& primitives() const { return primitives_; }
  const AttributeTargets& attribute_targets() const { return attribute_targets_; }
  const TexelScale& texels_per_unit() const { return texels_per_unit_; }
  double error() const { return error_; }
  const Skin* skin() const { return skin_; }  // null: nothing moves the surface

  // What is to be stored: without what ToAttributedMesh leaves out, and without seams that nobody sees (CloseSeams).
  const AttributedMesh& original() const { return original_; }
  // What is simplified and remeshed: the original, or what stands for it after UseProxy.
  const AttributedMesh& simplifiable() const { return proxy_ ? *proxy_ : original_; }
  bool has_proxy() const { return proxy_.has_value(); }
  const SurfaceErrorMeter& meter() const { return *meter_; }
  const ErrorTargets& targets() const { return targets_; }
  bool leaves_out() const { return leaves_out_; }  // joints without a skin, application attributes that stay exact
  const std::set<std::string>& custom() const { return custom_; }  // application attributes that do not

  // Lets the original's AttributedProxy stand for it, where it has one. Fails, with the reason, where it tells that neither a simplified
  // nor a remeshed surface is of use.
  Status UseProxy();

  // The targets with bounds `everywhere` (as in ErrorTargets; may be empty) besides those that they have.
  ErrorTargets TargetsWith(const std::vector<double>& everywhere) const;

  // Of primitives stored in the order of the originals. With a skin, the error of kPosesName is WorstPose. Fails where one has lost
  // its area.
  StatusOr<SurfaceErrors> Measure(const std::vector<const Primitive*>& stored) const;

  // d_S of the surface in the pose in which it is farthest from the original's, mesh units. Only with a skin.
  StatusOr<double> WorstPose(const std::vector<const Primitive*>& stored) const;
  // The same of whatever `posed` makes of the surface in a pose of the skin.
  StatusOr<double> WorstPose(const std::function<StatusOr<TriangleMesh>(size_t pose)>& posed,
                             uint64_t num_samples) const;

  // The attribute of the original whose name in the surface (SoupName) this is; empty where it was left out.
  std::optional<size_t> IndexOf(const std::string& soup_name) const;

  // An error in the unit of the attribute targets.
  double Reported(const SurfaceErrors& errors, size_t attribute) const;

 private:
  const std::vector<const Primitive*> primitives_;
  const double error_;
  const AttributeTargets attribute_targets_;
  const TexelScale texels_per_unit_;
  const Skin* const skin_;
  Status status_;
  AttributedMesh original_;
  std::optional<AttributedMesh> proxy_;
  std::optional<SurfaceErrorMeter> meter_;
  uint64_t num_samples_ = 0;  // that Measure takes
  std::vector<SurfaceDistanceMeter> poses_;  // of the skin's
  ErrorTargets targets_;
  bool leaves_out_ = false;
  std::set<std::string> custom_;
};

// CloseSeams where sides differ by a small share of an attribute's target.
void CloseUnseenSeams(std::vector<double> targets, double texture_size, AttributedMesh* mesh);

}  // namespace lacerta

#endif  // LACERTA_PACK_FAMILY_METER_H_
