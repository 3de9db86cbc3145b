#include "remesh/unsubdivide.h"

#include <algorithm>
#include <array>
#include <utility>

#include "common/subdivision.h"

namespace lacerta {
namespace {

// What a face is to the split: a corner face whose even vertex (one of the coarser mesh) is corner 0, 1 or 2, or the middle
// face of a coarser one, all of whose vertices are odd (midpoints).
using Part = uint8_t;
constexpr Part kMiddle = 3, kUnknown = 4;

// Whether each vertex has the edges that a midpoint has: six, or four on the border.
std::vector<uint8_t> RegularVertices(const Topology& t) {
  std::vector<uint8_t> regular(t.num_vertices);
  for (uint32_t v = 0; v < t.num_vertices; ++v) regular[v] = t.valence[v] == 6;
  for (uint32_t e = 0; e < t.num_edges(); ++e) {
    if (!t.is_border(e)) continue;
    for (const uint32_t v : t.edges[e]) regular[v] = t.valence[v] == 4;
  }
  return regular;
}

// Spreads the part of `seed` over its component: each face fixes what the three around it are. False, and all as before, where
// that contradicts itself or makes an irregular vertex odd.
bool Spread(const Topology& t, const std::vector<uint8_t>& regular, uint32_t seed, Part part, std::vector<Part>* parts) {
  std::vector<uint32_t> reached;
  const auto enter = [&](uint32_t face, Part required) {
    Part& present = (*parts)[face];
    if (present != kUnknown) return present == required;
    for (Part k = 0; k < 3; ++k) {
      if (k != required && regular[t.triangles[face][k]] == 0) return false;
    }
    present = required;
    reached.push_back(face);
    return true;
  };
  if (!enter(seed, part)) return false;
  for (size_t i = 0; i < reached.size(); ++i) {
    const uint32_t f = reached[i];
    const Part p = (*parts)[f];
    for (int k = 0; k < 3; ++k) {
      const uint32_t edge = t.face_edges[f][k], g = FaceAcross(t, f, edge);
      const bool inner = p == kMiddle || p == k;  // between a middle face and a corner face: never on the border
      bool agrees = false;
      if (g == kNone) {
        agrees = !inner;
      } else if (p == k) {
        agrees = enter(g, kMiddle);
      } else if (inner) {
        agrees = enter(g, static_cast<Part>(EdgeCorner(t, g, edge)));
      } else {  // half of a coarser edge: both sides have the same even vertex
        const Triangle& other = t.triangles[g];
        agrees = enter(g, static_cast<Part>(std::find(other.begin(), other.end(), t.triangles[f][p]) - other.begin()));
      }
      if (agrees) continue;
      for (const uint32_t r : reached) (*parts)[r] = kUnknown;
      return false;
    }
  }
  return true;
}

// Parts of all faces. A component with any vertex that is not regular allows one choice at most; one without allows several,
// which its symmetries turn into each other.
std::optional<std::vector<Part>> FindParts(const Topology& t) {
  const std::vector<uint8_t> regular = RegularVertices(t);
  std::vector<Part> parts(t.num_faces(), kUnknown);
  for (uint32_t f = 0; f < t.num_faces(); ++f) {
    for (Part p = 0; p <= kMiddle && parts[f] == kUnknown; ++p) Spread(t, regular, f, p, &parts);
    if (parts[f] == kUnknown) return std::nullopt;
  }
  return parts;
}

// A mesh one level coarser.
struct Coarser {
  Topology topology;
  std::vector<uint32_t> even;       // #V, its vertices in the finer mesh, ascending
  std::vector<uint32_t> midpoints;  // #E, the odd vertices in the finer mesh
};

std::optional<Coarser> UndoOne(const Topology& t) {
  if (t.num_faces() % 4 != 0) return std::nullopt;
  const std::optional<std::vector<Part>> parts = FindParts(t);
  if (!parts) return std::nullopt;
  std::vector<uint8_t> is_even(t.num_vertices, 0);
  for (uint32_t f = 0; f < t.num_faces(); ++f) {
    if ((*parts)[f] != kMiddle) is_even[t.triangles[f][(*parts)[f]]] = 1;
  }
  Coarser coarser;
  std::vector<uint32_t> number(t.num_vertices, kNone);
  for (uint32_t v = 0; v < t.num_vertices; ++v) {
    if (is_even[v] == 0) continue;
    number[v] = static_cast<uint32_t>(coarser.even.size());
    coarser.even.push_back(v);
  }
  std::vector<Triangle> triangles, middles;
  for (uint32_t f = 0; f < t.num_faces(); ++f) {
    if ((*parts)[f] != kMiddle) continue;
    Triangle triangle;
    for (int k = 0; k < 3; ++k) {
      const uint32_t edge = t.face_edges[f][k];
      triangle[k] = number[OppositeVertex(t, FaceAcross(t, f, edge), edge)];
    }
    triangles.push_back(triangle);
    middles.push_back(t.triangles[f]);
  }
  StatusOr<Topology> topology = BuildTopology(static_cast<uint32_t>(coarser.even.size()), triangles);
  if (!topology.ok()) return std::nullopt;  // a torus around which there are too few triangles, say
  // Every odd vertex belongs to one edge.
  if (coarser.even.size() + topology.value().num_edges() != t.num_vertices) return std::nullopt;
  coarser.topology = std::move(topology).value();
  coarser.midpoints.assign(coarser.topology.num_edges(), kNone);
  for (uint32_t f = 0; f < coarser.topology.num_faces(); ++f) {
    for (int k = 0; k < 3; ++k) {
      uint32_t& midpoint = coarser.midpoints[coarser.topology.face_edges[f][k]];
      if (midpoint != kNone && midpoint != middles[f][k]) return std::nullopt;
      midpoint = middles[f][k];
    }
  }
  return coarser;
}

// The input vertex at the middle of each edge, by the input vertices at its ends. The levels do not get in each other's way: an
// edge has an odd vertex of its own level, and no coarser level has that. Sorted, as no numbering of the input slows that down.
class Midpoints {
 public:
  void Add(uint32_t a, uint32_t b, uint32_t midpoint) { sorted_.emplace_back(Key(a, b), midpoint); }
  // To be called between the last Add and the first Find.
  void Sort() { std::sort(sorted_.begin(), sorted_.end()); }
  uint32_t Find(uint32_t a, uint32_t b) const {
    const auto it = std::lower_bound(sorted_.begin(), sorted_.end(), std::pair(Key(a, b), uint32_t{0}));
    return it == sorted_.end() || it->first != Key(a, b) ? kNone : it->second;
  }

