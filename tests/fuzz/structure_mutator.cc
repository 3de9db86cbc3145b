#include "fuzz/structure_mutator.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "decoder/byte_cursor.h"
#include "encoder/byte_writer.h"
#include "fuzz/structured_input.h"

namespace lacerta::fuzz {
namespace {

constexpr size_t kMostGrowth = 64;  // bytes that a part grows by at a time

class Mutator {
 public:
  Mutator(size_t room, uint32_t seed, const MutateBytes& mutate) : room_(room), random_(seed), mutate_(mutate) {}

  // One of 0 .. n - 1.
  size_t Choose(size_t n) { return std::uniform_int_distribution<size_t>(0, n - 1)(random_); }

  void MutatePlainly(Bytes* bytes, size_t growth) {
    const size_t size = bytes->size(), most = std::max<size_t>(size + growth, 1);
    bytes->resize(most);
    bytes->resize(mutate_(bytes->data(), size, most));
  }
  void MutatePlainly(Bytes* bytes) { MutatePlainly(bytes, std::min(room_, kMostGrowth)); }

  void MutateStream(StructuredInput* stream) {
    auto& segments = stream->segments;
    switch (Choose(8)) {
      case 0:
        return MutatePlainly(&stream->before);
      case 1:
      case 2:
        if (stream->has_compact_base) return MutatePlainly(&stream->compact_base);
        return MutateHeader(&stream->header);
      case 3:
      case 4:
        return MutateHeader(&stream->header);
      case 5:
        return Rearrange(&segments);
      default:
        if (segments.empty()) return MutatePlainly(&stream->after);
        StructuredInput::Segment& segment = segments[Choose(segments.size())];
        if (Choose(8) == 0) segment.what = static_cast<uint8_t>(Choose(256));  // heard of in streams with layers
        return MutatePlainly(&segment.payload);
    }
  }

  void MutateJson(std::string* json) {
    if (Choose(2) == 0 && ChangeNumber(json)) return;
    Bytes bytes(json->begin(), json->end());
    MutatePlainly(&bytes);
    json->assign(bytes.begin(), bytes.end());
  }

  // A stream in the data of an asset takes the bytes that it took before: views of the buffer keep what they show.
  void MutateData(Bytes* data) {
    std::optional<StructuredInput> stream = Choose(4) == 0 ? std::nullopt : StructuredInput::Parse(*data);
    if (!stream) return MutatePlainly(data, 0);
    const Bytes after = std::exchange(stream->after, {});
    MutateStream(&*stream);
    Bytes joined = stream->Join();
    joined.resize(data->size() - after.size());
    joined.insert(joined.end(), after.begin(), after.end());
    *data = std::move(joined);
  }

 private:
  void MutateHeader(Bytes* header) {
    constexpr ptrdiff_t kMarkAndVersion = 4;
    Bytes fields(header->begin() + kMarkAndVersion, header->end());
    MutatePlainly(&fields);
    header->erase(header->begin() + kMarkAndVersion, header->end());
    header->insert(header->end(), fields.begin(), fields.end());
    if (Choose(8) == 0) (*header)[3] ^= static_cast<uint8_t>(1 << (4 + Choose(4)));  // the number of curved levels
  }

  void Rearrange(std::vector<StructuredInput::Segment>* segments) {
    if (segments->empty()) return;
    const size_t i = Choose(segments->size()), j = Choose(segments->size());
    const auto place = segments->begin() + static_cast<ptrdiff_t>(i);
    switch (Choose(3)) {
      case 0:
        segments->erase(place);
        return;
      case 1:
        if ((*segments)[j].payload.size() < room_) segments->insert(place, StructuredInput::Segment((*segments)[j]));
        return;
      default:
        std::swap((*segments)[i], (*segments)[j]);
    }
  }

