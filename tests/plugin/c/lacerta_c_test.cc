// The C functions against the C++ ones on golden streams, and what they say to whoever misuses them.
#include "lacerta.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "lacerta/codec.h"
#include "plugin/c/decoder_handle.h"

namespace lacerta {
namespace {

using ::testing::AnyOf;
using ::testing::Each;
using ::testing::HasSubstr;
using testing::Create;
using testing::Decoder;
using testing::Message;
using testing::Progress;

const char* const kForms[] = {"draco_form.drc", "custom_form.drc", "custom_form_compact.drc"};

Bytes Golden(const std::string& name) {
  std::ifstream file(std::string(LACERTA_GOLDEN_DIR) + "/v1/" + name, std::ios::binary);
  return Bytes(std::istreambuf_iterator<char>(file), {});
}

lacerta_result Append(const Decoder& decoder, Span<const uint8_t> bytes, int32_t* level = nullptr) {
  return lacerta_decoder_append(decoder.get(), bytes.data(), bytes.size(), level);
}

struct Read {
  TriangleMesh mesh;
  std::vector<Vec3f> normals;
};

Read ReadLevel(const Decoder& decoder, int level) {
  lacerta_mesh_size size = LACERTA_MESH_SIZE_INIT;
  EXPECT_EQ(lacerta_decoder_get_mesh_size(decoder.get(), level, LACERTA_ALL_GROUPS, &size), LACERTA_OK) << Message(decoder);
  Read read;
  read.mesh.positions.resize(size.num_vertices);
  read.mesh.triangles.resize(size.num_triangles);
  read.normals.resize(size.num_vertices);
  lacerta_mesh_buffers buffers = LACERTA_MESH_BUFFERS_INIT;
  buffers.max_vertices = size.num_vertices;
  buffers.max_triangles = size.num_triangles;
  buffers.positions = &read.mesh.positions[0].x;
  buffers.normals = &read.normals[0].x;
  buffers.indices = read.mesh.triangles[0].data();
  EXPECT_EQ(lacerta_decoder_read_mesh(decoder.get(), level, 0, &buffers), LACERTA_OK) << Message(decoder);
  return read;
}

TriangleMesh Expected(const Bytes& stream, int level) {
  DecodeOptions options;
  options.max_level = level;
  return DecodeMesh(stream, options).value().mesh;
}

void ExpectSame(const TriangleMesh& a, const TriangleMesh& b) {
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.triangles, b.triangles);
}

TEST(LacertaC, VersionIsThatOfTheHeader) {
  EXPECT_EQ(lacerta_version(), LACERTA_VERSION_MAJOR << 16 | LACERTA_VERSION_MINOR << 8 | LACERTA_VERSION_PATCH);
  EXPECT_STREQ(lacerta_result_name(LACERTA_NEEDS_BASE), "needs base");
  EXPECT_STREQ(lacerta_result_name(99), "unknown result");
}

TEST(LacertaC, EveryFormDecodesByteForByteToTheLevelsOfTheLibrary) {
  for (const char* form : kForms) {
    SCOPED_TRACE(form);
    const Bytes stream = Golden(form);
    const Decoder decoder = Create();
    int32_t level = -2, before = -1;
    for (size_t i = 0; i < stream.size(); ++i) {
      ASSERT_EQ(Append(decoder, Span<const uint8_t>(stream).Subspan(i).First(1), &level), LACERTA_OK) << Message(decoder);
      ASSERT_GE(level, before);
      ASSERT_LE(level, before + 1);
      before = level;
    }
    ASSERT_EQ(level, 2);
    const lacerta_progress progress = Progress(decoder);
    EXPECT_EQ(progress.num_levels, 2);
    EXPECT_EQ(progress.state, 2);
    EXPECT_EQ(progress.is_complete, 1);
    EXPECT_EQ(progress.has_layers, 0);
    EXPECT_EQ(progress.bytes_used, stream.size());
    EXPECT_EQ(progress.num_groups, 1u);
    for (const int shown : {0, 1, 2, 0, 2}) ExpectSame(ReadLevel(decoder, shown).mesh, Expected(stream, shown));
  }
}

TEST(LacertaC, NormalsAreUnitAndPointOutOfTheSurface) {
  const Bytes stream = Golden("draco_form.drc");
  lacerta_decoder* made = nullptr;
  ASSERT_EQ(lacerta_decode_prefix(stream.data(), stream.size(), nullptr, &made), LACERTA_OK);
  const Decoder decoder(made);
  const Read read = ReadLevel(decoder, 2);
  double agreement = 0.0;
  for (const Triangle& t : read.mesh.triangles) {
    const Vec3f* p = read.mesh.positions.data();
    const Vec3f flat = Normalized(Cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]));
    for (const uint32_t v : t) agreement += Dot(flat, read.normals[v]);
  }
  agreement /= static_cast<double>(3 * read.mesh.triangles.size());
  EXPECT_GT(agreement, 0.9);   // a smooth surface
  EXPECT_LT(agreement, 1.0 - 1e-6);  // but no plane
  for (const Vec3f& normal : read.normals) EXPECT_NEAR(Norm(normal), 1.0f, 1e-6f);
}