 private:
  static uint64_t Key(uint64_t a, uint64_t b) { return std::min(a, b) << 32 | std::max(a, b); }
  std::vector<std::pair<uint64_t, uint32_t>> sorted_;
};

// Gives all levels over a base the numbers that a decoder gives them, from the input vertices of the base; also the triangles of
// the finest level, in those numbers. `base` has valid triangles. None where a midpoint is missing.
struct NumberedLevels {
  std::vector<uint32_t> input_vertex;
  std::vector<Triangle> triangles;
};
std::optional<NumberedLevels> NumberLevels(Topology level, std::vector<uint32_t> input_vertex, int num_levels,
                                           const Midpoints& midpoints) {
  for (int i = 0; i < num_levels; ++i) {
    for (const auto& [a, b] : level.edges) {
      const uint32_t midpoint = midpoints.Find(input_vertex[a], input_vertex[b]);
      if (midpoint == kNone) return std::nullopt;
      input_vertex.push_back(midpoint);
    }
    level = Refine(level);
  }
  return NumberedLevels{std::move(input_vertex), std::move(level.triangles)};
}

// Triangles as a set: each with its smallest vertex first, in ascending order.
std::vector<Triangle> AsSet(std::vector<Triangle> triangles) {
  for (Triangle& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

bool IsSameMesh(const NumberedLevels& levels, const TriangleMesh& input) {
  if (levels.input_vertex.size() != input.positions.size()) return false;
  std::vector<Triangle> triangles = levels.triangles;
  for (Triangle& t : triangles) {
    for (uint32_t& v : t) v = levels.input_vertex[v];
  }
  return AsSet(std::move(triangles)) == AsSet(input.triangles);
}

// Whether vertices of six faces, or of three as on borders, are as many as midpoints would be: of every four faces one is a middle face, with three
// midpoints that belong to two faces at most. Tells of most meshes that they are not subdivided without their topology, which takes
// several times their memory.
bool MayBeSubdivided(const TriangleMesh& mesh) {
  std::vector<uint8_t> num_faces(mesh.positions.size(), 0);
  for (const Triangle& t : mesh.triangles) {
    for (const uint32_t v : t) {
      if (v >= num_faces.size()) return false;
      num_faces[v] = static_cast<uint8_t>(std::min(num_faces[v] + 1, 255));
    }
  }
  const auto regular = std::count_if(num_faces.begin(), num_faces.end(), [](uint8_t count) { return count == 6 || count == 3; });
  return static_cast<uint64_t>(regular) * 8 >= uint64_t{3} * mesh.triangles.size();
}

}  // namespace

std::optional<Unsubdivided> UndoSubdivision(const TriangleMesh& mesh, int max_levels) {
  if (mesh.triangles.empty() || mesh.triangles.size() % 4 != 0 || !MayBeSubdivided(mesh)) return std::nullopt;
  StatusOr<Topology> finest = BuildTopology(static_cast<uint32_t>(mesh.positions.size()), mesh.triangles);
  if (!finest.ok()) return std::nullopt;
  const std::vector<uint16_t>& valence = finest.value().valence;
  if (std::find(valence.begin(), valence.end(), 0) != valence.end()) return std::nullopt;

  Unsubdivided result;
  Topology level = std::move(finest).value();
  std::vector<uint32_t> input_vertex(level.num_vertices);
  for (uint32_t v = 0; v < level.num_vertices; ++v) input_vertex[v] = v;
  Midpoints midpoints;
  for (; result.num_levels < max_levels; ++result.num_levels) {
    std::optional<Coarser> coarser = UndoOne(level);
    if (!coarser) break;
    std::vector<uint32_t> coarser_input;
    for (const uint32_t v : coarser->even) coarser_input.push_back(input_vertex[v]);
    for (uint32_t e = 0; e < coarser->topology.num_edges(); ++e) {
      const auto& [a, b] = coarser->topology.edges[e];
      midpoints.Add(coarser_input[a], coarser_input[b], input_vertex[coarser->midpoints[e]]);
    }
    level = std::move(coarser->topology);
    input_vertex = std::move(coarser_input);
  }
  if (result.num_levels == 0) return std::nullopt;
  midpoints.Sort();
  result.base_triangles = level.triangles;
  result.num_base_vertices = level.num_vertices;
  std::optional<NumberedLevels> levels = NumberLevels(std::move(level), std::move(input_vertex), result.num_levels, midpoints);
  if (!levels || !IsSameMesh(*levels, mesh)) return std::nullopt;
  result.input_vertex = std::move(levels->input_vertex);
  return result;
}

Unsubdivided Reorder(const Unsubdivided& mesh, const std::vector<uint32_t>& vertex_map,
                     const std::vector<Triangle>& base_triangles) {
  Midpoints midpoints;
  Topology level = BuildTopology(mesh.num_base_vertices, mesh.base_triangles).value();
  for (int i = 0; i < mesh.num_levels; ++i) {
    for (uint32_t e = 0; e < level.num_edges(); ++e) {
      const auto& [a, b] = level.edges[e];
      midpoints.Add(mesh.input_vertex[a], mesh.input_vertex[b], mesh.input_vertex[level.num_vertices + e]);
    }
    level = Refine(level);
  }
  midpoints.Sort();
  std::vector<uint32_t> input_vertex;
  input_vertex.reserve(vertex_map.size());
  for (const uint32_t v : vertex_map) input_vertex.push_back(mesh.input_vertex[v]);
  Topology base = BuildTopology(mesh.num_base_vertices, base_triangles).value();
  NumberedLevels levels = NumberLevels(std::move(base), std::move(input_vertex), mesh.num_levels, midpoints).value();
  return {base_triangles, mesh.num_base_vertices, mesh.num_levels, std::move(levels.input_vertex)};
}

}  // namespace lacerta
