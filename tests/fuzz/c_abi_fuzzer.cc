// The C functions on arbitrary streams in arbitrary pieces, with and without a base of the host's.
#include "lacerta.h"

#include <vector>

#include "fuzz/fuzz_input.h"

namespace {

// The mesh of a level fits its announced size, and its indices its vertices.
void CheckMesh(lacerta_decoder* decoder, int32_t level) {
  lacerta_mesh_size size = LACERTA_MESH_SIZE_INIT;
  FUZZ_CHECK(lacerta_decoder_get_mesh_size(decoder, level, LACERTA_ALL_GROUPS, &size) == LACERTA_OK);
  std::vector<float> positions(3 * size.num_vertices), normals(positions.size());
  std::vector<uint32_t> indices(3 * size.num_triangles);
  lacerta_mesh_buffers buffers = LACERTA_MESH_BUFFERS_INIT;
  buffers.max_vertices = size.num_vertices;
  buffers.max_triangles = size.num_triangles;
  buffers.positions = positions.data();
  buffers.normals = normals.data();
  buffers.indices = indices.data();
  FUZZ_CHECK(lacerta_decoder_read_mesh(decoder, level, 0, &buffers) == LACERTA_OK);
  for (const uint32_t index : indices) FUZZ_CHECK(index < size.num_vertices);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  lacerta::fuzz::FuzzInput input(data, size);
  lacerta_decoder_options options = LACERTA_DECODER_OPTIONS_INIT;
  options.max_vertices = 3000;
  options.max_triangles = 6000;
  const uint8_t choice = input.Byte();
  options.base_size = choice & 1 ? input.Word16() : 0;
  options.max_level = choice & 2 ? input.Byte() % 4 : -1;
  const size_t piece = 1 + input.Byte();
  lacerta_decoder* decoder = nullptr;
  FUZZ_CHECK(lacerta_decoder_create(&options, &decoder) == LACERTA_OK);
  if (choice & 4) {
    const float positions[] = {1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};
    const uint32_t indices[] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
    FUZZ_CHECK(lacerta_decoder_set_base(decoder, positions, 6, indices, 8) == LACERTA_OK);
  }
  int32_t level = -1;
  while (!input.empty()) {
    const lacerta::Span<const uint8_t> bytes = input.Take(piece);
    const int32_t before = level;
    lacerta_decoder_append(decoder, bytes.data(), bytes.size(), &level);
    FUZZ_CHECK(level >= before);
  }
  lacerta_decoder_finish(decoder, &level);
  for (int32_t shown = 0; shown <= level; ++shown) CheckMesh(decoder, shown);
  lacerta_decoder_destroy(decoder);
  return 0;
}
