// Built twice: with tinygltf as it comes, and with its own Draco decoder (TINYGLTF_ENABLE_DRACO).
#include "lacerta/tinygltf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <locale>
#include <map>

#include "decoder/smooth_normals.h"
#include "gltf/morphed_asset.h"
#include "gltf/test_assets.h"

namespace lacerta {
namespace {

using testing::AssetBuilder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::WavySphere;

constexpr char kName[] = "LACERTA_mesh_progressive";
#ifdef TINYGLTF_ENABLE_DRACO
constexpr bool kWithDraco = true;
#else
constexpr bool kWithDraco = false;
#endif

bool Load(const Bytes& glb, tinygltf::Model* model, std::string* error) {
  tinygltf::TinyGLTF loader;
  std::string warning;
  return loader.LoadBinaryFromMemory(model, error, &warning, glb.data(), static_cast<unsigned>(glb.size()));
}

tinygltf::Model Loaded(const Bytes& glb) {
  tinygltf::Model model;
  std::string error;
  EXPECT_TRUE(Load(glb, &model, &error)) << error;
  return model;
}

// Two meshes that share a smooth ball, one flat ball and one mesh of points.
Bytes Scene() {
  AssetBuilder builder;
  const TriangleMesh ball = WavySphere(14, 20);
  Json smooth = builder.Primitive(ball);
  smooth["attributes"]["NORMAL"] = builder.AddFloats(SmoothNormals(ball.positions, ball.triangles), false);
  builder.AddMesh("smooth", Json::array({smooth}));
  builder.AddMesh("twin", Json::array({smooth}));
  builder.AddMesh("flat", Json::array({builder.Primitive(WavySphere(12, 16, {4, 0, 0}))}));
  const TriangleMesh points = WavySphere(3, 4);
  Json cloud = {{"attributes", {{"POSITION", builder.AddFloats(points.positions, true)}}}, {"mode", 0}};
  builder.AddMesh("cloud", Json::array({cloud}));
  return builder.Glb();
}

// Encoded once per process: the tests change copies of it.
const Bytes& Packed(Fallback fallback) {
  static std::map<Fallback, Bytes> known;
  const auto found = known.find(fallback);
  if (found != known.end()) return found->second;
  PackOptions options;
  options.encode.target = {EncodeTarget::Kind::kPsnr, 74.0};
  options.encode.levels = LevelChoice::kAlways;
  options.attributes.normal_degrees = 10.0;  // which those that readers derive meet
  options.fallback = fallback;
  return known.emplace(fallback, PackGltf(Scene(), options).value().glb).first->second;
}

std::vector<Fallback> LoadableFallbacks() {
  return kWithDraco ? std::vector<Fallback>{Fallback::kPlain, Fallback::kDraco}
                    : std::vector<Fallback>{Fallback::kPlain};
}

RefineResult Refine(tinygltf::Model* model, std::optional<int> level = std::nullopt) {
  RefineOptions options;
  options.max_level = level;
  const auto result = RefineModel(model, options);
  EXPECT_TRUE(result.ok()) << result.status().message();
  return result.ok() ? result.value() : RefineResult();
}

Bytes AccessorBytes(const tinygltf::Model& model, int index) {
  const tinygltf::Accessor& accessor = model.accessors.at(static_cast<size_t>(index));
  const tinygltf::BufferView& view = model.bufferViews.at(static_cast<size_t>(accessor.bufferView));
  const std::vector<unsigned char>& data = model.buffers.at(static_cast<size_t>(view.buffer)).data;
  const int size = tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(accessor.componentType)) *
                   tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type));
  EXPECT_EQ(accessor.ByteStride(view), size);
  const size_t begin = view.byteOffset + accessor.byteOffset;
  EXPECT_EQ(begin % 4, 0u);
  EXPECT_LE(accessor.byteOffset + accessor.count * static_cast<size_t>(size), view.byteLength);
  EXPECT_LE(begin + view.byteLength, data.size());
  const auto first = data.begin() + static_cast<std::ptrdiff_t>(begin);
  return Bytes(first, first + static_cast<std::ptrdiff_t>(accessor.count) * size);
}

