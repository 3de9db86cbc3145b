// The real meshes beside the project, for tests that are skipped where there are none.
#ifndef LACERTA_TESTS_SHAPES_REAL_MESHES_H_
#define LACERTA_TESTS_SHAPES_REAL_MESHES_H_

#include <cstddef>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "lacerta/mesh.h"

namespace lacerta::testing {

// A mesh from a ply file as libdraco and most tools write it: binary, little endian, float vertices, uchar/int faces.
inline std::optional<TriangleMesh> ReadBinaryPly(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::string line, element;
  size_t num_vertices = 0, num_triangles = 0, num_properties = 0;
  while (std::getline(in, line) && line != "end_header") {
    std::istringstream words(line);
    std::string keyword;
    words >> keyword;
    if (keyword == "element") {
      size_t count = 0;
      words >> element >> count;
      (element == "vertex" ? num_vertices : num_triangles) = count;
    } else if (keyword == "property" && element == "vertex") {
      ++num_properties;
    }
  }
  TriangleMesh mesh;
  std::vector<float> row(num_properties);
  for (size_t v = 0; v < num_vertices && num_properties >= 3; ++v) {
    in.read(reinterpret_cast<char*>(row.data()), static_cast<std::streamsize>(num_properties * sizeof(float)));
    mesh.positions.push_back({row[0], row[1], row[2]});
  }
  for (size_t f = 0; f < num_triangles; ++f) {
    char corners = 0;
    Triangle t{};
    in.read(&corners, 1);
    in.read(reinterpret_cast<char*>(t.data()), sizeof(t));
    if (corners != 3) return std::nullopt;
    mesh.triangles.push_back(t);
  }
  return in.good() && !mesh.triangles.empty() ? std::optional(std::move(mesh)) : std::nullopt;
}

inline std::optional<TriangleMesh> RealMesh(const std::string& name) {
  return ReadBinaryPly(std::string(LACERTA_TEST_DATA_DIR) + "/" + name);
}

}  // namespace lacerta::testing

#endif  // LACERTA_TESTS_SHAPES_REAL_MESHES_H_
