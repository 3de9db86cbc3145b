#include "pack/vertex_match.h"

#include <algorithm>
#include <string>
#include <unordered_map>

namespace lacerta {
namespace {

void AppendNumber(int64_t value, std::string* key) {
  key->append(reinterpret_cast<const char*>(&value), sizeof(value));
}

void AppendBytes(const AccessorData& data, uint64_t vertex, std::string* key) {
  const size_t size = data.components * ComponentSize(data.type);
  key->append(reinterpret_cast<const char*>(data.bytes.data()) + vertex * size, size);
}

// The value of an attribute as integers where it is rounded, so that the last bit of a float does not matter.
struct Key {
  const AccessorData* data = nullptr;
  Lattice lattice;  // bits == 0: bytes as they are

  void Append(uint64_t vertex, std::string* key) const {
    if (lattice.bits == 0) return AppendBytes(*data, vertex, key);
    for (uint32_t c = 0; c < data->components; ++c) AppendNumber(lattice.Round(data->Float(vertex, c), c), key);
  }
};

// Parallel to the attributes of `rounded`; those of `values` are keyed. Empty where an attribute is missing.
std::vector<Key> KeysOf(const Primitive& rounded, const Primitive& values, const DracoPrecision& precision) {
  constexpr int kDirectionBits = 20;  // unit vectors: finer than any octahedral cell that is in use here
  std::vector<Key> keys;
  for (const Attribute& attribute : rounded.attributes) {
    const Attribute* value = values.Find(attribute.name);
    if (value == nullptr) return {};
    Key key{&value->data, {}};
    const auto lattice = precision.lattices.find(attribute.name);
    if (attribute.data.type == ComponentType::kFloat) {
      if (attribute.name == "POSITION") {
        key.lattice = precision.positions;
      } else if (lattice != precision.lattices.end()) {
        key.lattice = lattice->second;
      } else if (attribute.name == "NORMAL" && precision.normal_bits > 0) {
        key.lattice = {{-1.0f, -1.0f, -1.0f, -1.0f}, 2.0f, kDirectionBits};
      }
    }
    keys.push_back(key);
  }
  return keys;
}

std::string KeyOf(const std::vector<Key>& keys, uint64_t vertex) {
  std::string text;
  for (const Key& key : keys) key.Append(vertex, &text);
  return text;
}

}  // namespace

std::optional<std::vector<uint32_t>> MatchVertices(const Primitive& rounded, const Primitive& decoded,
                                                   const DracoPrecision& precision,
                                                   const std::vector<AccessorData>& tied) {
  const std::vector<Key> before = KeysOf(rounded, rounded, precision);
  const std::vector<Key> after = KeysOf(rounded, decoded, precision);
  if (after.size() != before.size()) return std::nullopt;
  const auto tied_bytes = [&](uint64_t vertex) {
    std::string text;
    for (const AccessorData& data : tied) AppendBytes(data, vertex, &text);
    return text;
  };
  std::vector<bool> used(static_cast<size_t>(rounded.num_vertices), false);
  for (const Triangle& triangle : rounded.triangles) {
    for (const uint32_t v : triangle) used[v] = true;
  }
  std::unordered_map<std::string, uint32_t> vertex_of;
  for (uint32_t v = 0; v < rounded.num_vertices; ++v) {
    if (!used[v]) continue;
    const auto [known, is_new] = vertex_of.emplace(KeyOf(before, v), v);
    if (!is_new && tied_bytes(known->second) != tied_bytes(v)) return std::nullopt;
  }
  std::vector<uint32_t> order;
  for (uint64_t v = 0; v < decoded.num_vertices; ++v) {
    const auto found = vertex_of.find(KeyOf(after, v));
    if (found == vertex_of.end()) return std::nullopt;
    order.push_back(found->second);
  }
  return order;
}

AccessorData Reorder(const AccessorData& data, const std::vector<uint32_t>& order) {
  const size_t size = data.components * ComponentSize(data.type);
  AccessorData result = data;
  result.count = order.size();
  result.bytes.resize(order.size() * size);
  for (size_t i = 0; i < order.size(); ++i) {
    std::copy_n(data.bytes.begin() + static_cast<std::ptrdiff_t>(order[i] * size), size,
                result.bytes.begin() + static_cast<std::ptrdiff_t>(i * size));
  }
  return result;
}

}  // namespace lacerta