// As glTF has bounds of floats compared; JSON has no more digits than that takes.
std::vector<float> InSinglePrecision(const std::vector<double>& bounds) { return std::vector<float>(bounds.begin(), bounds.end()); }

void ExpectSameAccessor(const tinygltf::Model& a, int index_a, const tinygltf::Model& b, int index_b) {
  const tinygltf::Accessor& accessor_a = a.accessors.at(static_cast<size_t>(index_a));
  const tinygltf::Accessor& accessor_b = b.accessors.at(static_cast<size_t>(index_b));
  EXPECT_EQ(accessor_a.componentType, accessor_b.componentType);
  EXPECT_EQ(accessor_a.type, accessor_b.type);
  EXPECT_EQ(accessor_a.count, accessor_b.count);
  EXPECT_EQ(InSinglePrecision(accessor_a.minValues), InSinglePrecision(accessor_b.minValues));
  EXPECT_EQ(InSinglePrecision(accessor_a.maxValues), InSinglePrecision(accessor_b.maxValues));
  EXPECT_EQ(AccessorBytes(a, index_a), AccessorBytes(b, index_b));
}

// What is in `model` beyond `original`, but for the primitives, is at the end of its arrays.
void ExpectOnlyAdditions(const tinygltf::Model& original, tinygltf::Model model) {
  ASSERT_GE(model.accessors.size(), original.accessors.size());
  ASSERT_GE(model.bufferViews.size(), original.bufferViews.size());
  ASSERT_GE(model.buffers.size(), original.buffers.size());
  model.accessors.resize(original.accessors.size());
  model.bufferViews.resize(original.bufferViews.size());
  model.buffers.resize(original.buffers.size());
  ASSERT_EQ(model.meshes.size(), original.meshes.size());
  for (size_t m = 0; m < model.meshes.size(); ++m) {
    for (size_t p = 0; p < model.meshes[m].primitives.size(); ++p) {
      tinygltf::Primitive& primitive = model.meshes[m].primitives[p];
      const tinygltf::Primitive& before = original.meshes[m].primitives[p];
      primitive.attributes = before.attributes;
      primitive.indices = before.indices;
      primitive.extensions = before.extensions;
    }
  }
  model.extensions = original.extensions;
  model.extensionsUsed = original.extensionsUsed;
  model.extensionsRequired = original.extensionsRequired;
  EXPECT_TRUE(model == original);
}

TEST(TinyGltf, EveryLevelIsWhatUnpackingGives) {
  for (const Fallback fallback : LoadableFallbacks()) {
    const Bytes& glb = Packed(fallback);
    const tinygltf::Model original = Loaded(glb);
    const AssetInfo info = DescribeGltf(glb, "").value();
    ASSERT_EQ(info.streams.size(), 2u);
    const int num_levels = static_cast<int>(std::max(info.streams[0].levels.size(), info.streams[1].levels.size()));
    ASSERT_GE(num_levels, 3);
    size_t last_count = 0;
    for (int level = 0; level < num_levels; ++level) {
      tinygltf::Model model = original;
      const RefineResult result = Refine(&model, level);
      EXPECT_EQ(result.num_refined, 3);
      EXPECT_THAT(result.notes, IsEmpty());
      UnpackOptions options;
      options.level = level;
      const tinygltf::Model unpacked = Loaded(UnpackGltf(glb, options).value().glb);
      for (size_t m = 0; m < 3; ++m) {
        const tinygltf::Primitive& got = model.meshes[m].primitives[0];
        const tinygltf::Primitive& wanted = unpacked.meshes[m].primitives[0];
        EXPECT_EQ(got.attributes.size(), m < 2 ? 2u : 1u);  // smooth normals, or none
        ASSERT_EQ(got.attributes.size(), wanted.attributes.size());
        for (const auto& [name, accessor] : got.attributes) {
          SCOPED_TRACE(name + " of mesh " + std::to_string(m) + ", level " + std::to_string(level));
          ExpectSameAccessor(model, accessor, unpacked, wanted.attributes.at(name));
        }
        ExpectSameAccessor(model, got.indices, unpacked, wanted.indices);
        EXPECT_EQ(got.mode, TINYGLTF_MODE_TRIANGLES);
        EXPECT_THAT(got.extensions, IsEmpty());
      }
      EXPECT_EQ(model.meshes[0].primitives[0].attributes, model.meshes[1].primitives[0].attributes);
      EXPECT_EQ(model.extensionsUsed, unpacked.extensionsUsed);
      EXPECT_THAT(model.extensionsRequired, IsEmpty());
      EXPECT_EQ(model.extensions.count(kName), 0u);
      ExpectOnlyAdditions(original, model);
      const size_t count = model.accessors[static_cast<size_t>(model.meshes[0].primitives[0].indices)].count;
      EXPECT_GE(count, last_count);
      last_count = count;
    }
    tinygltf::Model finest = original;
    EXPECT_EQ(Refine(&finest).num_refined, 3);
    EXPECT_EQ(finest.accessors[static_cast<size_t>(finest.meshes[0].primitives[0].indices)].count, last_count);
  }
}

