// The encoding side of MeshGrower (common/valence_coding.h): follows the growing region on the mesh that is coded.
#ifndef LACERTA_ENCODER_GROWTH_GUIDE_H_
#define LACERTA_ENCODER_GROWTH_GUIDE_H_

#include <array>
#include <cstdint>
#include <vector>

#include "common/valence_coding.h"
#include "encoder/closed_mesh.h"

namespace lacerta {

class GrowthGuide {
 public:
  // mesh: must outlive the guide. The first component starts at corner `corner` of triangle `first`, the others at corner 0 of
  // the first of their triangles.
  GrowthGuide(const ClosedMesh& mesh, uint32_t first, uint32_t corner);

  std::array<uint32_t, 3> Start();
  GrowthStep Ask(const GrowingFront& front, uint32_t focus);
  void Started(const std::array<uint32_t, 3>& entries);
  void Added(uint32_t focus, uint32_t entry);
  void Joined(uint32_t focus, uint32_t target, uint32_t other);
  void Closed(uint32_t before, uint32_t removed);

  // The vertex of the mesh behind each coded vertex.
  const std::vector<uint32_t>& vertex_map() const { return vertex_map_; }

 private:
  // The half-edge of the triangle beyond entry -> next, and back.
  void SetGate(uint32_t entry, uint32_t half_edge);
  // The new triangle on the focus's gate: the focus's new gate, or that of the entry before the new vertex's end, is beyond its side.
  void Take(uint32_t gate, uint32_t first_entry, uint32_t second_entry);

  const ClosedMesh& mesh_;
  const uint32_t first_, corner_;
  uint32_t next_start_ = 0;
  uint32_t start_ = kNone;             // half-edge
  std::vector<uint32_t> gate_;         // by entry: a half-edge outside
  std::vector<uint32_t> entry_;        // by half-edge outside, that is a gate
  std::vector<uint8_t> is_taken_;      // by triangle
  std::vector<uint8_t> is_known_;      // by vertex
  std::vector<uint32_t> vertex_map_;
};

}  // namespace lacerta

#endif  // LACERTA_ENCODER_GROWTH_GUIDE_H_