  // Gives one number of the text another value: one at an end of a range, one beside it, or another number of the text.
  bool ChangeNumber(std::string* json) {
    std::vector<std::pair<size_t, size_t>> numbers;  // begin and length
    for (size_t i = 0; i < json->size(); ++i) {
      const size_t begin = i;
      while (i < json->size() && std::isdigit(static_cast<unsigned char>((*json)[i]))) ++i;
      if (i > begin) numbers.emplace_back(begin, i - begin);
    }
    if (numbers.empty()) return false;
    static constexpr std::array<const char*, 12> kEnds = {"0",     "1",          "2",          "-1",         "255",
                                                          "65535", "2147483647", "2147483648", "4294967295", "18446744073709551615",
                                                          "1e300", "0.5"};
    const auto [begin, length] = numbers[Choose(numbers.size())];
    std::string value;
    switch (Choose(3)) {
      case 0:
        value = kEnds[Choose(kEnds.size())];
        break;
      case 1:
        value = std::to_string(std::strtoull(json->substr(begin, length).c_str(), nullptr, 10) + Choose(9) - 4);
        break;
      default: {
        const auto [other, size] = numbers[Choose(numbers.size())];
        value = json->substr(other, size);
      }
    }
    json->replace(begin, length, value);
    return true;
  }

  size_t room_;
  std::mt19937 random_;
  const MutateBytes& mutate_;
};

// A GLB of JSON and at most one chunk of data, which may be empty.
struct Glb {
  std::string json;
  Bytes data;

  static constexpr uint32_t kHeaderSize = 12, kChunkHeaderSize = 8;
  static constexpr uint32_t kMagic = 0x46546c67, kJson = 0x4e4f534a, kBinary = 0x004e4942;

  static std::optional<Glb> Parse(Span<const uint8_t> input) {
    ByteCursor cursor(input);
    if (cursor.Word32() != kMagic) return std::nullopt;
    cursor.Take(8);  // version and length
    const uint32_t length = cursor.Word32();
    if (cursor.Word32() != kJson) return std::nullopt;
    const Span<const uint8_t> json = cursor.Take(length);
    if (cursor.at_end()) return std::nullopt;
    Glb glb{std::string(json.begin(), json.end()), {}};
    cursor.Take(4);  // length of the data, which are the rest
    if (cursor.Word32() == kBinary) glb.data.assign(cursor.Rest().begin(), cursor.Rest().end());
    return glb;
  }

  Bytes Join() const {
    const auto padded = [](size_t size) { return static_cast<uint32_t>((size + 3) / 4 * 4); };
    Bytes bytes;
    PutWord32(kMagic, &bytes);
    PutWord32(2, &bytes);
    PutWord32(kHeaderSize + kChunkHeaderSize + padded(json.size()) + (data.empty() ? 0 : kChunkHeaderSize + padded(data.size())), &bytes);
    PutWord32(padded(json.size()), &bytes);
    PutWord32(kJson, &bytes);
    bytes.insert(bytes.end(), json.begin(), json.end());
    bytes.resize(padded(bytes.size()), ' ');
    if (!data.empty()) {
      PutWord32(padded(data.size()), &bytes);
      PutWord32(kBinary, &bytes);
      bytes.insert(bytes.end(), data.begin(), data.end());
      bytes.resize(padded(bytes.size()));
    }
    return bytes;
  }
};

}  // namespace

Bytes MutateStructure(Span<const uint8_t> input, size_t max_size, uint32_t seed, const MutateBytes& mutate) {
  Mutator mutator(max_size - input.size(), seed, mutate);
  if (mutator.Choose(2) != 0) {
    Bytes changed;
    if (std::optional<Glb> glb = Glb::Parse(input)) {
      if (!glb->data.empty() && mutator.Choose(2) == 0) {
        mutator.MutateData(&glb->data);
      } else {
        mutator.MutateJson(&glb->json);
      }
      changed = glb->Join();
    } else if (std::optional<StructuredInput> stream = StructuredInput::Parse(input)) {
      mutator.MutateStream(&*stream);
      changed = stream->Join();
    }
    if (!changed.empty() && changed.size() <= max_size) return changed;
  }
  Bytes changed(input.begin(), input.end());
  mutator.MutatePlainly(&changed, max_size - input.size());
  return changed;
}

}  // namespace lacerta::fuzz
