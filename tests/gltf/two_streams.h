// A packed asset with two streams of several levels, made once.
#ifndef LACERTA_TESTS_GLTF_TWO_STREAMS_H_
#define LACERTA_TESTS_GLTF_TWO_STREAMS_H_

#include "gltf/test_assets.h"
#include "lacerta/gltf.h"

namespace lacerta::testing {

inline Bytes TwoBalls() {
  AssetBuilder builder;
  builder.AddMesh("near", Json::array({builder.Primitive(WavySphere(25, 40))}));
  builder.AddMesh("far", Json::array({builder.Primitive(WavySphere(21, 36, {3, 0, 0}))}));
  return builder.Glb();
}

inline PackResult PackTwoStreams(const std::string& external_uri = "") {
  PackOptions options;
  options.encode.target = {EncodeTarget::Kind::kPsnr, 72.0};
  options.encode.levels = LevelChoice::kAlways;
  options.external_uri = external_uri;
  return PackGltf(TwoBalls(), options).value();
}

inline const PackResult& TwoStreams() {
  static const PackResult* const kResult = new PackResult(PackTwoStreams());
  return *kResult;
}

}  // namespace lacerta::testing

#endif  // LACERTA_TESTS_GLTF_TWO_STREAMS_H_
