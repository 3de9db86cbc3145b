#include "draco/recoded_stream.h"

#include <draco/attributes/point_attribute.h>
#include <draco/compression/bit_coders/rans_bit_decoder.h>
#include <draco/compression/config/compression_shared.h>
#include <draco/compression/entropy/symbol_decoding.h>
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/core/decoder_buffer.h>
#include <draco/core/varint_decoding.h>
#include <draco/mesh/mesh.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "draco/parallelogram_choice.h"
#include "draco/stock_stream.h"
#include "draco/symbol_block.h"

namespace lacerta {
namespace {

// An attribute as the stream describes it.
struct DescribedAttribute {
  uint8_t components = 0;
  uint8_t coder = 0;  // a draco::SequentialAttributeEncoderType
};

// A mesh as integers, and how its decoder went about it.
struct DecodedIntegers {
  draco::MeshEdgebreakerDecoder decoder;
  draco::Mesh mesh;
};

// Null where Draco cannot read it.
std::unique_ptr<DecodedIntegers> DecodeIntegers(const Bytes& stream) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(stream.data()), stream.size());
  draco::DecoderOptions options;
  for (int type = 0; type < draco::GeometryAttribute::NAMED_ATTRIBUTES_COUNT; ++type) {
    options.SetAttributeBool(static_cast<draco::GeometryAttribute::Type>(type), "skip_attribute_transform", true);
  }
  auto result = std::make_unique<DecodedIntegers>();
  return result->decoder.Decode(options, &buffer, &result->mesh).ok() ? std::move(result) : nullptr;
}

// And where it is no mesh by edgebreaker.
std::unique_ptr<DecodedIntegers> DecodeEdgebreaker(const Bytes& stream) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(stream.data()), stream.size());
  const StatusOr<draco::DracoHeader> header = ReadMeshHeader(&buffer);
  if (!header.ok() || header.value().encoder_method != draco::MESH_EDGEBREAKER_ENCODING) return nullptr;
  return DecodeIntegers(stream);
}

bool IsSame(const draco::PointAttribute& a, const draco::PointAttribute& b, uint32_t num_points) {
  const size_t size = a.buffer()->data_size();
  if (size != b.buffer()->data_size() || std::memcmp(a.buffer()->data(), b.buffer()->data(), size) != 0) return false;
  for (draco::PointIndex p(0); p < num_points; ++p) {
    if (a.mapped_index(p) != b.mapped_index(p)) return false;
  }
  return true;
}

bool IsSame(const draco::Mesh& a, const draco::Mesh& b) {
  if (a.num_faces() != b.num_faces() || a.num_points() != b.num_points() || a.num_attributes() != b.num_attributes()) return false;
  for (draco::FaceIndex f(0); f < a.num_faces(); ++f) {
    if (a.face(f) != b.face(f)) return false;
  }
  for (int i = 0; i < a.num_attributes(); ++i) {
    if (!IsSame(*a.attribute(i), *b.attribute(i), a.num_points())) return false;
  }
  return true;
}

// Walks over a stream (bitstream 2.2) in the order of Draco's decoder. Every step is false where the stream is not as expected.
class StreamRecoder {
 public:
  StreamRecoder(const Bytes& stream, const DecodedIntegers& decoded) : stream_(stream), decoder_(decoded.decoder), mesh_(decoded.mesh) {
    in_.Init(reinterpret_cast<const char*>(stream.data()), stream.size());
  }

  bool Recode() { return Connectivity() && Descriptions() && Attributes() && in_.remaining_size() == 0; }

  // Up to the values of the only attribute.
  bool RecodeBeforeValues() {
    if (!Connectivity() || !Descriptions()) return false;
    CopyTo(Position());
    return decoders_.size() == 1 && decoders_[0].size() == 1 && decoders_[0][0].coder != draco::SEQUENTIAL_ATTRIBUTE_ENCODER_GENERIC;
  }

  void CopyRest() { CopyTo(stream_.size()); }

  Bytes Result() { return std::move(out_); }

