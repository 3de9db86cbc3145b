#include "shown_level.h"

#include <algorithm>
#include <utility>

#include "lacerta/attributed_base.h"

namespace lacerta {

StatusOr<LevelView> ShownLevel::Plain(const ProgressiveDecoder& decoder, int level) {
  const bool is_finest = level == decoder.level();
  if (level_ != level) {
    Forget();
    if (is_finest) {
      mesh_ = TriangleMesh{{}, decoder.Triangles()};
    } else {
      LACERTA_ASSIGN_OR_RETURN(mesh_, MeshAtLevel(decoder.mesh(), level));
    }
    level_ = level;
  }
  return LevelView{is_finest ? decoder.mesh().positions : mesh_.positions, mesh_.triangles};
}

StatusOr<const std::vector<VertexSoup>*> ShownLevel::Groups(const ProgressiveDecoder& decoder, int level, size_t num_groups) {
  if (level_ != level) {
    Forget();
    LACERTA_ASSIGN_OR_RETURN(const AttributedMesh mesh, AttributedMeshAtLevel(decoder, level));
    groups_ = SplitIntoSoups(mesh, static_cast<uint32_t>(num_groups));
    level_ = level;
  }
  return &groups_;
}

VertexSoup JoinedGroups(const std::vector<VertexSoup>& groups) {
  VertexSoup all;
  for (const VertexSoup& group : groups) {
    const auto first = static_cast<uint32_t>(all.positions.size());
    all.positions.insert(all.positions.end(), group.positions.begin(), group.positions.end());
    for (const Triangle& t : group.triangles) all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    for (const VertexSoup::Attribute& from : group.attributes) {
      auto to = std::find_if(all.attributes.begin(), all.attributes.end(), [&](const VertexSoup::Attribute& a) { return a.name == from.name; });
      if (to == all.attributes.end()) to = all.attributes.insert(to, {from.name, from.kind, from.components, {}});
      to->values.resize(size_t{first} * to->components);
      to->values.insert(to->values.end(), from.values.begin(), from.values.end());
    }
  }
  for (VertexSoup::Attribute& a : all.attributes) a.values.resize(all.positions.size() * a.components);
  return all;
}

}  // namespace lacerta
