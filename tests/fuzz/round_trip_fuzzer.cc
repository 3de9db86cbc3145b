// Coefficients of the fuzzer's choice, written as a stream, decode to what synthesis makes of them; every prefix
// decodes too.
#include "decoder/synthesis.h"
#include "draco_ext/encoder/test_streams.h"
#include "encoder/stream_writer.h"
#include "fuzz/fuzz_input.h"
#include "lacerta/decoder.h"

namespace {

// Mostly small numbers, now and then the largest.
int32_t Coefficient(lacerta::fuzz::FuzzInput* input) {
  const int byte = input->Byte();
  if (byte < 0xf0) return byte % 16 < 8 ? 0 : byte / 16 - 7;
  const int32_t magnitude = std::min<int32_t>((byte & 7) << 18 | input->Word16() << 2, lacerta::kMaxMagnitude);
  return (byte & 8) != 0 ? -magnitude : magnitude;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  lacerta::fuzz::FuzzInput input(data, size);
  const int choice = input.Byte();
  const lacerta::BaseMesh base = (choice & 1) != 0 ? lacerta::testing::Square() : lacerta::testing::Octahedron();
  const int num_levels = 1 + (choice >> 1) % 3, num_curved = choice >> 4;
  const std::vector<lacerta::Topology> topologies = lacerta::BuildTopologies(base, num_levels).value();
  std::vector<lacerta::LevelSteps> steps;
  std::vector<lacerta::QuantizedLevel> levels;
  std::vector<lacerta::Vec3f> expected = base.ToMesh().positions;
  for (const lacerta::Topology& t : topologies) {
    const int coded = input.Byte();
    steps.push_back({(coded & 1) != 0 ? 0.015625f : 0.0f, (coded & 2) != 0 ? 0.03125f : 0.0f,
                     static_cast<uint8_t>((coded & 1) != 0 ? coded >> 4 : 0), 0});
    lacerta::QuantizedLevel q;
    for (uint32_t e = 0; e < t.num_edges(); ++e) {
      q.normal.push_back((coded & 1) != 0 ? Coefficient(&input) : 0);
      for (int k = 0; k < 2; ++k) q.tangential.push_back((coded & 2) != 0 ? Coefficient(&input) : 0);
    }
    steps.back().is_curved = static_cast<int>(steps.size()) <= num_curved;
    SynthesizeLevel(t, lacerta::StencilTable(t), steps.back(), q, &expected);
    levels.push_back(std::move(q));
  }
  const lacerta::RefinementBytes refinement = WriteRefinement(base, topologies, steps, levels).value();
  const lacerta::RefinementResult decoded = DecodeRefinement(base, refinement.bytes, {}).value();
  FUZZ_CHECK(decoded.refinement.ok());
  FUZZ_CHECK(decoded.level == num_levels);
  FUZZ_CHECK(decoded.mesh.positions == expected);
  const size_t cut = input.Word16() % (refinement.bytes.size() + 1);
  const lacerta::Bytes prefix(refinement.bytes.begin(), refinement.bytes.begin() + static_cast<ptrdiff_t>(cut));
  const lacerta::RefinementResult part = DecodeRefinement(base, prefix, {}).value();
  FUZZ_CHECK(part.refinement.ok());
  FUZZ_CHECK(part.level < num_levels || cut == refinement.bytes.size());
  return 0;
}