TEST(LacertaC, AHostsBaseLeadsToTheSameLevels) {
  const Bytes stream = Golden("draco_form.drc");
  const TriangleMesh base = Expected(stream, 0);
  const auto set_base = [&](const Decoder& decoder) {
    return lacerta_decoder_set_base(decoder.get(), &base.positions[0].x, static_cast<uint32_t>(base.positions.size()),
                                    base.triangles[0].data(), static_cast<uint32_t>(base.triangles.size()));
  };
  // Where the base section ends, nobody has to say; what stands behind it is enough, too.
  size_t base_size = 0;
  {
    const Decoder decoder = Create();
    ASSERT_EQ(set_base(decoder), LACERTA_OK);
    EXPECT_EQ(Progress(decoder).level, 0);
    int32_t level = -1;
    for (size_t i = 0; i < stream.size(); ++i) {
      ASSERT_EQ(Append(decoder, Span<const uint8_t>(stream).Subspan(i).First(1), &level), LACERTA_OK) << Message(decoder);
    }
    ASSERT_EQ(level, 2);
    EXPECT_EQ(Progress(decoder).bytes_used, stream.size());
    ExpectSame(ReadLevel(decoder, 2).mesh, Expected(stream, 2));
    while (std::memcmp(stream.data() + base_size, "LAC\1", 4) != 0) ++base_size;
  }
  {
    const Decoder decoder = Create();
    ASSERT_EQ(set_base(decoder), LACERTA_OK);
    ASSERT_EQ(Append(decoder, Span<const uint8_t>(stream).Subspan(base_size)), LACERTA_OK) << Message(decoder);
    ExpectSame(ReadLevel(decoder, 2).mesh, Expected(stream, 2));
  }
  {
    lacerta_decoder_options options = LACERTA_DECODER_OPTIONS_INIT;
    options.base_size = base_size;
    const Decoder decoder = Create(&options);
    ASSERT_EQ(set_base(decoder), LACERTA_OK);
    ASSERT_EQ(Append(decoder, stream), LACERTA_OK) << Message(decoder);
    ExpectSame(ReadLevel(decoder, 2).mesh, Expected(stream, 2));
    EXPECT_EQ(set_base(decoder), LACERTA_INVALID_ARGUMENT);
  }
}

TEST(LacertaC, AnotherBaseIsRefusedAndStaysOnTheScreen) {
  const Bytes stream = Golden("draco_form.drc");
  TriangleMesh base = Expected(stream, 0);
  std::swap(base.triangles[0], base.triangles[1]);
  lacerta_decoder_options options = LACERTA_DECODER_OPTIONS_INIT;
  while (std::memcmp(stream.data() + options.base_size, "LAC\1", 4) != 0) ++options.base_size;
  const Decoder decoder = Create(&options);
  ASSERT_EQ(lacerta_decoder_set_base(decoder.get(), &base.positions[0].x, static_cast<uint32_t>(base.positions.size()),
                                     base.triangles[0].data(), static_cast<uint32_t>(base.triangles.size())), LACERTA_OK);
  int32_t level = -1;
  EXPECT_EQ(Append(decoder, stream, &level), LACERTA_INVALID_DATA);
  EXPECT_THAT(Message(decoder), HasSubstr("another base"));
  EXPECT_EQ(level, 0);
  ExpectSame(ReadLevel(decoder, 0).mesh, base);
}

