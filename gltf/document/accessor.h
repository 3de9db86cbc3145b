// The values behind a glTF accessor, with every range checked.
#ifndef LACERTA_DOCUMENT_ACCESSOR_H_
#define LACERTA_DOCUMENT_ACCESSOR_H_

#include <cstdint>
#include <vector>

#include "document/gltf_document.h"
#include "lacerta/status.h"

namespace lacerta {

enum class ComponentType : uint32_t {
  kInt8 = 5120,
  kUint8 = 5121,
  kInt16 = 5122,
  kUint16 = 5123,
  kUint32 = 5125,
  kFloat = 5126
};

size_t ComponentSize(ComponentType type);  // bytes
// Bytes of a component and of an element of an accessor or a sparse part, 0 where the JSON does not tell them.
uint64_t ComponentSizeOf(const Json& object);
uint64_t ElementSize(const Json& accessor);

// Calls visit(part, size, count) on all that an accessor consists of, itself and the indices and values of its sparse part: `part` holds "bufferView" and
// "byteOffset" of so many elements of so many bytes. Sizes and counts are 0 where the JSON does not tell them. AnyJson: const Json or Json.
template <typename AnyJson, typename Visit>
void VisitParts(AnyJson& accessor, const Visit& visit) {
  const auto count_of = [](const Json& object) { return AsIndex(Find(object, "count")).value_or(0); };
  const uint64_t size = ElementSize(accessor);
  if (Find(accessor, "bufferView") != nullptr) visit(accessor, size, count_of(accessor));
  AnyJson* const sparse = Find(accessor, "sparse");
  if (sparse == nullptr) return;
  if (AnyJson* const indices = Find(*sparse, "indices"); indices != nullptr) visit(*indices, ComponentSizeOf(*indices), count_of(*sparse));
  if (AnyJson* const values = Find(*sparse, "values"); values != nullptr) visit(*values, size, count_of(*sparse));
}

// "componentType" of an accessor or of its sparse indices. Fails with kInvalidData where there is no such type.
StatusOr<ComponentType> ParseComponentType(const Json& object);

// Values of an accessor, densely packed: value i starts at i * components * ComponentSize(type).
struct AccessorData {
  ComponentType type = ComponentType::kFloat;
  uint32_t components = 1;  // 1..4: SCALAR, VEC2, VEC3, VEC4
  bool normalized = false;
  uint64_t count = 0;
  Bytes bytes;

  // Component as a number; normalized integers are scaled to [0, 1] or [-1, 1] as glTF 2.0 section 3.6.2 says.
  float Float(uint64_t element, uint32_t component) const;
  uint32_t Uint(uint64_t element, uint32_t component) const;  // of an unsigned integer type
};

// #V x components, row after row.
AccessorData MakeFloatAccessor(const std::vector<float>& values, uint32_t components);
AccessorData MakeFloatAccessor(const std::vector<Vec3f>& values);
// 16 bits where `num_vertices` allows it, else 32.
AccessorData MakeIndexAccessor(const std::vector<Triangle>& triangles, uint64_t num_vertices);

// The first three components of an element, or of all of them, of VEC3 or VEC4.
Vec3f VectorAt(const AccessorData& data, uint64_t element);
std::vector<Vec3f> VectorsOf(const AccessorData& data);

struct ComponentRange {
  float low = 0.0f, high = 0.0f;
};
// The least and the largest value of every component; empty where there are no elements.
std::vector<ComponentRange> ComponentRanges(const AccessorData& data);

// Reads accessors[index]: strides, sparse substitution and normalization; matrices are refused with kUnsupported, as is
// an accessor without any data. Messages begin with "accessor N".
StatusOr<AccessorData> ReadAccessor(const GltfDocument& document, uint64_t index);

// The same, but an accessor without any data holds zeros, as glTF says where no extension brings others, unless it is too long for that.
StatusOr<AccessorData> ReadAccessorOrZeros(const GltfDocument& document, uint64_t index);

// The same for 4 x 4 matrices of floats, column by column: 16 components. Anything else is refused with kUnsupported.
StatusOr<AccessorData> ReadMatrices(const GltfDocument& document, uint64_t index);

// Fails with kInvalidData where elements of accessors[index], of any type, or of its sparse part are outside of their bufferViews. Bytes that are not in
// the document are not missed.
Status CheckAccessor(const GltfDocument& document, uint64_t index);

}  // namespace lacerta

#endif  // LACERTA_DOCUMENT_ACCESSOR_H_
