// The C functions on arbitrary streams in arbitrary pieces, with and without groups and attributes, and with and without a base of the host's.
#include "lacerta.h"

#include <vector>

#include "fuzz/fuzz_input.h"

namespace {

using lacerta::fuzz::FuzzInput;

constexpr const char* kNames[] = {"TEXCOORD_0", "NORMAL", "COLOR_0"};
constexpr uint32_t kMostGroups = 3;

// An octahedron, and attributes of its six vertices.
constexpr float kPositions[] = {1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};
constexpr uint32_t kIndices[] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};

// The mesh of a level, or of one group of it, fits its announced size, and its indices its vertices.
void CheckMesh(lacerta_decoder* decoder, int32_t level, uint32_t group, uint32_t num_attributes) {
  lacerta_mesh_size size = LACERTA_MESH_SIZE_INIT;
  FUZZ_CHECK(lacerta_decoder_get_mesh_size(decoder, level, group, &size) == LACERTA_OK);
  std::vector<float> positions(3 * size.num_vertices), normals(positions.size());
  std::vector<uint32_t> indices(3 * size.num_triangles);
  std::vector<std::vector<float>> values(num_attributes);
  std::vector<float*> attributes;
  for (uint32_t i = 0; i < num_attributes; ++i) {
    lacerta_attribute attribute = LACERTA_ATTRIBUTE_INIT;
    FUZZ_CHECK(lacerta_decoder_get_attribute(decoder, i, &attribute) == LACERTA_OK);
    values[i].resize(size_t{attribute.components} * size.num_vertices);
    attributes.push_back(values[i].data());
  }
  lacerta_mesh_buffers buffers = LACERTA_MESH_BUFFERS_INIT;
  buffers.max_vertices = size.num_vertices;
  buffers.max_triangles = size.num_triangles;
  buffers.num_attributes = num_attributes;
  buffers.positions = positions.data();
  buffers.normals = normals.data();
  buffers.indices = indices.data();
  buffers.attributes = attributes.data();
  FUZZ_CHECK(lacerta_decoder_read_mesh(decoder, level, group, &buffers) == LACERTA_OK);
  for (const uint32_t index : indices) FUZZ_CHECK(index < size.num_vertices);
}

// Gives the decoder the octahedron as the base of a group, with attributes whose components and values the input chooses.
void SetGroup(FuzzInput* input, uint32_t group, uint32_t num_attributes, lacerta_decoder* decoder) {
  std::vector<uint32_t> components;
  std::vector<std::vector<float>> values;
  std::vector<const float*> attributes;
  for (uint32_t i = 0; i < num_attributes; ++i) {
    const uint8_t choice = input->Byte();
    components.push_back(1 + choice % 4);
    values.emplace_back(size_t{6} * components[i], static_cast<float>(choice >> 4));
    attributes.push_back(choice & 8 ? nullptr : values[i].data());
  }
  lacerta_base_group base = LACERTA_BASE_GROUP_INIT;
  base.num_vertices = 6;
  base.num_triangles = 8;
  base.num_attributes = num_attributes;
  base.positions = kPositions;
  base.indices = kIndices;
  base.attributes = attributes.data();
  base.components = components.data();
  lacerta_decoder_set_base_group(decoder, group, &base);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  FuzzInput input(data, size);
  lacerta_decoder_options options = LACERTA_DECODER_OPTIONS_INIT;
  options.max_vertices = 3000;
  options.max_triangles = 6000;
  const uint8_t choice = input.Byte();
  options.base_size = choice & 1 ? input.Word16() : 0;
  options.max_level = choice & 2 ? input.Byte() % 4 : -1;
  const size_t piece = 1 + input.Byte();
  uint64_t lengths[kMostGroups] = {};
  if (choice & 8) {
    const uint8_t counts = input.Byte();
    options.num_groups = 1 + counts % kMostGroups;
    options.num_attributes = counts / kMostGroups % 4;
    for (uint32_t g = 0; g < options.num_groups; ++g) lengths[g] = input.Word16();
    options.base_lengths = lengths;
    options.attribute_names = kNames;
  }
  lacerta_decoder* decoder = nullptr;
  const lacerta_result created = lacerta_decoder_create(&options, &decoder);
  if (created != LACERTA_OK) {
    FUZZ_CHECK(options.num_groups > 0 && decoder == nullptr);  // lengths that do not add up
    return 0;
  }
  if (choice & 4) {
    if (options.num_groups == 0) FUZZ_CHECK(lacerta_decoder_set_base(decoder, kPositions, 6, kIndices, 8) == LACERTA_OK);
    for (uint32_t g = 0; g < options.num_groups; ++g) SetGroup(&input, g, options.num_attributes, decoder);
  }
  int32_t level = -1;
  while (!input.empty()) {
    const lacerta::Span<const uint8_t> bytes = input.Take(piece);
    const int32_t before = level;
    lacerta_decoder_append(decoder, bytes.data(), bytes.size(), &level);
    FUZZ_CHECK(level >= before);
  }
  lacerta_decoder_finish(decoder, &level);
  lacerta_progress progress = LACERTA_PROGRESS_INIT;
  FUZZ_CHECK(lacerta_decoder_get_progress(decoder, &progress) == LACERTA_OK && progress.level == level);
  for (int32_t shown = 0; shown <= level; ++shown) {
    CheckMesh(decoder, shown, LACERTA_ALL_GROUPS, progress.num_attributes);
    for (uint32_t g = 0; g < progress.num_groups; ++g) CheckMesh(decoder, shown, g, progress.num_attributes);
  }
  lacerta_decoder_destroy(decoder);
  return 0;
}
