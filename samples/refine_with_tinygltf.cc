// Progressive meshes in an engine that loads glTF with tinygltf: refine_with_tinygltf IN.glb [MAX_LEVEL]
// tinygltf loads the asset with the coarse fallback meshes, Lacerta replaces them, and the engine goes on as ever.
#define TINYGLTF_IMPLEMENTATION  // in one file of the program; libtinygltf.so must not be linked beside Draco
#include <lacerta/tinygltf.h>

#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

// This program shows no textures; an engine would decode them here or leave it to stb_image.
bool IgnoreImage(tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*, int, void*) {
  return true;
}

bool Load(const std::string& path, tinygltf::Model* model) {
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(IgnoreImage, nullptr);
  std::string error;
  std::string warning;
  const bool loaded = loader.LoadBinaryFromFile(model, &error, &warning, path);
  if (!loaded) std::fprintf(stderr, "refine_with_tinygltf: %s: %s\n", path.c_str(), error.c_str());
  return loaded;
}

void PrintTriangles(const char* when, const tinygltf::Model& model) {
  for (const tinygltf::Mesh& mesh : model.meshes) {
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
      if (primitive.mode != TINYGLTF_MODE_TRIANGLES || primitive.indices < 0) continue;
      const size_t corners = model.accessors[static_cast<size_t>(primitive.indices)].count;
      std::printf("%s: %s: %zu triangles\n", when, mesh.name.c_str(), corners / 3);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    std::fprintf(stderr, "usage: refine_with_tinygltf IN.glb [MAX_LEVEL]\n");
    return 2;
  }
  tinygltf::Model model;
  if (!Load(argv[1], &model)) return 1;
  PrintTriangles("loaded", model);

  lacerta::RefineOptions options;
  if (argc > 2) options.max_level = std::atoi(argv[2]);
  const lacerta::StatusOr<lacerta::RefineResult> result = lacerta::RefineModel(&model, options);
  if (!result.ok()) {
    std::fprintf(stderr, "refine_with_tinygltf: %s\n", result.status().message().c_str());
    return 1;
  }
  for (const std::string& note : result.value().notes) std::printf("note: %s\n", note.c_str());
  PrintTriangles("refined", model);
  return 0;
}