TEST(TinyGltf, WhatItRefusesToLoad) {
  std::string error;
  tinygltf::Model model;
  EXPECT_FALSE(Load(Packed(Fallback::kNone), &model, &error));
  EXPECT_THAT(error, HasSubstr("invalid bufferView"));
  model = {};
  EXPECT_EQ(Load(Packed(Fallback::kDraco), &model, &error), kWithDraco);
}

TEST(TinyGltf, AnAssetWithoutStreamsStaysAsItIs) {
  const tinygltf::Model original = Loaded(Scene());
  tinygltf::Model model = original;
  const RefineResult result = Refine(&model);
  EXPECT_EQ(result.num_refined, 0);
  EXPECT_THAT(result.notes, IsEmpty());
  EXPECT_TRUE(model == original);
}

// A byte of the streams, in the buffer of the model.
unsigned char* StreamByte(tinygltf::Model* model, size_t offset) {
  const int index = model->extensions.at(kName).Get("data").Get<int>();
  const tinygltf::BufferView& view = model->bufferViews.at(static_cast<size_t>(index));
  return &model->buffers.at(static_cast<size_t>(view.buffer)).data.at(view.byteOffset + offset);
}

size_t StreamSize(const tinygltf::Model& model) {
  return model.bufferViews.at(static_cast<size_t>(model.extensions.at(kName).Get("data").Get<int>())).byteLength;
}

TEST(TinyGltf, ADamagedBaseKeepsTheFallback) {
  for (const Fallback fallback : LoadableFallbacks()) {
    tinygltf::Model damaged = Loaded(Packed(fallback));
    for (size_t i = 0; i < 16; ++i) *StreamByte(&damaged, i) ^= 0xff;  // the base of the first stream
    tinygltf::Model model = damaged;
    const RefineResult result = Refine(&model);
    EXPECT_EQ(result.num_refined, 1);
    EXPECT_THAT(result.notes, ElementsAre(HasSubstr("mesh 0 (smooth), primitive 0: the fallback is used")));
    EXPECT_TRUE(model.meshes[0] == damaged.meshes[0]);
    EXPECT_TRUE(model.meshes[1] == damaged.meshes[1]);
    EXPECT_THAT(model.meshes[2].primitives[0].extensions, IsEmpty());
    EXPECT_EQ(model.extensions.count(kName), 1u);  // still in use
    EXPECT_EQ(model.extensionsUsed, damaged.extensionsUsed);
    EXPECT_EQ(model.extensionsRequired, damaged.extensionsRequired);
    ExpectOnlyAdditions(damaged, model);
  }
}

