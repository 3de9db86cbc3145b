// The level of a stream that its caller reads, group by group, in memory of the decoder.
#ifndef LACERTA_PLUGIN_C_SHOWN_LEVEL_H_
#define LACERTA_PLUGIN_C_SHOWN_LEVEL_H_

#include <cstdint>
#include <vector>

#include "lacerta/attributed_mesh.h"
#include "lacerta/decoder.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// One group of a level, or all of them as one.
struct LevelView {
  Span<const Vec3f> positions;
  Span<const Triangle> triangles;
  const std::vector<VertexSoup::Attribute>* attributes = nullptr;  // those that the group has; null: none
};

class ShownLevel {
 public:
  // Bytes have come: what was made of a level may not be the finest any more.
  void Forget() { level_ = -1; }

  // Of a decoder without attributes, all as one.
  StatusOr<LevelView> Plain(const ProgressiveDecoder& decoder, int level);
  // The groups of a level > 0 of a decoder with attributes.
  StatusOr<const std::vector<VertexSoup>*> Groups(const ProgressiveDecoder& decoder, int level, size_t num_groups);

 private:
  int level_ = -1;                  // that the following are of; -1: none
  TriangleMesh mesh_;               // without positions where they are the decoder's
  std::vector<VertexSoup> groups_;
};

// The groups as one soup, one after the other. Attributes that a group has not got are 0 there.
VertexSoup JoinedGroups(const std::vector<VertexSoup>& groups);

}  // namespace lacerta

#endif  // LACERTA_PLUGIN_C_SHOWN_LEVEL_H_
