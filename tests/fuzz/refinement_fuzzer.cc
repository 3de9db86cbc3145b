// The whole refinement decoder on bytes with sound checksums, cut into pieces. Checksums would stop a fuzzer at the
// door, so header and segments are put together from its bytes: flags, steps, biases, tags, lengths and payloads are its own choice.
#include "common/base_tags_coding.h"
#include "common/crc32.h"
#include "common/stream_layout.h"
#include "decoder/range_decoder.h"
#include "draco_ext/encoder/test_streams.h"
#include "encoder/range_encoder.h"
#include "fuzz/fuzz_input.h"
#include "lacerta/decoder.h"

namespace {

using lacerta::BaseMesh;
using lacerta::Bytes;
using lacerta::Span;

void Put(uint32_t value, int num_bytes, Bytes* bytes) {
  for (int i = 0; i < num_bytes; ++i) bytes->push_back(static_cast<uint8_t>(value >> 8 * i));
}

// Whether levels of these flags have a segment.
bool IsSilent(uint8_t flags) { return (flags & (lacerta::kCodesNormal | lacerta::kCodesTangential)) == 0; }

Bytes MakeStream(const BaseMesh& base, lacerta::fuzz::FuzzInput* input) {
  Bytes bytes = {'L', 'A', 'C', lacerta::kRefinementVersion};
  const int num_levels = 1 + input->Byte() % lacerta::kMaxLevels;
  bytes.push_back(static_cast<uint8_t>(lacerta::kHasTags | lacerta::kHasBaseStep | num_levels));
  Put(lacerta::StepToBits(base.step), 2, &bytes);
  Put(BaseChecksum(base), 2, &bytes);
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
  lacerta::Crc32 crc;
  crc.Add(bytes);
  Put(crc.low16(), 2, &bytes);
  for (int level = 1; level <= num_levels && !input->empty(); ++level) {
    if (IsSilent(flags[static_cast<size_t>(level - 1)])) continue;
    const Span<const uint8_t> payload = input->Take(input->Byte() & 0x7f);
    Put(static_cast<uint32_t>(payload.size()), 1, &bytes);
    Put(lacerta::SegmentChecksum(level, payload), 2, &bytes);
    bytes.insert(bytes.end(), payload.begin(), payload.end());
  }
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

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  lacerta::fuzz::FuzzInput input(data, size);
  const int choice = input.Byte();
  const BaseMesh base = choice % 5 == 0   ? lacerta::testing::Octahedron()
                        : choice % 5 == 1 ? lacerta::testing::Torus(5, 4)
                        : choice % 5 == 2 ? lacerta::testing::Square()
                        : choice % 5 == 3 ? lacerta::testing::OctahedronBesideStillSheets().base
                                          : lacerta::testing::ThreeSheets().base;
  lacerta::RefinementOptions options;
  options.limits = {3000, 6000};
  const size_t cut = 1 + input.Byte();
  const Bytes stream = MakeStream(base, &input);

  lacerta::ProgressiveDecoder decoder = lacerta::ProgressiveDecoder::Create(base, options).value();
  for (size_t begin = 0; begin < stream.size(); begin += cut) {
    const Span<const uint8_t> rest = Span<const uint8_t>(stream).Subspan(begin);
    const bool ok = decoder.Append(rest.First(std::min(cut, rest.size()))).ok();
    FUZZ_CHECK(ok == decoder.refinement().ok());
    FUZZ_CHECK(decoder.bytes_used() <= stream.size());
    FUZZ_CHECK(decoder.mesh().positions.size() <= options.limits.max_vertices);
  }
  const lacerta::RefinementResult whole = DecodeRefinement(base, stream, options).value();
  FUZZ_CHECK(whole.level == decoder.level());
  FUZZ_CHECK(whole.mesh.positions == decoder.mesh().positions);
  FUZZ_CHECK(whole.refinement.ok() == decoder.refinement().ok());
  const auto mesh = MeshAtLevel(whole.mesh, whole.level);
  FUZZ_CHECK(mesh.ok() && mesh.value().triangles.size() <= options.limits.max_triangles);
  CheckTags(whole.mesh.tags, base);
  return 0;
}
