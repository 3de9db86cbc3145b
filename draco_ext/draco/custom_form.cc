#include "draco/custom_form.h"

#include <draco/compression/config/compression_shared.h>
#include <draco/compression/point_cloud/point_cloud_decoder.h>
#include <draco/core/decoder_buffer.h>
#include <draco/core/encoder_buffer.h>
#include <draco/core/varint_decoding.h>
#include <draco/core/varint_encoding.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <string>

#include "draco/mesh_conversion.h"
#include "draco/stock_stream.h"

namespace lacerta {
namespace {

constexpr std::array<uint8_t, kDracoHeaderSize> kHeader = {
    'D', 'R', 'A', 'C', 'O', 2, 2, draco::TRIANGULAR_MESH, kCustomFormMethod, 0, 0};
constexpr size_t kMethodOffset = 8;

draco::DecoderBuffer MakeBuffer(Span<const uint8_t> bytes) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size(), draco::kDracoMeshBitstreamVersion);
  return buffer;
}

Span<const uint8_t> Rest(Span<const uint8_t> bytes, const draco::DecoderBuffer& buffer) {
  return bytes.Subspan(bytes.size() - static_cast<size_t>(buffer.remaining_size()));
}

}  // namespace

Bytes CustomFormPayload(const StreamParts& parts) {
  draco::EncoderBuffer buffer;
  buffer.Encode(static_cast<uint8_t>(kCustomFormVersion | static_cast<int>(parts.coding) << 4));
  draco::EncodeVarint(static_cast<uint32_t>(parts.base.size()), &buffer);
  buffer.Encode(parts.base.data(), parts.base.size());
  buffer.Encode(parts.refinement.data(), parts.refinement.size());
  return Bytes(buffer.data(), buffer.data() + buffer.size());
}

Bytes WriteCustomForm(const StreamParts& parts) {
  Bytes stream(kHeader.begin(), kHeader.end());
  const Bytes payload = CustomFormPayload(parts);
  stream.insert(stream.end(), payload.begin(), payload.end());
  return stream;
}

bool IsCustomForm(Span<const uint8_t> stream) {
  return stream.size() > kMethodOffset && std::equal(kHeader.begin(), kHeader.begin() + 5, stream.begin()) &&
         stream[kMethodOffset] == kCustomFormMethod;
}

StatusOr<StreamParts> SplitCustomFormPayload(Span<const uint8_t> payload) {
  draco::DecoderBuffer buffer = MakeBuffer(payload);
  uint8_t version_and_coding = 0;
  if (!buffer.Decode(&version_and_coding)) return InvalidData("custom form ends before its version");
  const int version = version_and_coding & 15, coding = version_and_coding >> 4;
  if (version != kCustomFormVersion) {
    return Unsupported("custom form has version " + std::to_string(version) + ", this library reads version " +
                       std::to_string(kCustomFormVersion));
  }
  if (coding > static_cast<int>(BaseCoding::kCompact)) {
    return Unsupported("custom form has a base of coding " + std::to_string(coding) + ", which this library does not know");
  }
  uint64_t base_size = 0;
  if (!draco::DecodeVarint(&base_size, &buffer) || base_size > std::numeric_limits<uint32_t>::max()) {
    return InvalidData("length of the base in the custom form is cut off or does not fit 32 bits");
  }
  const Span<const uint8_t> rest = Rest(payload, buffer);
  if (base_size > rest.size()) {
    return InvalidData("base stream of the custom form is cut off: " + std::to_string(rest.size()) + " of " +
                       std::to_string(base_size) + " bytes are there");
  }
  return StreamParts{rest.First(base_size), rest.Subspan(base_size), static_cast<BaseCoding>(coding)};
}

StatusOr<StreamParts> SplitCustomForm(Span<const uint8_t> stream) {
  draco::DecoderBuffer buffer = MakeBuffer(stream);
  LACERTA_ASSIGN_OR_RETURN(const draco::DracoHeader header, ReadMeshHeader(&buffer));
  if (header.encoder_method != kCustomFormMethod) return InvalidData("stream is not in custom form");
  return SplitCustomFormPayload(Rest(stream, buffer));
}

}  // namespace lacerta