 private:
  bool Connectivity() {
    if (!ReadMeshHeader(&in_).ok()) return false;
    in_.set_bitstream_version(DRACO_BITSTREAM_VERSION(2, 2));
    uint8_t traversal = 0, num_attribute_data = 0;
    if (!in_.Decode(&traversal) || !Varint() || !Varint() || !in_.Decode(&num_attribute_data)) return false;  // counts of vertices and triangles
    if (!Varint() || !Varint() || !SplitEvents()) return false;                                             // of symbols and splits
    if (traversal == draco::MESH_EDGEBREAKER_STANDARD_ENCODING) {
      if (!SkipSized()) return false;
    } else if (traversal != draco::MESH_EDGEBREAKER_VALENCE_ENCODING) {
      return false;
    }
    for (int i = 0; i < 1 + num_attribute_data; ++i) {  // the start of each component, and seams
      if (!SkipBits()) return false;
    }
    if (traversal == draco::MESH_EDGEBREAKER_STANDARD_ENCODING) return true;
    constexpr int kNumContexts = 6;  // valences 2 .. 7
    for (int i = 0; i < kNumContexts; ++i) {
      uint32_t num_symbols = 0;
      if (!draco::DecodeVarint(&num_symbols, &in_) || !Block(num_symbols, 1)) return false;
    }
    return true;
  }

  bool SplitEvents() {
    uint32_t num_events = 0;
    if (!draco::DecodeVarint(&num_events, &in_)) return false;
    for (uint32_t i = 0; i < num_events; ++i) {
      if (!Varint() || !Varint()) return false;
    }
    return Skip((uint64_t{num_events} + 7) / 8);
  }

  bool Descriptions() {
    uint8_t num_decoders = 0;
    if (!in_.Decode(&num_decoders)) return false;
    constexpr uint64_t kIdentifierSize = 3;
    if (!Skip(num_decoders * kIdentifierSize)) return false;
    decoders_.resize(num_decoders);
    for (auto& attributes : decoders_) {
      if (!DescriptionsOf(&attributes)) return false;
    }
    return true;
  }

  bool Attributes() {
    int id = 0;
    for (const auto& attributes : decoders_) {
      for (const DescribedAttribute& a : attributes) {
        if (id == mesh_.num_attributes() || !Values(a, id)) return false;
        ++id;
      }
      for (const DescribedAttribute& a : attributes) {
        if (!Skip(TransformSize(a))) return false;
      }
    }
    return true;
  }

  bool DescriptionsOf(std::vector<DescribedAttribute>* attributes) {
    uint32_t count = 0;
    if (!draco::DecodeVarint(&count, &in_) || count > static_cast<uint32_t>(mesh_.num_attributes())) return false;
    attributes->resize(count);
    for (DescribedAttribute& a : *attributes) {
      constexpr uint64_t kTypesSize = 2, kNormalizedSize = 1;
      if (!Skip(kTypesSize) || !in_.Decode(&a.components) || !Skip(kNormalizedSize) || !Varint()) return false;
    }
    for (DescribedAttribute& a : *attributes) {
      if (!in_.Decode(&a.coder)) return false;
    }
    return true;
  }

  bool Values(const DescribedAttribute& attribute, int id) {
    const size_t num_values = mesh_.attribute(id)->size();
    if (attribute.coder == draco::SEQUENTIAL_ATTRIBUTE_ENCODER_GENERIC) return Skip(num_values * static_cast<uint64_t>(mesh_.attribute(id)->byte_stride()));
    CopyTo(Position());
    const size_t begin = out_.size();
    const uint32_t components = attribute.coder == draco::SEQUENTIAL_ATTRIBUTE_ENCODER_NORMALS ? 2 : attribute.components;
    int8_t prediction = 0, transform = 0;
    uint8_t is_coded = 0;
    if (!in_.Decode(&prediction) || (prediction != draco::PREDICTION_NONE && !in_.Decode(&transform))) return false;
    if (!in_.Decode(&is_coded) || is_coded == 0 || !Block(num_values * components, components)) return false;
    if (prediction == draco::PREDICTION_NONE) return true;
    if (!PredictionData(prediction, num_values)) return false;
    if (transform != draco::PREDICTION_TRANSFORM_WRAP) return true;
    const std::optional<PredictableValues> values = FindPredictableValues(decoder_, id);
    if (!values.has_value() || values->components != components) return true;
    CopyTo(Position());
    const Bytes predicted = CodeByParallelograms(*values).bytes;
    if (predicted.size() >= out_.size() - begin) return true;
    out_.resize(begin);
    out_.insert(out_.end(), predicted.begin(), predicted.end());
    return true;
  }

  // All transforms of predictions have two integers.
  bool PredictionData(int prediction, size_t num_values) {
    constexpr uint64_t kTransformSize = 8;
    if (prediction == draco::MESH_PREDICTION_CONSTRAINED_MULTI_PARALLELOGRAM) {
      for (uint32_t i = 0; i < kMostParallelograms; ++i) {
        uint32_t num_flags = 0;
        if (!draco::DecodeVarint(&num_flags, &in_) || !Bits(num_flags)) return false;
      }
    } else if (prediction == draco::MESH_PREDICTION_TEX_COORDS_PORTABLE) {
      uint32_t num_orientations = 0;
      if (!in_.Decode(&num_orientations)) return false;
      if (num_orientations == 0 ? !SkipBits() : !Bits(num_orientations)) return false;
    }
    if (!Skip(kTransformSize)) return false;
    return prediction != draco::MESH_PREDICTION_GEOMETRIC_NORMAL || Bits(num_values);
  }

