// The two mesh types that travel between the stages of the codec.
#ifndef LACERTA_MESH_H_
#define LACERTA_MESH_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "lacerta/vec3.h"

namespace lacerta {

using Bytes = std::vector<uint8_t>;
using Triangle = std::array<uint32_t, 3>;  // vertex indices, counterclockwise seen from outside

// A read-only view of contiguous values that somebody else owns.
template <typename T>
class Span {
 public:
  Span() = default;
  Span(const T* data, size_t size) : data_(data), size_(size) {}
  // NOLINTNEXTLINE: implicit on purpose
  Span(const std::vector<std::remove_const_t<T>>& values) : data_(values.data()), size_(values.size()) {}

  const T* data() const { return data_; }
  size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const T& operator[](size_t i) const { return data_[i]; }
  const T* begin() const { return data_; }
  const T* end() const { return data_ + size_; }
  // The part from `offset` on; offset <= size().
  Span Subspan(size_t offset) const { return {data_ + offset, size_ - offset}; }
  Span First(size_t count) const { return {data_, count}; }

 private:
  const T* data_ = nullptr;
  size_t size_ = 0;
};

// An irregular triangle mesh: what glTF and Draco hold.
struct TriangleMesh {
  std::vector<Vec3f> positions;     // #V
  std::vector<Triangle> triangles;  // #F, indices < #V
};

// What a base mesh says beyond its triangles. Every vector may be empty: nothing of the kind.
struct BaseTags {
  std::vector<uint8_t> still;    // #F0, 1: the triangle is never split (components kept as they are)
  std::vector<uint8_t> crease;   // #E of the topology of the split triangles, 1: a crease, which stencils do not cross
  std::vector<uint8_t> corner;   // #V0, 1: the curve that passes here (two border or crease edges) bends sharply
  // #V0, the first vertex at the same position. Border edges that join the same two of them are one curve, cut where the
  // surface is not manifold: the midpoints of all of them take the position of the first one's.
  std::vector<uint32_t> joined;

  bool empty() const { return still.empty() && crease.empty() && corner.empty() && joined.empty(); }
};

// A mesh with subdivision connectivity. Level 0 is the base mesh; level i+1 splits every triangle of level i into four.
// The transform is interpolating, so the positions of level i are the first ones of the finest level: the vertices of
// level i come first, then one new vertex per edge of level i in the order of its edges (common/subdivision.h).
struct SemiRegularMesh {
  std::vector<Triangle> base_triangles;  // #F0
  uint32_t num_base_vertices = 0;        // #V0
  int num_levels = 0;                    // levels above the base
  std::vector<Vec3f> positions;          // #V of the finest level
  BaseTags tags = {};
};

}  // namespace lacerta

#endif  // LACERTA_MESH_H_