TEST(LacertaC, EveryPrefixShowsItsLevels) {
  for (const char* form : kForms) {
    SCOPED_TRACE(form);
    const Bytes stream = Golden(form);
    for (size_t size = 0; size < stream.size(); ++size) {
      const Bytes exact(stream.begin(), stream.begin() + static_cast<ptrdiff_t>(size));  // so that a sanitizer sees one byte too far
      lacerta_decoder* made = nullptr;
      const lacerta_result result = lacerta_decode_prefix(exact.data(), exact.size(), nullptr, &made);
      const Decoder decoder(made);
      const auto expected = DecodeMesh(exact, {});
      ASSERT_EQ(result == LACERTA_OK, expected.ok()) << size;
      ASSERT_EQ(decoder != nullptr, expected.ok()) << size;
      if (decoder) {
        ASSERT_EQ(Progress(decoder).level, expected.value().level) << size;
      }
    }
  }
}

TEST(LacertaC, DamageKeepsTheLevelsBefore) {
  const Bytes stream = Golden("custom_form_compact.drc");
  ASSERT_FALSE(stream.empty());
  Bytes damaged = stream;
  damaged[damaged.size() - 1] ^= 1;
  const Decoder decoder = Create();
  int32_t level = -1;
  EXPECT_EQ(Append(decoder, damaged, &level), LACERTA_INVALID_DATA);
  EXPECT_THAT(Message(decoder), HasSubstr("level 2"));
  EXPECT_EQ(level, 1);
  ExpectSame(ReadLevel(decoder, 1).mesh, Expected(stream, 1));
  EXPECT_EQ(Append(decoder, stream, &level), LACERTA_INVALID_DATA);
  EXPECT_EQ(level, 1);
}

TEST(LacertaC, AnyFlippedByteIsRefusedOrHarmless) {
  for (const char* form : kForms) {
    const Bytes stream = Golden(form);
    for (size_t i = 0; i < stream.size(); ++i) {
      Bytes damaged = stream;
      damaged[i] ^= 0x55;
      lacerta_decoder* made = nullptr;
      const lacerta_result result = lacerta_decode_prefix(damaged.data(), damaged.size(), nullptr, &made);
      const Decoder decoder(made);
      ASSERT_THAT(result, AnyOf(LACERTA_OK, LACERTA_INVALID_DATA, LACERTA_UNSUPPORTED, LACERTA_LIMIT_EXCEEDED)) << form << ' ' << i;
      if (decoder) ReadLevel(decoder, Progress(decoder).level);
    }
  }
}

TEST(LacertaC, MaxLevelAndLimitsEndTheRefinement) {
  const Bytes stream = Golden("draco_form.drc");
  lacerta_decoder_options options = LACERTA_DECODER_OPTIONS_INIT;
  options.max_level = 1;
  lacerta_decoder* made = nullptr;
  ASSERT_EQ(lacerta_decode_prefix(stream.data(), stream.size(), &options, &made), LACERTA_OK);
  Decoder decoder(made);
  EXPECT_EQ(Progress(decoder).level, 1);
  EXPECT_EQ(Progress(decoder).is_complete, 1);
  options.max_level = -1;
  options.max_triangles = 240;
  ASSERT_EQ(lacerta_decode_prefix(stream.data(), stream.size(), &options, &made), LACERTA_LIMIT_EXCEEDED);
  decoder.reset(made);
  EXPECT_EQ(Progress(decoder).level, 1);
  options.max_triangles = 59;
  EXPECT_EQ(lacerta_decode_prefix(stream.data(), stream.size(), &options, &made), LACERTA_LIMIT_EXCEEDED);
  EXPECT_EQ(made, nullptr);
}

