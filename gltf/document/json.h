// JSON of a glTF asset. The whole document is kept as it was read, in its order, so that whatever this version does not
// know passes through; see docs/decisions/0002-gltf-document.md. Nothing here throws.
#ifndef LACERTA_DOCUMENT_JSON_H_
#define LACERTA_DOCUMENT_JSON_H_

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "lacerta/status.h"

namespace lacerta {

using Json = nlohmann::ordered_json;

// Fails with kInvalidData naming the byte, also where arrays and objects are nested deeper than any asset needs.
StatusOr<Json> ParseJson(std::string_view text);

// The member of an object, or nullptr when there is none or `object` is no object.
const Json* Find(const Json& object, const char* key);
Json* Find(Json& object, const char* key);

// An extension of the asset or of an object in it: `object["extensions"][name]`, or nullptr.
const Json* FindExtension(const Json& object, const char* name);

// The element of the array `object[key]`, or nullptr when out of range.
const Json* FindElement(const Json& object, const char* key, uint64_t index);

// Number of elements of the array `object[key]`; 0 when there is none.
uint64_t ArraySize(const Json& object, const char* key);

// A non-negative integer (1.0 counts as one); empty when `value` is anything else.
std::optional<uint64_t> AsIndex(const Json* value);

// `object[key]` as a non-negative integer. Fails with kInvalidData when it is something else or missing without a
// default.
StatusOr<uint64_t> GetIndex(const Json& object, const char* key, std::optional<uint64_t> missing = std::nullopt);

std::optional<double> AsNumber(const Json* value);
bool IsTrue(const Json* value);
// The string, or "" when it is none.
std::string AsString(const Json* value);

// A number that is written with the fewest digits that a reader in single precision takes for `value`, which is finite.
Json ShortNumber(float value);
// The same of a measure, which four digits tell well enough.
Json RoundedNumber(double value);

}  // namespace lacerta

#endif  // LACERTA_DOCUMENT_JSON_H_
