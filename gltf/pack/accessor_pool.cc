#include "pack/accessor_pool.h"

#include <functional>
#include <string>
#include <utility>

#include "document/buffer_edit.h"
#include "document/view_references.h"

namespace lacerta {
namespace {

// Every integer inside, wherever it stands: for extensions, where any number may be an accessor.
void VisitIntegers(const Json& json, const std::function<void(const Json&)>& visit) {
  if (json.is_structured()) {
    for (const Json& element : json) VisitIntegers(element, visit);
  } else if (AsIndex(&json).has_value()) {
    visit(json);
  }
}

// Calls visit on every extensions object of the document.
void VisitExtensions(const Json& json, const std::function<void(const Json&)>& visit) {
  if (json.is_object()) {
    for (const auto& [key, value] : json.items()) {
      if (key == "extensions") {
        visit(value);
      } else if (key != "extras") {
        VisitExtensions(value, visit);
      }
    }
  } else if (json.is_array()) {
    for (const Json& element : json) VisitExtensions(element, visit);
  }
}

void Count(const Json& references, std::vector<uint64_t>* users) {
  VisitIntegers(references, [&](const Json& reference) {
    const uint64_t index = *AsIndex(&reference);
    if (index < users->size()) ++(*users)[static_cast<size_t>(index)];
  });
}

}  // namespace

std::vector<uint64_t> CountOtherUsers(const GltfDocument& document) {
  std::vector<uint64_t> users(static_cast<size_t>(ArraySize(document.json, "accessors")), 0);
  for (uint64_t i = 0; i < ArraySize(document.json, "skins"); ++i) {
    if (const Json* matrices = Find(*FindElement(document.json, "skins", i), "inverseBindMatrices");
        matrices != nullptr) {
      Count(*matrices, &users);
    }
  }
  for (uint64_t i = 0; i < ArraySize(document.json, "animations"); ++i) {
    if (const Json* samplers = Find(*FindElement(document.json, "animations", i), "samplers"); samplers != nullptr) {
      Count(*samplers, &users);
    }
  }
  // Extensions of nodes and the like; too many is better than too few. Those of primitives that hold geometry are
  // looked at by ReasonToKeep, and Draco's own numbers are no accessors.
  VisitExtensions(document.json, [&](const Json& extensions) {
    if (!extensions.is_object()) return;
    for (const auto& [name, value] : extensions.items()) {
      if (!RefersToNoData(name)) Count(value, &users);
    }
  });
  return users;
}

AccessorPool::AccessorPool(const GltfDocument& document, const std::vector<Place>& geometries) : users_(CountOtherUsers(document)) {
  for (const Place& place : geometries) {
    const Json& primitive = PrimitiveAt(document, place);
    for (const char* key : {"attributes", "indices", "targets"}) {
      if (const Json* references = Find(primitive, key); references != nullptr) Count(*references, &users_);
    }
  }
}

void AccessorPool::ReleaseOne(const Json& reference, GltfDocument* document) {
  const std::optional<uint64_t> index = AsIndex(&reference);
  if (!index.has_value() || *index >= users_.size()) return;
  uint64_t& users = users_[static_cast<size_t>(*index)];
  if (users == 0 || --users > 0) return;
  const std::set<uint64_t> views = ViewsOfAccessor(*document, *index);
  released_views_.insert(views.begin(), views.end());
  Json& accessor = document->json["accessors"][static_cast<size_t>(*index)];
  for (const char* key : {"bufferView", "byteOffset", "sparse", "min", "max"}) accessor.erase(key);
  accessor["count"] = 1;  // stands until it is used again: one zero
  free_.insert(*index);
}

void AccessorPool::Release(const Json& primitive, bool with_targets, GltfDocument* document) {
  const auto release_all = [&](const Json* attributes) {
    if (attributes == nullptr || !attributes->is_object()) return;
    for (const Json& reference : *attributes) ReleaseOne(reference, document);
  };
  release_all(Find(primitive, "attributes"));
  for (uint64_t t = 0; with_targets && t < ArraySize(primitive, "targets"); ++t) {
    release_all(FindElement(primitive, "targets", t));
  }
  if (const Json* indices = Find(primitive, "indices"); indices != nullptr) ReleaseOne(*indices, document);
}

uint64_t AccessorPool::Put(Json accessor, std::optional<uint64_t> preferred, GltfDocument* document) {
  const bool take_preferred = preferred.has_value() && free_.count(*preferred) > 0;
  if (!take_preferred && free_.empty()) return AddAccessor(std::move(accessor), document);
  const uint64_t index = take_preferred ? *preferred : *free_.begin();
  free_.erase(index);
  Json& place = document->json["accessors"][static_cast<size_t>(index)];
  if (take_preferred) {
    for (const char* key : {"name", "extras"}) {
      if (const Json* kept = Find(place, key); kept != nullptr) accessor[key] = *kept;
    }
  }
  place = std::move(accessor);
  return index;
}

}  // namespace lacerta