TEST(TinyGltf, ADamagedRefinementEndsAtACoarserLevel) {
  tinygltf::Model model = Loaded(Packed(Fallback::kPlain));
  tinygltf::Model whole = model;
  EXPECT_EQ(Refine(&whole).num_refined, 3);
  *StreamByte(&model, StreamSize(model) - 1) ^= 0xff;
  const RefineResult result = Refine(&model);
  EXPECT_EQ(result.num_refined, 3);
  EXPECT_THAT(result.notes, ElementsAre(HasSubstr("decoded to level")));
  size_t num_coarser = 0;
  for (size_t m = 0; m < 3; ++m) {
    const size_t count = model.accessors[static_cast<size_t>(model.meshes[m].primitives[0].indices)].count;
    const size_t full = whole.accessors[static_cast<size_t>(whole.meshes[m].primitives[0].indices)].count;
    EXPECT_THAT(count, ::testing::AnyOf(full, full / 4));
    num_coarser += count < full ? 1 : 0;
  }
  EXPECT_THAT(num_coarser, ::testing::AnyOf(1u, 2u));
}

TEST(TinyGltf, AnEditedModelKeepsTheFallback) {
  const tinygltf::Model original = Loaded(Packed(Fallback::kPlain));
  const auto expect_kept = [&](const std::function<void(tinygltf::Model*)>& edit, const std::string& reason) {
    tinygltf::Model edited = original;
    edit(&edited);
    tinygltf::Model model = edited;
    const RefineResult result = Refine(&model);
    ASSERT_THAT(result.notes, Not(IsEmpty())) << reason;
    EXPECT_THAT(result.notes[0], HasSubstr(reason));
    EXPECT_TRUE(model.meshes[0] == edited.meshes[0]) << reason;
  };
  const auto root = [](tinygltf::Model* model) -> tinygltf::Value::Object& {
    return model->extensions.at(kName).Get<tinygltf::Value::Object>();
  };
  const auto position = [](const tinygltf::Model& model) {
    return static_cast<size_t>(model.meshes[0].primitives[0].attributes.at("POSITION"));
  };
  expect_kept([&](auto* model) { root(model)["version"] = tinygltf::Value(99); }, "version 99");
  expect_kept([&](auto* model) { root(model)["data"] = tinygltf::Value(-1); }, "\"data\"");
  expect_kept([&](auto* model) { root(model)["data"] = tinygltf::Value(1000000); }, "bufferView 1000000");
  expect_kept([&](auto* model) { root(model)["streams"] = tinygltf::Value(std::string("a\"b\\c\n\xff")); }, "stream");
  expect_kept([&](auto* model) { root(model)["segments"] = tinygltf::Value(std::nan("")); }, "\"stream\"");
  expect_kept([&](auto* model) { model->extensions.clear(); }, "no LACERTA_mesh_progressive");
  expect_kept([&](auto* model) { model->buffers.clear(); }, "buffer 0");
  expect_kept([&](auto* model) { model->accessors[position(*model)].minValues = {-9, -9, -9}; }, "edited");
  expect_kept([&](auto* model) { model->accessors[position(*model)].maxValues.clear(); }, "min and max");
  // A size that tinygltf would save as a real number, and one that no buffer has.
  expect_kept([&](auto* model) { root(model)["data"] = tinygltf::Value(1e30); }, "\"data\"");
  expect_kept(
      [&](auto* model) {
        const int view = root(model).at("data").template Get<int>();
        model->bufferViews[static_cast<size_t>(view)].byteOffset = ~size_t{0};
      },
      "the fallback is used");
}

TEST(TinyGltf, WithoutFallbackItFailsAndChangesNothing) {
  tinygltf::Model damaged = Loaded(Packed(Fallback::kPlain));
  for (size_t i = 0; i < 16; ++i) *StreamByte(&damaged, i) ^= 0xff;
  for (tinygltf::Accessor& accessor : damaged.accessors) accessor.bufferView = -1;
  tinygltf::Model model = damaged;
  const auto result = RefineModel(&model, {});
  ASSERT_EQ(result.status().code(), StatusCode::kInvalidData);
  EXPECT_THAT(result.status().message(), HasSubstr("mesh 0, primitive 0"));
  EXPECT_TRUE(model == damaged);
}

