// The C functions on streams with attributes and groups of faces.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "draco/attributed_base_codec.h"
#include "draco/attributed_stream.h"
#include "lacerta.h"
#include "lacerta/attributed_base.h"
#include "plugin/c/decoder_handle.h"
#include "shapes/attributed_levels.h"
#include "shapes/attributed_shapes.h"

namespace lacerta {
namespace {

using ::testing::HasSubstr;
using testing::Create;
using testing::Decoder;
using testing::Message;
using testing::Progress;

constexpr int kNumLevels = 2;

// A box of two groups: one side, which has a color, and the others. Corners lie on seams, sides on borders of the groups.
struct Box {
  AttributedStream stream;
  Bytes bytes;  // base section and refinement
  std::vector<uint64_t> lengths;
  std::vector<std::string> names;
  std::vector<const char*> c_names;

  Box() : stream(Make()) {
    for (const Bytes& base : stream.bases) {
      lengths.push_back(base.size());
      bytes.insert(bytes.end(), base.begin(), base.end());
    }
    bytes.insert(bytes.end(), stream.refinement.begin(), stream.refinement.end());
    for (const LevelAttribute& a : stream.decoded.attributes) names.push_back(a.name);
    for (const std::string& name : names) c_names.push_back(name.c_str());
  }

  lacerta_decoder_options Options() const {
    lacerta_decoder_options options = LACERTA_DECODER_OPTIONS_INIT;
    options.base_lengths = lengths.data();
    options.num_groups = static_cast<uint32_t>(lengths.size());
    options.attribute_names = c_names.data();
    options.num_attributes = static_cast<uint32_t>(c_names.size());
    return options;
  }
  size_t base_size() const { return bytes.size() - stream.refinement.size(); }

  std::vector<VertexSoup> Expected(int level) const {
    if (level > 0) return SplitIntoSoups(AttributedMeshAtLevel(stream.decoded, level).value(), 2);
    std::vector<VertexSoup> groups;
    for (const Bytes& base : stream.bases) groups.push_back(DecodeAttributedGroup(base, names, {}).value());
    return groups;
  }