TEST(LacertaC, MisuseIsNamed) {
  EXPECT_EQ(lacerta_decoder_create(nullptr, nullptr), LACERTA_INVALID_ARGUMENT);
  lacerta_decoder_options options = LACERTA_DECODER_OPTIONS_INIT;
  options.struct_size = 4;
  lacerta_decoder* made = nullptr;
  EXPECT_EQ(lacerta_decoder_create(&options, &made), LACERTA_INVALID_ARGUMENT);
  EXPECT_EQ(lacerta_decoder_append(nullptr, "", 0, nullptr), LACERTA_INVALID_ARGUMENT);
  lacerta_decoder_destroy(nullptr);

  const Decoder decoder = Create();
  EXPECT_EQ(lacerta_decoder_append(decoder.get(), nullptr, 3, nullptr), LACERTA_INVALID_ARGUMENT);
  lacerta_mesh_size size = LACERTA_MESH_SIZE_INIT;
  EXPECT_EQ(lacerta_decoder_get_mesh_size(decoder.get(), 0, 0, &size), LACERTA_INVALID_ARGUMENT);
  EXPECT_THAT(Message(decoder), HasSubstr("level 0 is not there"));
  ASSERT_EQ(Append(decoder, Golden("draco_form.drc")), LACERTA_OK);
  EXPECT_EQ(Message(decoder), "");
  EXPECT_EQ(lacerta_decoder_get_mesh_size(decoder.get(), 3, 0, &size), LACERTA_INVALID_ARGUMENT);
  EXPECT_EQ(lacerta_decoder_get_mesh_size(decoder.get(), 2, 1, &size), LACERTA_INVALID_ARGUMENT);
  ASSERT_EQ(lacerta_decoder_get_mesh_size(decoder.get(), 2, 0, &size), LACERTA_OK);
  lacerta_mesh_buffers buffers = LACERTA_MESH_BUFFERS_INIT;
  std::vector<float> positions(3 * size.num_vertices, 7.0f);
  buffers.positions = positions.data();
  buffers.max_vertices = size.num_vertices - 1;
  buffers.max_triangles = size.num_triangles;
  EXPECT_EQ(lacerta_decoder_read_mesh(decoder.get(), 2, 0, &buffers), LACERTA_INVALID_ARGUMENT);
  EXPECT_THAT(positions, Each(7.0f));
  char text[8];
  EXPECT_GT(lacerta_decoder_message(decoder.get(), text, sizeof(text)), 7u);
  EXPECT_EQ(std::strlen(text), 7u);

  const Decoder other = Create();
  EXPECT_EQ(Append(other, Bytes{'D', 'R', 'E'}), LACERTA_INVALID_DATA);
  EXPECT_THAT(Message(other), HasSubstr("DRACO"));
}

TEST(LacertaC, TheCallersAllocatorGetsEverythingBack) {
  struct Meter {
    size_t held = 0, most = 0, left = SIZE_MAX;
  } meter;
  const lacerta_allocator allocator = {[](void* user, size_t size) -> void* {
                                         auto* m = static_cast<Meter*>(user);
                                         if (size > m->left) return nullptr;
                                         m->held += size;
                                         m->most = std::max(m->most, m->held);
                                         return std::malloc(size);
                                       },
                                       [](void* user, void* memory, size_t size) {
                                         static_cast<Meter*>(user)->held -= size;
                                         std::free(memory);
                                       },
                                       &meter};
  lacerta_decoder_options options = LACERTA_DECODER_OPTIONS_INIT;
  options.allocator = &allocator;
  const Bytes stream = Golden("draco_form.drc");
  {
    const Decoder decoder = Create(&options);
    ASSERT_EQ(Append(decoder, stream), LACERTA_OK);
    EXPECT_EQ(Progress(decoder).level, 2);
  }
  EXPECT_EQ(meter.held, 0u);
  EXPECT_GE(meter.most, stream.size());
  {
    const Decoder decoder = Create(&options);
    meter.left = 0;
    EXPECT_EQ(Append(decoder, stream), LACERTA_OUT_OF_MEMORY);
    EXPECT_EQ(Message(decoder), "out of memory");
  }
  EXPECT_EQ(meter.held, 0u);
  lacerta_decoder* made = nullptr;
  EXPECT_EQ(lacerta_decoder_create(&options, &made), LACERTA_OUT_OF_MEMORY);
}

TEST(LacertaC, OneDecoderMayBeUsedByTwoThreads) {
  const Bytes stream = Golden("custom_form_compact.drc");
  const Decoder decoder = Create();
  std::thread writer([&] {
    for (const uint8_t& byte : stream) Append(decoder, {&byte, 1});
  });
  for (int32_t level = -1; level < 2;) {
    level = Progress(decoder).level;
    if (level >= 0) {
      EXPECT_FALSE(ReadLevel(decoder, level).mesh.triangles.empty());
    }
  }
  writer.join();
  ExpectSame(ReadLevel(decoder, 2).mesh, Expected(stream, 2));
}

}  // namespace
}  // namespace lacerta
