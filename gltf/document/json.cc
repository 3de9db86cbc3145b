#include "document/json.h"

#include <array>
#include <charconv>
#include <cmath>

namespace lacerta {
namespace {

// Serializing is recursive, so the depth of what is read has to be bounded.
constexpr int kMaxDepth = 256;

// The double nearest to the decimals of a number: as few as tell it, or `precision` behind the first one.
template <typename Number, typename... Precision>
double ThroughDecimals(Number value, Precision... precision) {
  std::array<char, 32> decimals;  // -1.17549435e-38 is as long as it gets
  double number = value;
  const auto written = std::to_chars(decimals.data(), decimals.data() + decimals.size(), value,
                                     std::chars_format::scientific, precision...);
  if (written.ec == std::errc()) std::from_chars(decimals.data(), written.ptr, number);
  return number;
}

// Takes all that is well formed and remembers where it ends.
struct EndFinder : nlohmann::json_sax<Json> {
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_object(size_t) override { return true; }
  bool key(string_t&) override { return true; }
  bool end_object() override { return true; }
  bool start_array(size_t) override { return true; }
  bool end_array() override { return true; }
  bool parse_error(size_t position, const std::string&, const nlohmann::detail::exception&) override {
    bytes_read = position;
    return false;
  }
  size_t bytes_read = 0;
};

// Of text that is not well formed, with the text there as far as it can be printed.
std::string WhereItBreaks(std::string_view text) {
  EndFinder finder;
  Json::sax_parse(text.begin(), text.end(), &finder);
  if (finder.bytes_read == 0 || finder.bytes_read > text.size()) return "at its end";
  constexpr size_t kShown = 20;
  std::string near;
  for (const char c : text.substr(finder.bytes_read - 1, kShown)) near += c >= ' ' && c <= '~' ? c : '.';
  return "at byte " + std::to_string(finder.bytes_read - 1) + ", where it goes on with \"" + near + "\"";
}

}  // namespace

StatusOr<Json> ParseJson(std::string_view text) {
  bool too_deep = false;
  const auto limit_depth = [&too_deep](int depth, Json::parse_event_t, Json&) {
    too_deep = too_deep || depth > kMaxDepth;
    return !too_deep;
  };
  Json json = Json::parse(text.begin(), text.end(), limit_depth, /*allow_exceptions=*/false);
  if (too_deep) return InvalidData("the JSON is nested more than " + std::to_string(kMaxDepth) + " levels deep");
  if (json.is_discarded()) return InvalidData("the JSON is not well formed " + WhereItBreaks(text) + "; the file is truncated or damaged");
  if (!json.is_object()) return InvalidData("the JSON is no object");
  return json;
}

const Json* Find(const Json& object, const char* key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

Json* Find(Json& object, const char* key) { return const_cast<Json*>(Find(static_cast<const Json&>(object), key)); }

const Json* FindExtension(const Json& object, const char* name) {
  const Json* extensions = Find(object, "extensions");
  return extensions == nullptr ? nullptr : Find(*extensions, name);
}

const Json* FindElement(const Json& object, const char* key, uint64_t index) {
  const Json* array = Find(object, key);
  return array != nullptr && array->is_array() && index < array->size() ? &(*array)[static_cast<size_t>(index)]
                                                                        : nullptr;
}

uint64_t ArraySize(const Json& object, const char* key) {
  const Json* array = Find(object, key);
  return array != nullptr && array->is_array() ? array->size() : 0;
}

std::optional<uint64_t> AsIndex(const Json* value) {
  if (value == nullptr) return std::nullopt;
  if (value->is_number_unsigned()) return value->get<uint64_t>();
  if (value->is_number_integer() && value->get<int64_t>() >= 0) return static_cast<uint64_t>(value->get<int64_t>());
  if (value->is_number_float()) {
    const double number = value->get<double>();
    if (number >= 0.0 && number < 9e15 && number == std::floor(number)) return static_cast<uint64_t>(number);
  }
  return std::nullopt;
}

StatusOr<uint64_t> GetIndex(const Json& object, const char* key, std::optional<uint64_t> missing) {
  const Json* value = Find(object, key);
  if (value == nullptr && missing.has_value()) return *missing;
  const std::optional<uint64_t> index = AsIndex(value);
  if (!index.has_value()) return InvalidData(std::string("\"") + key + "\" is missing or no non-negative integer");
  return *index;
}

std::optional<double> AsNumber(const Json* value) {
  if (value == nullptr || !value->is_number()) return std::nullopt;
  return value->get<double>();
}

bool IsTrue(const Json* value) { return value != nullptr && value->is_boolean() && value->get<bool>(); }

std::string AsString(const Json* value) {
  return value != nullptr && value->is_string() ? value->get<std::string>() : std::string();
}

Json ShortNumber(float value) {
  constexpr float kExact = 1 << 24;
  if (std::fabs(value) < kExact && value == std::trunc(value)) return static_cast<int32_t>(value);
  return ThroughDecimals(value);
}

Json RoundedNumber(double value) {
  constexpr int kDigits = 4;
  return ThroughDecimals(value, kDigits - 1);
}

}  // namespace lacerta
