// The entropy stage: any payload decodes to legal coefficients, and those survive being encoded and decoded again.
#include "common/coefficient_coding.h"
#include "common/length_classes.h"
#include "decoder/range_decoder.h"
#include "draco_ext/encoder/test_streams.h"
#include "encoder/range_encoder.h"
#include "fuzz/fuzz_input.h"

namespace {

using lacerta::CodingState;
using lacerta::LevelSteps;
using lacerta::QuantizedLevel;
using lacerta::RangeDecoder;
using lacerta::RangeEncoder;
using lacerta::Topology;

QuantizedLevel Zeros(const Topology& t) {
  return {std::vector<int32_t>(t.num_edges()), std::vector<int32_t>(size_t{2} * t.num_edges())};
}

// Any step that a header may hold.
float StepOf(uint16_t bits) { return lacerta::RoundStep(lacerta::StepFromBits(bits & 0x7fff)); }

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  lacerta::fuzz::FuzzInput input(data, size);
  const lacerta::BaseMesh base = (input.Byte() & 1) != 0 ? lacerta::testing::Square() : lacerta::testing::Octahedron();
  Topology t = lacerta::BuildTopology(static_cast<uint32_t>(base.lattice.size()), base.triangles).value();
  CodingState decoding, encoding, decoding_again;
  decoding.length_classes = encoding.length_classes = decoding_again.length_classes = lacerta::LengthClasses(t, base.lattice);
  for (int level = 0; level < 3; ++level, t = lacerta::Refine(t)) {
    const float normal_step = StepOf(input.Word16());
    const LevelSteps steps = {normal_step, StepOf(input.Word16()), 0, 0};
    RangeDecoder decoder(input.Take(input.Byte()));
    QuantizedLevel decoded = Zeros(t);
    CodeLevel(t, steps, &decoding, &decoded, &decoder);
    for (const int32_t q : decoded.normal) FUZZ_CHECK(lacerta::Magnitude(q) <= lacerta::kMaxMagnitude);
    for (const int32_t q : decoded.tangential) FUZZ_CHECK(lacerta::Magnitude(q) <= lacerta::kMaxMagnitude);

    QuantizedLevel kept = decoded;
    RangeEncoder encoder;
    CodeLevel(t, steps, &encoding, &kept, &encoder);
    FUZZ_CHECK(kept.normal == decoded.normal && kept.tangential == decoded.tangential);
    const lacerta::Bytes payload = encoder.Finish();
    RangeDecoder decoder_again(payload);
    QuantizedLevel again = Zeros(t);
    CodeLevel(t, steps, &decoding_again, &again, &decoder_again);
    FUZZ_CHECK(again.normal == decoded.normal && again.tangential == decoded.tangential);
  }
  return 0;
}
