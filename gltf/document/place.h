// Where a primitive is in a document.
#ifndef LACERTA_DOCUMENT_PLACE_H_
#define LACERTA_DOCUMENT_PLACE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "document/gltf_document.h"

namespace lacerta {

struct Place {
  uint64_t mesh = 0;
  uint64_t primitive = 0;
};

// "mesh 2 (Helmet), primitive 0", for messages.
std::string PlaceName(const GltfDocument& document, const Place& place);

// The primitive at a place that exists.
const Json& PrimitiveAt(const GltfDocument& document, const Place& place);
Json& PrimitiveAt(GltfDocument* document, const Place& place);

// All primitives in their order.
std::vector<Place> AllPlaces(const GltfDocument& document);

// All primitives, those with the same vertices and indices together.
std::vector<std::vector<Place>> GroupByGeometry(const GltfDocument& document);

}  // namespace lacerta

#endif  // LACERTA_DOCUMENT_PLACE_H_