  static AttributedStream Make() {
    AttributedSemiRegularMesh mesh = shapes::SubdividedSoups(shapes::BoxOfTwoGroups(2), kNumLevels, [](Vec3f p) { return p * (1 + 0.1f * p.x * p.y); },
                                                             [](const LevelAttribute& a, float* row) {
                                                               if (a.kind == AttributeKind::kColor) row[0] *= row[0];
                                                             });
    AttributedStreamOptions options;
    options.lambda = 1e-9;
    options.errors = {1e-3, 1.0, 1e-3};
    return EncodeAttributedStream({AsNormalMesh(std::move(mesh.surface)).value(), std::move(mesh.base_groups), std::move(mesh.attributes)}, options).value();
  }
};

struct Read {
  VertexSoup soup;
  std::vector<Vec3f> normals;
  uint32_t attributes = 0;
};

// Attributes that the group has not got are left out.
Read ReadGroup(const Decoder& decoder, int level, uint32_t group, const std::vector<std::string>& names) {
  Read read;
  lacerta_mesh_size size = LACERTA_MESH_SIZE_INIT;
  EXPECT_EQ(lacerta_decoder_get_mesh_size(decoder.get(), level, group, &size), LACERTA_OK) << Message(decoder);
  read.attributes = size.attributes;
  read.soup.positions.resize(size.num_vertices);
  read.soup.triangles.resize(size.num_triangles);
  read.normals.resize(size.num_vertices);
  std::vector<float*> pointers;
  read.soup.attributes.reserve(names.size());
  for (uint32_t i = 0; i < names.size(); ++i) {
    lacerta_attribute attribute = LACERTA_ATTRIBUTE_INIT;
    EXPECT_EQ(lacerta_decoder_get_attribute(decoder.get(), i, &attribute), LACERTA_OK);
    EXPECT_EQ(attribute.name, names[i]);
    pointers.push_back(nullptr);
    if ((size.attributes >> i & 1) == 0) continue;
    read.soup.attributes.push_back({names[i], AttributeKind::kGeneric, attribute.components, std::vector<float>(size_t{size.num_vertices} * attribute.components, -7.0f)});
    pointers.back() = read.soup.attributes.back().values.data();
  }
  lacerta_mesh_buffers buffers = LACERTA_MESH_BUFFERS_INIT;
  buffers.max_vertices = size.num_vertices;
  buffers.max_triangles = size.num_triangles;
  buffers.num_attributes = static_cast<uint32_t>(pointers.size());
  buffers.positions = &read.soup.positions[0].x;
  buffers.normals = &read.normals[0].x;
  buffers.indices = read.soup.triangles[0].data();
  buffers.attributes = pointers.data();
  EXPECT_EQ(lacerta_decoder_read_mesh(decoder.get(), level, group, &buffers), LACERTA_OK) << Message(decoder);
  return read;
}

void ExpectSame(const VertexSoup& read, const VertexSoup& expected) {
  EXPECT_EQ(read.positions, expected.positions);
  EXPECT_EQ(read.triangles, expected.triangles);
  ASSERT_EQ(read.attributes.size(), expected.attributes.size());
  for (size_t i = 0; i < read.attributes.size(); ++i) {
    EXPECT_EQ(read.attributes[i].name, expected.attributes[i].name);
    EXPECT_EQ(read.attributes[i].components, expected.attributes[i].components);
    EXPECT_EQ(read.attributes[i].values, expected.attributes[i].values);
  }
}

void ExpectAllLevels(const Decoder& decoder, const Box& box) {
  for (const int level : {2, 0, 1, 2}) {
    const std::vector<VertexSoup> expected = box.Expected(level);
    for (uint32_t g = 0; g < 2; ++g) {
      SCOPED_TRACE(::testing::Message() << "level " << level << ", group " << g);
      ExpectSame(ReadGroup(decoder, level, g, box.names).soup, expected[g]);
    }
  }
}

TEST(LacertaCGroups, EveryLevelOfEveryGroupIsThatOfTheLibrary) {
  const Box box;
  const Decoder decoder = Create(box.Options());
  int32_t level = -2, before = -1;
  for (size_t i = 0; i < box.bytes.size(); ++i) {
    ASSERT_EQ(lacerta_decoder_append(decoder.get(), &box.bytes[i], 1, &level), LACERTA_OK) << Message(decoder);
    ASSERT_EQ(level >= 0, i + 1 >= box.base_size()) << i;
    ASSERT_TRUE(level == before || level == before + 1);
    before = level;
  }
  const lacerta_progress progress = Progress(decoder);
  EXPECT_EQ(progress.level, kNumLevels);
  EXPECT_EQ(progress.is_complete, 1);
  EXPECT_EQ(progress.num_groups, 2u);
  EXPECT_EQ(progress.num_attributes, 3u);
  EXPECT_EQ(progress.bytes_used, box.bytes.size());
  ExpectAllLevels(decoder, box);
}

TEST(LacertaCGroups, GroupsOfAHostLeadToTheSameLevels) {
  const Box box;
  const std::vector<VertexSoup> base = box.Expected(0);
  const Decoder decoder = Create(box.Options());
  for (const uint32_t g : {1u, 0u}) {
    EXPECT_EQ(Progress(decoder).level, -1);
    std::vector<const float*> values(box.names.size());
    std::vector<uint32_t> components(box.names.size());
    for (size_t i = 0; i < box.names.size(); ++i) {
      for (const VertexSoup::Attribute& a : base[g].attributes) {
        if (a.name != box.names[i]) continue;
        values[i] = a.values.data();
        components[i] = a.components;
      }
    }
    lacerta_base_group given = LACERTA_BASE_GROUP_INIT;
    given.num_vertices = static_cast<uint32_t>(base[g].positions.size());
    given.num_triangles = static_cast<uint32_t>(base[g].triangles.size());
    given.positions = &base[g].positions[0].x;
    given.indices = base[g].triangles[0].data();
    given.num_attributes = static_cast<uint32_t>(values.size());
    given.attributes = values.data();
    given.components = components.data();
    ASSERT_EQ(lacerta_decoder_set_base_group(decoder.get(), g, &given), LACERTA_OK) << Message(decoder);
    EXPECT_EQ(lacerta_decoder_set_base_group(decoder.get(), g, &given), LACERTA_INVALID_ARGUMENT);
  }
  EXPECT_EQ(Progress(decoder).level, 0);
  ASSERT_EQ(lacerta_decoder_append(decoder.get(), box.bytes.data(), box.bytes.size(), nullptr), LACERTA_OK) << Message(decoder);
  ExpectAllLevels(decoder, box);
}

TEST(LacertaCGroups, AllGroupsAreOneAfterTheOtherAndTheirBordersHaveOneNormal) {
  const Box box;
  const Decoder decoder = Create(box.Options());
  ASSERT_EQ(lacerta_decoder_append(decoder.get(), box.bytes.data(), box.bytes.size(), nullptr), LACERTA_OK);
  const Read one = ReadGroup(decoder, 2, 0, box.names), rest = ReadGroup(decoder, 2, 1, box.names), all = ReadGroup(decoder, 2, LACERTA_ALL_GROUPS, box.names);
  EXPECT_EQ(one.attributes, 7u);
  EXPECT_EQ(rest.attributes, 3u);
  EXPECT_EQ(all.attributes, 7u);
  ASSERT_EQ(all.soup.positions.size(), one.soup.positions.size() + rest.soup.positions.size());
  EXPECT_TRUE(std::equal(one.normals.begin(), one.normals.end(), all.normals.begin()));
  EXPECT_TRUE(std::equal(rest.normals.begin(), rest.normals.end(), all.normals.begin() + static_cast<ptrdiff_t>(one.normals.size())));
  const std::vector<float>& colors = all.soup.attributes[2].values;
  EXPECT_TRUE(std::equal(one.soup.attributes[2].values.begin(), one.soup.attributes[2].values.end(), colors.begin()));
  EXPECT_EQ(std::count(colors.begin() + static_cast<ptrdiff_t>(3 * one.soup.positions.size()), colors.end(), 0.0f), static_cast<ptrdiff_t>(3 * rest.soup.positions.size()));
  // The side of 2 x 2 squares, split twice, has 4 x 8 vertices on its border, which the other sides have bit by bit.
  size_t shared = 0;
  for (size_t v = 0; v < one.soup.positions.size(); ++v) {
    const auto found = std::find(rest.soup.positions.begin(), rest.soup.positions.end(), one.soup.positions[v]);
    if (found == rest.soup.positions.end()) continue;
    ++shared;
    EXPECT_EQ(rest.normals[static_cast<size_t>(found - rest.soup.positions.begin())], one.normals[v]);
  }
  EXPECT_EQ(shared, 32u);
}

TEST(LacertaCGroups, EveryPrefixAndEveryFlippedByteKeepsALevel) {
  const Box box;
  const lacerta_decoder_options options = box.Options();
  const std::vector<VertexSoup> expected[] = {box.Expected(0), box.Expected(1), box.Expected(2)};
  for (size_t i = 0; i < box.bytes.size(); i += 3) {
    for (const bool is_flipped : {false, true}) {
      Bytes bytes(box.bytes.begin(), is_flipped ? box.bytes.end() : box.bytes.begin() + static_cast<ptrdiff_t>(i));
      if (is_flipped) bytes[i] ^= 0x55;
      lacerta_decoder* made = nullptr;
      const lacerta_result result = lacerta_decode_prefix(bytes.data(), bytes.size(), &options, &made);
      const Decoder decoder(made);
      if (!is_flipped) {
        ASSERT_EQ(result == LACERTA_OK, i >= box.base_size()) << i;
      }
      ASSERT_TRUE(result == LACERTA_OK || result == LACERTA_INVALID_DATA || result == LACERTA_UNSUPPORTED || result == LACERTA_LIMIT_EXCEEDED) << result;
      ASSERT_TRUE(decoder != nullptr || i < box.base_size()) << i;
      if (!decoder) continue;
      const int level = Progress(decoder).level;
      ASSERT_GE(level, 0);
      if (!is_flipped || i >= box.base_size()) ExpectSame(ReadGroup(decoder, level, 0, box.names).soup, expected[level][0]);
    }
  }
}

TEST(LacertaCGroups, MisuseIsNamed) {
  const Box box;
  lacerta_decoder* made = nullptr;
  lacerta_decoder_options options = box.Options();
  options.base_size = 1;
  EXPECT_EQ(lacerta_decoder_create(&options, &made), LACERTA_INVALID_ARGUMENT);
  options = box.Options();
  options.base_lengths = nullptr;
  EXPECT_EQ(lacerta_decoder_create(&options, &made), LACERTA_INVALID_ARGUMENT);
  options = box.Options();
  options.num_attributes = 33;
  EXPECT_EQ(lacerta_decoder_create(&options, &made), LACERTA_INVALID_ARGUMENT);
  const std::vector<const char*> twice = {"NORMAL", "NORMAL", "COLOR_0"};
  options = box.Options();
  options.attribute_names = twice.data();
  EXPECT_EQ(lacerta_decoder_create(&options, &made), LACERTA_INVALID_ARGUMENT);

  // Names that are not the stream's leave the base.
  const std::vector<const char*> others = {"TEXCOORD_0", "NORMAL", "COLOR_1"};
  options.attribute_names = others.data();
  const Decoder renamed = Create(options);
  EXPECT_EQ(lacerta_decoder_append(renamed.get(), box.bytes.data(), box.bytes.size(), nullptr), LACERTA_INVALID_DATA);
  EXPECT_THAT(Message(renamed), HasSubstr("does not carry the attributes"));
  EXPECT_EQ(Progress(renamed).level, 0);

  const Decoder decoder = Create(box.Options());
  ASSERT_EQ(lacerta_decoder_append(decoder.get(), box.bytes.data(), box.bytes.size(), nullptr), LACERTA_OK);
  lacerta_mesh_size size = LACERTA_MESH_SIZE_INIT;
  EXPECT_EQ(lacerta_decoder_get_mesh_size(decoder.get(), 2, 2, &size), LACERTA_INVALID_ARGUMENT);
  EXPECT_THAT(Message(decoder), HasSubstr("group 2 is not there; the stream has 2"));
  lacerta_attribute attribute = LACERTA_ATTRIBUTE_INIT;
  EXPECT_EQ(lacerta_decoder_get_attribute(decoder.get(), 3, &attribute), LACERTA_INVALID_ARGUMENT);

  // Programs built before there were groups pass a shorter struct.
  lacerta_decoder_options old = LACERTA_DECODER_OPTIONS_INIT;
  old.struct_size = static_cast<uint32_t>(offsetof(lacerta_decoder_options, base_lengths));
  old.base_lengths = box.lengths.data();
  old.num_groups = 2;
  const Decoder plain = Create(old);
  EXPECT_EQ(Progress(plain).num_groups, 0u);
}

}  // namespace
}  // namespace lacerta
