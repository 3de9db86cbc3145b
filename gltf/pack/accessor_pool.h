// Accessors of primitives that are stored anew: the old ones are given back and used again, so that indices that others
// hold stay true and no unused accessor piles up.
#ifndef LACERTA_PACK_ACCESSOR_POOL_H_
#define LACERTA_PACK_ACCESSOR_POOL_H_

#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "document/gltf_document.h"
#include "document/place.h"

namespace lacerta {

// By accessor: how often skins, animations and extensions refer to it, or may.
std::vector<uint64_t> CountOtherUsers(const GltfDocument& document);

class AccessorPool {
 public:
  // Counts who refers to which accessor: `geometries` (one primitive of each) and others.
  AccessorPool(const GltfDocument& document, const std::vector<Place>& geometries);

  // The geometry of `primitive` needs its accessors no more, those of its morph targets included if asked. Call once per
  // geometry.
  void Release(const Json& primitive, bool with_targets, GltfDocument* document);

  // Puts `accessor` at the index `preferred` if that is free, else at another free one, else at the end; returns where.
  uint64_t Put(Json accessor, std::optional<uint64_t> preferred, GltfDocument* document);

  // bufferViews that released accessors referred to.
  const std::set<uint64_t>& released_views() const { return released_views_; }

 private:
  void ReleaseOne(const Json& reference, GltfDocument* document);

  std::vector<uint64_t> users_;
  std::set<uint64_t> free_;
  std::set<uint64_t> released_views_;
};

}  // namespace lacerta

#endif  // LACERTA_PACK_ACCESSOR_POOL_H_
