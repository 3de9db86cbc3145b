// Morph targets in a stream: attributes that hold one of the offsets of many targets, three components for each.
#ifndef LACERTA_EXTENSION_TARGET_CHANNELS_H_
#define LACERTA_EXTENSION_TARGET_CHANNELS_H_

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "lacerta/attributed_mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// TARGETS_42_NORMAL: NORMAL of the targets from the 43rd on, as many as the components tell.
struct TargetChannels {
  size_t first = 0;
  std::string attribute;  // POSITION, NORMAL or TANGENT
};

// Draco has room for 127 components.
inline constexpr size_t kMostTargetsTogether = 42;

std::string NameOf(const TargetChannels& channels);
// Empty for other names.
std::optional<TargetChannels> ParseTargetChannels(const std::string& name);

// Of each target its attributes, of three components and with their names in glTF.
using SoupTargets = std::vector<std::vector<VertexSoup::Attribute>>;

// Takes the channels out of a soup. Fails with kInvalidData where targets are missing or come twice.
StatusOr<SoupTargets> TakeTargetChannels(VertexSoup* soup);

}  // namespace lacerta

#endif  // LACERTA_EXTENSION_TARGET_CHANNELS_H_
