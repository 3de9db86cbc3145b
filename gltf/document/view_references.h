// What of a document refers to which bufferViews, and to which of their bytes.
#ifndef LACERTA_DOCUMENT_VIEW_REFERENCES_H_
#define LACERTA_DOCUMENT_VIEW_REFERENCES_H_

#include <cstdint>
#include <functional>
#include <set>
#include <string>

#include "document/gltf_document.h"

namespace lacerta {

// Calls visit(value) on every reference to a bufferView: by the key "bufferView" wherever it is, and "data" and
// "refinements" of our extension.
void VisitViewReferences(Json& json, const std::function<void(Json&)>& visit);

// Whether an extension is known to refer to no accessor, and to bufferViews by the key "bufferView" or not at all.
bool RefersToNoData(const std::string& extension);

// Whether VisitViewReferences finds them all: of the extensions that the asset uses, none is known to refer to bufferViews
// in a way of its own.
bool AreViewReferencesKnown(const GltfDocument& document);

// The bufferViews that accessor `index` refers to, itself or through its sparse part.
std::set<uint64_t> ViewsOfAccessor(const GltfDocument& document, uint64_t index);

// VisitParts of all accessors.
void VisitAccessorParts(Json& json, const std::function<void(Json& part, uint64_t size, uint64_t count)>& visit);

}  // namespace lacerta

#endif  // LACERTA_DOCUMENT_VIEW_REFERENCES_H_
