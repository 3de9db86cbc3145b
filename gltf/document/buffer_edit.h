// Changing what a document holds: new bufferViews and accessors, dropping unused views.
#ifndef LACERTA_DOCUMENT_BUFFER_EDIT_H_
#define LACERTA_DOCUMENT_BUFFER_EDIT_H_

#include <cstdint>
#include <set>
#include <vector>

#include "document/accessor.h"
#include "document/gltf_document.h"
#include "document/primitive.h"

namespace lacerta {

// Appends a buffer of its own that holds `bytes`; returns its index.
uint64_t AddBuffer(Bytes bytes, GltfDocument* document);

// Lets a view or what is in it begin at `offset`; 0 goes without saying.
void PlaceAt(uint64_t offset, Json* part);

// Appends a view of a part of a buffer; returns its index.
uint64_t AddBufferView(uint64_t buffer, uint64_t offset, uint64_t length, GltfDocument* document);

enum class AccessorUse { kAttribute, kIndices };

// The JSON of an accessor over `data` with a buffer and a view of its own; min and max are given where `bounds` is set.
Json MakeAccessor(const AccessorData& data, AccessorUse use, bool bounds, GltfDocument* document);
// What becomes an accessor. The data may hold 2^32 elements at most.
struct SparseSource {
  const AccessorData* data;
  bool bounds;
};
// The same, but with the elements that are not zero alone, and no data for the others; all share a view of indices and one of values.
std::vector<Json> MakeSparseAccessors(const std::vector<SparseSource>& sources, GltfDocument* document);
bool SparseIsSmaller(const AccessorData& data);  // with its JSON
// Bytes of the smaller of the two, with the JSON of a sparse part.
uint64_t StoredSize(const AccessorData& data);
// The same without any data: what a compressed primitive shows.
Json DescribeAccessor(const AccessorData& data, bool bounds);

uint64_t AddAccessor(Json accessor, GltfDocument* document);

// Drops those of `candidates` that nothing refers to any more and renumbers the others. Where the asset uses an
// extension that may refer to bufferViews in a way of its own, they are cut down to a few bytes instead.
void DropUnusedViews(const std::set<uint64_t>& candidates, GltfDocument* document);

}  // namespace lacerta

#endif  // LACERTA_DOCUMENT_BUFFER_EDIT_H_
