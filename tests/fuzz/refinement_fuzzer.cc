// The whole refinement decoder on bytes with sound checksums, cut into pieces. Checksums would stop a fuzzer at the
// door, so header and segments are put together from its bytes: flags, steps, biases, tags, layers, attributes, lengths and payloads are
// its own choice.
#include <cmath>

#include "common/base_tags_coding.h"
#include "common/crc16.h"
#include "common/stream_layout.h"
#include "decoder/range_decoder.h"
#include "draco_ext/encoder/attributed_test_streams.h"
#include "draco_ext/encoder/test_streams.h"
#include "encoder/range_encoder.h"
#include "fuzz/fuzz_input.h"
#include "lacerta/decoder.h"

namespace {

using lacerta::AttributedBase;
using lacerta::BaseMesh;
using lacerta::Bytes;
using lacerta::Span;

void Put(uint32_t value, int num_bytes, Bytes* bytes) {
  for (int i = 0; i < num_bytes; ++i) bytes->push_back(static_cast<uint8_t>(value >> 8 * i));
}

// Whether levels of these flags have a segment.
bool IsSilent(uint8_t flags) { return (flags & (lacerta::kCodesNormal | lacerta::kCodesTangential)) == 0; }

// The attributes of a base: prediction, levels and steps are the fuzzer's.
void PutAttributes(const AttributedBase& base, int num_levels, lacerta::fuzz::FuzzInput* input, Bytes* bytes) {
  Put(static_cast<uint32_t>(base.attributes.size()), 1, bytes);
  for (const lacerta::BaseAttribute& a : base.attributes) {
    Put(static_cast<uint32_t>(a.precision.kind), 1, bytes);
    Put(input->Byte() & 7, 1, bytes);  // chained or not
    Put(a.precision.components, 1, bytes);
    Put(static_cast<uint32_t>(a.precision.name.size()), 1, bytes);
    bytes->insert(bytes->end(), a.precision.name.begin(), a.precision.name.end());
    if (a.precision.octahedral_bits > 0) {
      Put(static_cast<uint32_t>(a.precision.octahedral_bits), 1, bytes);
    } else {
      Put(lacerta::StepToBits(a.precision.step), 2, bytes);
    }
    const uint32_t levels = input->Byte() & 0x7f;
    Put(levels, 1, bytes);
    for (int i = 0; i < num_levels; ++i) {
      if ((levels >> i & 1) == 0) continue;
      do bytes->push_back(input->Byte());
      while (bytes->back() >= 0x80);
    }
  }
}

// Segments of levels one after the other or, with layers, of levels, shifts and order of the fuzzer's choice. Their checksums are sound.
void PutSegments(const std::vector<uint8_t>& flags, int num_levels, bool has_attributes, bool has_layers, lacerta::fuzz::FuzzInput* input,
                 Bytes* bytes) {
  constexpr int kMostLayers = 64;  // enough for a few rounds of 12 levels
  for (int i = 1; i <= (has_layers ? kMostLayers : num_levels) && !input->empty(); ++i) {
    if (!has_layers && !has_attributes && IsSilent(flags[static_cast<size_t>(i - 1)])) continue;
    const int what = has_layers ? input->Byte() : i;
    if (has_layers) Put(static_cast<uint32_t>(what), 1, bytes);
    const Span<const uint8_t> payload = input->Take(input->Byte() & 0x7f);
    Put(static_cast<uint32_t>(payload.size()), 1, bytes);
    Put(lacerta::SegmentChecksum(what, payload), 2, bytes);
    bytes->insert(bytes->end(), payload.begin(), payload.end());
  }
}

// attributed: the base that `base` is glued from, or null.
Bytes MakeStream(const BaseMesh& base, const AttributedBase* attributed, bool has_layers, lacerta::fuzz::FuzzInput* input) {
  Bytes bytes = {'L', 'A', 'C', lacerta::kRefinementVersion};
  const int num_levels = 1 + input->Byte() % lacerta::kMaxLevels;
  bytes.push_back(static_cast<uint8_t>(lacerta::kHasTags | lacerta::kHasBaseStep | num_levels));
  if (has_layers) bytes[4] |= lacerta::kHasLayers;
  Put(lacerta::StepToBits(base.step), 2, &bytes);
  Put(attributed != nullptr ? BaseChecksum(*attributed) : BaseChecksum(base), 2, &bytes);
  std::vector<uint8_t> flags(static_cast<size_t>(num_levels + num_levels % 2));
  for (size_t i = 0; i < flags.size(); i += 2) {
    const uint8_t two = input->Byte();
    flags[i] = two & 15;
    flags[i + 1] = i + 1 < static_cast<size_t>(num_levels) ? two >> 4 : 0;
    bytes.push_back(static_cast<uint8_t>(flags[i] | flags[i + 1] << 4));
  }
  Put(input->Word16(), 2, &bytes);
  for (const uint8_t f : flags) {
    // Differences take as many bytes as their top bits say.
    for (int sets = (f & lacerta::kHasDifferences) != 0 ? (f & 1) + (f >> 1 & 1) : 0; sets > 0; --sets) {
      do bytes.push_back(input->Byte());
      while (bytes.back() >= 0x80);
    }
    if ((f & lacerta::kHasBiases) != 0) bytes.push_back(input->Byte());
  }
  const Span<const uint8_t> tags = input->Take(input->Byte() & 0x1f);
  if (tags.empty()) bytes[4] &= static_cast<uint8_t>(~lacerta::kHasTags);
  if (!tags.empty()) Put(static_cast<uint32_t>(tags.size()), 1, &bytes);
  bytes.insert(bytes.end(), tags.begin(), tags.end());
  if (attributed != nullptr) {
    bytes[4] |= lacerta::kHasAttributes;
    PutAttributes(*attributed, num_levels, input, &bytes);
  }
  lacerta::Crc16 crc;
  crc.Add(bytes);
  Put(crc.value(), 2, &bytes);
  PutSegments(flags, num_levels, attributed != nullptr, has_layers, input, &bytes);
  return bytes;
}

// Tags that were read are written and read again as they are.
void CheckTags(const lacerta::BaseTags& tags, const BaseMesh& base) {
  if (tags.empty()) return;
  lacerta::BaseTags written = tags, again;
  lacerta::RangeEncoder encoder;
  FUZZ_CHECK(CodeBaseTags(base.lattice, base.triangles, &written, &encoder).ok());
  const Bytes payload = encoder.Finish();
  FUZZ_CHECK(payload.size() <= lacerta::MaxTagBytes(base.lattice.size(), base.triangles.size()));
  lacerta::RangeDecoder decoder(payload);
  FUZZ_CHECK(CodeBaseTags(base.lattice, base.triangles, &again, &decoder).ok());
  FUZZ_CHECK(again.still == tags.still && again.crease == tags.crease && again.corner == tags.corner && again.joined == tags.joined);
}

// Rows of every attribute at all triangles, and no more of them than the limits allow.
void CheckAttributes(const lacerta::ProgressiveDecoder& decoder, const lacerta::DecodeLimits& limits) {
  const size_t num_triangles = decoder.Triangles().size();
  FUZZ_CHECK(decoder.attributes().empty() || decoder.Groups().size() == num_triangles);
  for (size_t a = 0; a < decoder.attributes().size(); ++a) {
    const uint32_t num_values = decoder.attributes()[a].num_values();
    FUZZ_CHECK(num_values <= limits.max_vertices);
    const std::vector<lacerta::Triangle> corners = decoder.Corners(a);
    FUZZ_CHECK(corners.size() == num_triangles);
    for (const lacerta::Triangle& t : corners) {
      for (const uint32_t row : t) FUZZ_CHECK(row < num_values || row == lacerta::MeshAttribute::kNoValue);
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  lacerta::fuzz::FuzzInput input(data, size);
  const int choice = input.Byte();
  const bool has_attributes = choice >= 128, has_layers = choice >= 64 && choice < 128;
  const AttributedBase attributed = lacerta::testing::OctahedronWithAttributes();
  const BaseMesh base = has_attributes    ? GlueBase(attributed).value().mesh
                        : choice % 5 == 0   ? lacerta::testing::Octahedron()
                        : choice % 5 == 1 ? lacerta::testing::Torus(5, 4)
                        : choice % 5 == 2 ? lacerta::testing::Square()
                        : choice % 5 == 3 ? lacerta::testing::OctahedronBesideStillSheets().base
                                          : lacerta::testing::ThreeSheets().base;
  lacerta::RefinementOptions options;
  options.limits = {3000, 6000};
  const size_t cut = 1 + input.Byte();
  const Bytes stream = MakeStream(base, has_attributes ? &attributed : nullptr, has_layers, &input);
  const auto create = [&] {
    return has_attributes ? lacerta::ProgressiveDecoder::Create(attributed, options).value() : lacerta::ProgressiveDecoder::Create(base, options).value();
  };

  lacerta::ProgressiveDecoder decoder = create();
  for (size_t begin = 0; begin < stream.size(); begin += cut) {
    const Span<const uint8_t> rest = Span<const uint8_t>(stream).Subspan(begin);
    const bool ok = decoder.Append(rest.First(std::min(cut, rest.size()))).ok();
    FUZZ_CHECK(ok == decoder.refinement().ok());
    FUZZ_CHECK(decoder.bytes_used() <= stream.size());
    FUZZ_CHECK(decoder.mesh().positions.size() <= options.limits.max_vertices);
  }
  lacerta::ProgressiveDecoder whole = create();
  const bool whole_ok = whole.Append(stream).ok();
  // Of the states that one call brings the last one is shown: with layers an earlier one may fail where that does not.
  FUZZ_CHECK(has_layers || whole_ok == decoder.refinement().ok());
  if (!has_layers || (whole_ok && decoder.refinement().ok())) {
    FUZZ_CHECK(whole.level() == decoder.level());
    FUZZ_CHECK(whole.mesh().positions == decoder.mesh().positions);
  }
  const auto mesh = MeshAtLevel(whole.mesh(), whole.level());
  FUZZ_CHECK(mesh.ok() && mesh.value().triangles.size() <= options.limits.max_triangles);
  FUZZ_CHECK(mesh.value().triangles == whole.Triangles());
  for (const lacerta::Vec3f& p : mesh.value().positions) FUZZ_CHECK(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
  CheckAttributes(decoder, options.limits);
  CheckTags(whole.mesh().tags, base);
  return 0;
}
