// What all mesh readers check in the same way and in the same words.
#ifndef LACERTA_MESH_FILE_MESH_BUILDER_H_
#define LACERTA_MESH_FILE_MESH_BUILDER_H_

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// How positions are taken.
struct PositionRules {
  Vec3d origin = {};            // they are relative to it
  bool keep_not_finite = false;  // those that are not finite become NaN, for RemoveNotFinite, instead of being refused
  // Called now and then with a place in the bytes before which nothing is looked at any more; may be empty.
  std::function<void(const void* end)> passed;

  // For readers that are about to take thing number i, the bytes of which begin at `end`.
  void Pass(uint64_t i, const void* end) const {
    constexpr uint64_t kThings = 1 << 16;
    if (i % kThings == kThings - 1 && passed) passed(end);
  }
};

// Appends a position; fails with kInvalidData when a coordinate is not finite as a float, unless such are kept.
Status AppendPosition(double x, double y, double z, const PositionRules& rules, TriangleMesh* mesh);

// Appends a polygon as a fan around its first corner. `face` is its number in the file, counted from 0. Indices are
// counted from 0 and have to lie below num_vertices, which need not be mesh->positions.size() yet.
Status AppendPolygon(const std::vector<int64_t>& corners, uint64_t num_vertices, uint64_t face, TriangleMesh* mesh);

// Fails unless there is something to compress: at least one triangle.
Status CheckNotEmpty(const TriangleMesh& mesh);

// Fails when `count` things that take at least `bytes_each` bytes cannot fit into `available` bytes of file.
Status CheckCount(uint64_t count, uint64_t bytes_each, uint64_t available, const std::string& what);

}  // namespace lacerta

#endif  // LACERTA_MESH_FILE_MESH_BUILDER_H_