TEST(TinyGltf, ANegativeLevelIsRefused) {
  const tinygltf::Model original = Loaded(Packed(Fallback::kPlain));
  tinygltf::Model model = original;
  RefineOptions options;
  options.max_level = -1;
  EXPECT_EQ(RefineModel(&model, options).status().code(), StatusCode::kInvalidArgument);
  EXPECT_TRUE(model == original);
}

TEST(TinyGltf, NumbersSurviveAnyLocale) {
  // A comma for the decimal point would damage the JSON that is handed on.
  struct Comma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    std::string do_grouping() const override { return "\3"; }
  };
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new Comma));
  tinygltf::Model model = Loaded(Packed(Fallback::kPlain));
  const RefineResult result = Refine(&model);
  std::locale::global(before);
  EXPECT_EQ(result.num_refined, 3);
  EXPECT_THAT(result.notes, IsEmpty());
}

TEST(TinyGltf, DamagedBytesNeverCrash) {
  const tinygltf::Model original = Loaded(Packed(LoadableFallbacks().back()));
  const size_t size = StreamSize(original);
  size_t num_damaged = 0;
  size_t num_notes = 0;
  for (size_t i = 0; i < size; i += size / 150 + 1) {
    tinygltf::Model model = original;
    *StreamByte(&model, i) ^= 0x55;
    const auto result = RefineModel(&model, {});
    ASSERT_TRUE(result.ok()) << result.status().message();
    ++num_damaged;
    num_notes += result.value().notes.size();
  }
  EXPECT_GE(10 * num_notes, 7 * num_damaged);  // some bits of a Draco base matter to nobody
  EXPECT_LE(num_notes, num_damaged);           // one stream at a time
}

TEST(TinyGltf, MorphTargetsAreThoseOfTheLevel) {
  if (!kWithDraco) return;
  PackOptions options;
  options.encode.target = {EncodeTarget::Kind::kPsnr, 60.0};
  options.encode.effort = Effort::kFast;
  const Bytes glb = PackGltf(testing::BallWithHills({40, 66, 3, true, false, 0}), options).value().glb;
  const tinygltf::Model original = Loaded(glb);
  for (const int level : {0, 2}) {
    tinygltf::Model model = original;
    const RefineResult refined = Refine(&model, level);
    EXPECT_THAT(refined.notes, IsEmpty());
    ASSERT_EQ(refined.num_refined, 1);
    UnpackOptions unpack;
    unpack.level = level;
    const GltfDocument unpacked = ParseGltf(UnpackGltf(glb, unpack).value().glb, "").value();
    const tinygltf::Primitive& got = model.meshes[0].primitives[0];
    const Json& wanted = unpacked.json["meshes"][0u]["primitives"][0u]["targets"];
    ASSERT_EQ(got.targets.size(), 3u);
    for (size_t t = 0; t < got.targets.size(); ++t) {
      ASSERT_EQ(got.targets[t].size(), 2u);
      for (const auto& [name, accessor] : got.targets[t]) {
        const AccessorData data = ReadAccessor(unpacked, wanted[t][name].get<uint64_t>()).value();
        EXPECT_EQ(AccessorBytes(model, accessor), data.bytes) << name;
        EXPECT_EQ(model.accessors[static_cast<size_t>(accessor)].minValues.size(), name == "POSITION" ? 3u : 0u);
      }
    }
  }
  // Fewer targets than the stream has: the fallback stays.
  tinygltf::Model fewer = original;
  fewer.meshes[0].primitives[0].targets.pop_back();
  const RefineResult result = Refine(&fewer);
  EXPECT_EQ(result.num_refined, 0);
  EXPECT_THAT(result.notes, ElementsAre(HasSubstr("3 morph targets")));
}

}  // namespace
}  // namespace lacerta
