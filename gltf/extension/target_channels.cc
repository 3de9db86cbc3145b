#include "extension/target_channels.h"

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <map>
#include <utility>

namespace lacerta {
namespace {

constexpr char kPrefix[] = "TARGETS_";

}  // namespace

std::string NameOf(const TargetChannels& channels) {
  return kPrefix + std::to_string(channels.first) + "_" + channels.attribute;
}

std::optional<TargetChannels> ParseTargetChannels(const std::string& name) {
  if (name.rfind(kPrefix, 0) != 0) return std::nullopt;
  const std::string rest = name.substr(std::size(kPrefix) - 1);
  const TargetChannels channels{std::strtoul(rest.c_str(), nullptr, 10), rest.substr(rest.find('_') + 1)};
  const std::string& of = channels.attribute;
  // Numbers in another form, and what is too large, do not come back.
  if ((of != "POSITION" && of != "NORMAL" && of != "TANGENT") || NameOf(channels) != name) return std::nullopt;
  return channels;
}

StatusOr<SoupTargets> TakeTargetChannels(VertexSoup* soup) {
  SoupTargets targets;
  std::map<std::string, size_t> known;  // targets that have the attribute
  std::vector<VertexSoup::Attribute> others;
  for (VertexSoup::Attribute& attribute : soup->attributes) {
    const std::optional<TargetChannels> channels = ParseTargetChannels(attribute.name);
    if (!channels.has_value()) {
      others.push_back(std::move(attribute));
      continue;
    }
    size_t& count = known[channels->attribute];
    if (channels->first != count || attribute.components % 3 != 0)
      return InvalidData("attribute " + attribute.name + " is not of the targets after those before");
    const size_t num_targets = attribute.components / 3;
    targets.resize(std::max(targets.size(), count + num_targets));
    for (size_t t = 0; t < num_targets; ++t) {
      VertexSoup::Attribute offsets{channels->attribute, attribute.kind, 3, {}};
      offsets.values.reserve(3 * soup->positions.size());
      for (size_t v = 0; v < soup->positions.size(); ++v) {
        const auto row = attribute.values.begin() + static_cast<std::ptrdiff_t>(v * attribute.components + 3 * t);
        offsets.values.insert(offsets.values.end(), row, row + 3);
      }
      targets[count + t].push_back(std::move(offsets));
    }
    count += num_targets;
  }
  for (const auto& [name, count] : known) {
    if (count != targets.size()) return InvalidData("some targets have no " + name);
  }
  soup->attributes = std::move(others);
  return targets;
}

}  // namespace lacerta