  static uint64_t TransformSize(const DescribedAttribute& attribute) {
    if (attribute.coder == draco::SEQUENTIAL_ATTRIBUTE_ENCODER_QUANTIZATION) return uint64_t{4} * attribute.components + 5;  // origin, range, bits
    return attribute.coder == draco::SEQUENTIAL_ATTRIBUTE_ENCODER_NORMALS ? 1 : 0;                                          // bits
  }

  bool Block(size_t num_symbols, uint32_t components) {
    if (num_symbols == 0) return true;
    const size_t begin = Position();
    std::vector<uint32_t> symbols(num_symbols);
    if (!draco::DecodeSymbols(static_cast<uint32_t>(num_symbols), static_cast<int>(components), &in_, symbols.data())) return false;
    constexpr uint32_t kMostSymbol = (1u << 31) - 1;
    if (*std::max_element(symbols.begin(), symbols.end()) > kMostSymbol) return false;
    TakeIfSmaller(EncodeSymbolBlock(symbols, components), begin);
    return true;
  }

  bool Bits(size_t count) {
    if (count == 0) return true;
    const size_t begin = Position();
    draco::RAnsBitDecoder decoder;
    if (!decoder.StartDecoding(&in_)) return false;
    Bytes bits(count);
    for (uint8_t& bit : bits) bit = decoder.DecodeNextBit();
    TakeIfSmaller(EncodeBitBlock(bits), begin);
    return true;
  }

  // block: instead of what the stream has from `begin` to here.
  void TakeIfSmaller(const Bytes& block, size_t begin) {
    if (block.size() >= Position() - begin) return;
    CopyTo(begin);
    out_.insert(out_.end(), block.begin(), block.end());
    copied_ = Position();
  }

  bool SkipBits() {
    uint8_t probability = 0;
    return in_.Decode(&probability) && SkipSized();
  }

  // As many bytes as a varint tells.
  bool SkipSized() {
    uint64_t size = 0;
    return draco::DecodeVarint(&size, &in_) && Skip(size);
  }

  bool Skip(uint64_t size) {
    if (size > static_cast<uint64_t>(in_.remaining_size())) return false;
    in_.Advance(static_cast<int64_t>(size));
    return true;
  }

  bool Varint() {
    uint32_t value = 0;
    return draco::DecodeVarint(&value, &in_);
  }

  size_t Position() const { return stream_.size() - static_cast<size_t>(in_.remaining_size()); }

  void CopyTo(size_t end) {
    out_.insert(out_.end(), stream_.begin() + static_cast<ptrdiff_t>(copied_), stream_.begin() + static_cast<ptrdiff_t>(end));
    copied_ = end;
  }

  const Bytes& stream_;
  const draco::MeshEdgebreakerDecoder& decoder_;
  const draco::Mesh& mesh_;
  draco::DecoderBuffer in_;
  Bytes out_;
  size_t copied_ = 0;  // of stream_
  std::vector<std::vector<DescribedAttribute>> decoders_;  // of attributes
};

}  // namespace

Bytes RecodeStream(Bytes stream) {
  const std::unique_ptr<DecodedIntegers> given = DecodeEdgebreaker(stream);
  if (given == nullptr) return stream;
  StreamRecoder recoder(stream, *given);
  if (!recoder.Recode()) return stream;
  recoder.CopyRest();
  Bytes recoded = recoder.Result();
  const std::unique_ptr<DecodedIntegers> decoded = DecodeIntegers(recoded);
  return decoded != nullptr && IsSame(given->mesh, decoded->mesh) ? recoded : stream;
}

std::optional<StreamOfValues> TakeApart(const Bytes& stream) {
  const std::unique_ptr<DecodedIntegers> given = DecodeEdgebreaker(stream);
  if (given == nullptr) return std::nullopt;
  StreamRecoder recoder(stream, *given);
  if (!recoder.RecodeBeforeValues()) return std::nullopt;
  std::optional<PredictableValues> values = FindPredictableValues(given->decoder, 0);
  if (!values.has_value()) return std::nullopt;
  StreamOfValues result = {recoder.Result(), *std::move(values), {}};
  for (draco::PointIndex p(0); p < given->mesh.num_points(); ++p) result.value_of_point.push_back(given->mesh.attribute(0)->mapped_index(p).value());
  return result;
}

}  // namespace lacerta
