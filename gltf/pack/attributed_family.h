// Primitives that touch as one surface with attributes, to be measured as a viewer shows them.
#ifndef LACERTA_PACK_ATTRIBUTED_FAMILY_H_
#define LACERTA_PACK_ATTRIBUTED_FAMILY_H_

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "decoder/joint_weights.h"
#include "document/primitive.h"
#include "lacerta/attributed_mesh.h"
#include "lacerta/gltf.h"
#include "lacerta/status.h"
#include "pack/skin.h"
#include "pack/texel_scale.h"
#include "remesh/simplify_to_errors.h"

namespace lacerta {

// The name of an attribute in the surface: texture coordinates of unlike scales are attributes of their own, each with
// its own target.
std::string SoupName(const Attribute& attribute, size_t member, const TexelScale& scale);

// Application attributes that mean something between vertices: floats in up to four finite components wherever the primitives have
// them, not all of them whole numbers, which may name something.
std::set<std::string> CustomAttributesOf(const std::vector<const Primitive*>& primitives);

// What becomes of attributes that have no meaning between vertices (joints without a skin, application attributes but those of `custom`).
enum class OtherAttributes { kRefuse, kLeaveOut };

// In place of joints and weights: where the surface is in every pose of the skin, so that a difference is a distance in mesh
// units, root mean square over the poses. 3 numbers for each pose, over the root of the number of poses.
inline constexpr const char* kPosesName = "POSES";

// Primitive m becomes group m. With `joints`, all that move a vertex, what stands for the skin are the weights of these
// instead of poses. Fails with kUnsupported on attributes to refuse, and like WeldSoups and, where there is a skin,
// ReadInfluences.
StatusOr<AttributedMesh> ToAttributedMesh(const std::vector<const Primitive*>& primitives, const TexelScale& scale,
                                          OtherAttributes others = OtherAttributes::kRefuse, const Skin* skin = nullptr,
                                          const std::set<std::string>& custom = {}, const JointTable& joints = {});

// Whether there are any of those.
bool HasOtherAttributes(const std::vector<const Primitive*>& primitives, const Skin* skin = nullptr,
                        const std::set<std::string>& custom = {});

// The targets in the units of SurfaceErrorMeter with textures of `texel_side`; `error` in mesh units, of the surface and, over
// the whole of it, of its poses; offsets of morph targets get a share of it.
ErrorTargets FamilyTargets(const AttributedMesh& original, double error, const AttributeTargets& targets,
                           uint64_t texel_side);

}  // namespace lacerta

#endif  // LACERTA_PACK_ATTRIBUTED_FAMILY_H_
