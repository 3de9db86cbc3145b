#include "shapes/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <utility>

namespace lacerta::shapes {
namespace {

constexpr double kPi = 3.14159265358979323846;

TriangleMesh Icosahedron() {
  const float g = static_cast<float>((1.0 + std::sqrt(5.0)) / 2.0);
  TriangleMesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float one : {-1.0f, 1.0f}) {
      for (const float golden : {-g, g}) {
        Vec3f p;
        p[(axis + 1) % 3] = one;
        p[(axis + 2) % 3] = golden;
        mesh.positions.push_back(p);
      }
    }
  }
  // Faces are the triples of vertices with all edges of length 2, turned outwards.
  const auto adjacent = [&](uint32_t a, uint32_t b) {
    return std::fabs(SquaredNorm(mesh.positions[a] - mesh.positions[b]) - 4.0f) < 1e-3f;
  };
  for (uint32_t a = 0; a < 12; ++a) {
    for (uint32_t b = a + 1; b < 12; ++b) {
      for (uint32_t c = b + 1; c < 12; ++c) {
        if (!adjacent(a, b) || !adjacent(b, c) || !adjacent(c, a)) continue;
        const Vec3f &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
        const bool outwards = Dot(Cross(q - p, r - p), p) > 0.0f;
        mesh.triangles.push_back(outwards ? Triangle{a, b, c} : Triangle{a, c, b});
      }
    }
  }
  return mesh;
}

using Cell = std::array<int, 3>;

// The surface of the unit cubes for which `is_full`, inside the box of `size` cubes, every side split n times n.
TriangleMesh CubeSurface(const Cell& size, int n, const std::function<bool(const Cell&)>& is_full) {
  TriangleMesh mesh;
  std::map<Cell, uint32_t> vertices;
  const auto vertex = [&](const Cell& p) {
    const auto [at, is_new] = vertices.try_emplace(p, static_cast<uint32_t>(mesh.positions.size()));
    const float scale = 1.0f / static_cast<float>(n);
    if (is_new) {
      mesh.positions.push_back(Vec3f{static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])} *
                               scale);
    }
    return at->second;
  };
  const auto full = [&](const Cell& c) {
    for (int k = 0; k < 3; ++k) {
      if (c[k] < 0 || c[k] >= size[k]) return false;
    }
    return is_full(c);
  };
  const auto add_side = [&](const Cell& cell, int axis, int side) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        Cell corner = {cell[0] * n, cell[1] * n, cell[2] * n};
        corner[axis] += side * n;
        corner[u] += i;
        corner[v] += j;
        Cell right = corner, top = corner, opposite = corner;
        ++right[u];
        ++top[v];
        ++opposite[u];
        ++opposite[v];
        Triangle first{vertex(corner), vertex(right), vertex(opposite)};
        Triangle second{vertex(corner), vertex(opposite), vertex(top)};
        if (side == 0) {
          std::swap(first[1], first[2]);
          std::swap(second[1], second[2]);
        }
        mesh.triangles.push_back(first);
        mesh.triangles.push_back(second);
      }
    }
  };
  for (int x = 0; x < size[0]; ++x) {
    for (int y = 0; y < size[1]; ++y) {
      for (int z = 0; z < size[2]; ++z) {
        const Cell cell = {x, y, z};
        if (!full(cell)) continue;
        for (int axis = 0; axis < 3; ++axis) {
          for (int side = 0; side < 2; ++side) {
            Cell neighbor = cell;
            neighbor[axis] += side == 1 ? 1 : -1;
            if (!full(neighbor)) add_side(cell, axis, side);
          }
        }
      }
    }
  }
  return mesh;
}

// A share in [0, 1) from the top bits of the generator: std::uniform_real_distribution differs between libraries.
float NextShare(std::mt19937* random) { return static_cast<float>((*random)() >> 8) * 0x1p-24f; }

// Directions spread evenly over the sphere: a Fibonacci spiral.
Vec3f SpiralDirection(int k, int count) {
  const double z = 1.0 - (2.0 * k + 1.0) / count, angle = 2.0 * kPi * 0.6180339887498949 * k,
               r = std::sqrt(1.0 - z * z);
  return Vec3Cast<float>(Vec3d{r * std::cos(angle), r * std::sin(angle), z});
}

}  // namespace

TriangleMesh Split(const TriangleMesh& mesh) {
  TriangleMesh fine;
  fine.positions = mesh.positions;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
  const auto middle = [&](uint32_t a, uint32_t b) {
    const auto [at, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<uint32_t>(fine.positions.size()));
    if (is_new) fine.positions.push_back((mesh.positions[a] + mesh.positions[b]) * 0.5f);
    return at->second;
  };
  for (const Triangle& t : mesh.triangles) {
    const uint32_t a = middle(t[0], t[1]), b = middle(t[1], t[2]), c = middle(t[2], t[0]);
    fine.triangles.insert(fine.triangles.end(), {{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {a, b, c}});
  }
  return fine;
}

TriangleMesh Icosphere(int levels, float radius) {
  TriangleMesh mesh = Icosahedron();
  const auto project = [&mesh](float r) {
    for (Vec3f& p : mesh.positions) p = Vec3Cast<float>(Normalized(Vec3Cast<double>(p)) * static_cast<double>(r));
  };
  for (int level = 0; level < levels; ++level) {
    project(1.0f);
    mesh = Split(mesh);
  }
  project(radius);
  return mesh;
}

TriangleMesh Torus(int nu, int nv, float ring_radius, float tube_radius) {
  TriangleMesh mesh;
  for (int i = 0; i < nu; ++i) {
    for (int j = 0; j < nv; ++j) {
      const double u = 2.0 * kPi * i / nu, v = 2.0 * kPi * j / nv;
      const double ring = static_cast<double>(ring_radius) + static_cast<double>(tube_radius) * std::cos(v);
      mesh.positions.push_back(Vec3Cast<float>(
          Vec3d{ring * std::cos(u), ring * std::sin(u), static_cast<double>(tube_radius) * std::sin(v)}));
      const auto vertex = [&](int a, int b) { return static_cast<uint32_t>((a % nu) * nv + b % nv); };
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
    }
  }
  return mesh;
}

TriangleMesh BumpySphere(int levels, float amplitude, float noise) {
  TriangleMesh mesh = Icosphere(levels);
  std::mt19937 random(1);
  for (Vec3f& p : mesh.positions) {
    const float bump = std::sin(5.0f * p.x + 1.0f) * std::sin(6.0f * p.y + 2.0f) * std::cos(7.0f * p.z);
    p *= 1.0f + amplitude * bump + noise * (2.0f * NextShare(&random) - 1.0f);
  }
  return mesh;
}

TriangleMesh SpikySphere(int levels, int num_spikes, float height) {
  TriangleMesh mesh = Icosphere(levels);
  for (Vec3f& p : mesh.positions) {
    float highest = 0.0f;
    for (int k = 0; k < num_spikes; ++k) {
      const float cosine = Dot(p, SpiralDirection(k, num_spikes));
      highest = std::max(highest, height * std::exp(-120.0f * (1.0f - cosine)));
    }
    p *= 1.0f + highest;
  }
  return mesh;
}

TriangleMesh CreasedBox(int n) {
  return CubeSurface({1, 1, 1}, n, [](const Cell&) { return true; });
}

TriangleMesh TwoHoledPlate(int n) {
  return CubeSurface({5, 3, 1}, n, [](const Cell& c) { return c[1] != 1 || c[0] % 2 == 0; });
}

TriangleMesh ThinPlate(int n, float thickness) {
  TriangleMesh mesh = CreasedBox(n);
  for (Vec3f& p : mesh.positions) p.z *= thickness;
  return mesh;
}

TriangleMesh GridWithBorder(int nx, int ny, float height) {
  TriangleMesh mesh;
  for (int i = 0; i <= nx; ++i) {
    for (int j = 0; j <= ny; ++j) {
      const double x = static_cast<double>(i) / nx, y = static_cast<double>(j) / ny;
      const double z = static_cast<double>(height) * std::sin(kPi * x) * std::sin(kPi * y);
      mesh.positions.push_back(Vec3Cast<float>(Vec3d{x, y, z}));
      if (i == nx || j == ny) continue;
      const auto vertex = [&](int a, int b) { return static_cast<uint32_t>(a * (ny + 1) + b); };
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
    }
  }
  return mesh;
}

TriangleMesh PuncturedSphere(int levels) {
  TriangleMesh mesh = Icosphere(levels);
  const auto touches_first = [](const Triangle& t) { return std::count(t.begin(), t.end(), 0u) > 0; };
  mesh.triangles.erase(std::remove_if(mesh.triangles.begin(), mesh.triangles.end(), touches_first),
                       mesh.triangles.end());
  mesh.positions.erase(mesh.positions.begin());
  for (Triangle& t : mesh.triangles) {
    for (uint32_t& v : t) --v;
  }
  return mesh;
}

TriangleMesh Pinched() {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 1}, {-1, 1, 1}, {-1, -1, 1}, {1, 0, -1}, {-1, 1, -1}, {-1, -1, -1}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}, {0, 4, 5}, {0, 5, 6}, {0, 6, 4}, {4, 6, 5}};
  return mesh;
}

TriangleMesh NonManifoldEdge() {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-0.5f, 0.8f, 0}, {-0.5f, -0.8f, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}};
  return mesh;
}

TriangleMesh Misoriented(int levels) {
  TriangleMesh mesh = Icosphere(levels);
  for (size_t f = 0; f < mesh.triangles.size(); f += 3) std::swap(mesh.triangles[f][1], mesh.triangles[f][2]);
  return mesh;
}

TriangleMesh WithDegenerateFaces(int levels) {
  TriangleMesh mesh = Icosphere(levels);
  const Triangle t = mesh.triangles[0];
  const auto count = static_cast<uint32_t>(mesh.positions.size());
  mesh.positions.push_back((mesh.positions[t[0]] + mesh.positions[t[1]]) * 0.5f);  // no area with the ends of that edge
  mesh.positions.push_back(mesh.positions[t[0]]);                                  // at the same place as another
  mesh.positions.push_back({0, 0, 0});                                             // of no face
  mesh.triangles.insert(
      mesh.triangles.end(),
      {{t[0], t[0], t[1]}, {t[2], t[2], t[2]}, {t[0], count, t[1]}, {t[0], count + 1, t[1]}, t, {t[1], t[2], t[0]}});
  return mesh;
}

TriangleMesh TriangleSoup(int levels) {
  const TriangleMesh mesh = Icosphere(levels);
  TriangleMesh soup;
  for (const Triangle& t : mesh.triangles) {
    const auto first = static_cast<uint32_t>(soup.positions.size());
    for (const uint32_t v : t) soup.positions.push_back(mesh.positions[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

TriangleMesh MoebiusBand(int n) {
  TriangleMesh mesh;
  for (int i = 0; i < n; ++i) {
    const double around = 2 * kPi * i / n;
    for (const double side : {-0.4, 0.4}) {
      const double r = 1 + side * std::cos(around / 2);
      mesh.positions.push_back({static_cast<float>(r * std::cos(around)), static_cast<float>(r * std::sin(around)),
                                static_cast<float>(side * std::sin(around / 2))});
    }
  }
  for (int i = 0; i < n; ++i) {
    const auto a = static_cast<uint32_t>(2 * i), b = a + 1;
    const bool last = i == n - 1;
    const uint32_t c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    mesh.triangles.insert(mesh.triangles.end(), {{a, c, b}, {b, c, d}});
  }
  return mesh;
}

TriangleMesh DoubleSheet(int nx, int ny) {
  TriangleMesh mesh = GridWithBorder(nx, ny, 0.2f);
  const size_t one_side = mesh.triangles.size();
  for (size_t f = 0; f < one_side; ++f) {
    const Triangle t = mesh.triangles[f];
    mesh.triangles.push_back({t[0], t[2], t[1]});
  }
  return mesh;
}

TriangleMesh SpheresOverAPlate(int num_spheres, float radius) {
  TriangleMesh mesh = GridWithBorder(4, 4);
  const TriangleMesh sphere = BumpySphere(2, 0.3f);
  constexpr double kGolden = 0.618034, kOther = 0.3247;  // spread over the plate
  for (int k = 0; k < num_spheres; ++k) {
    const Vec3d center{std::fmod(k * kGolden, 1.0), std::fmod(k * kOther, 1.0), 0.05};
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    for (const Vec3f& p : sphere.positions) mesh.positions.push_back(Vec3Cast<float>(center) + p * radius);
    for (const Triangle& t : sphere.triangles) mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return mesh;
}

TriangleMesh TouchingBoxes(int n) {
  TriangleMesh mesh = CreasedBox(n);
  const auto count = static_cast<uint32_t>(mesh.positions.size());
  const size_t one_box = mesh.triangles.size();
  std::map<std::array<float, 3>, uint32_t> at;
  for (uint32_t v = 0; v < count; ++v) at[{mesh.positions[v].x, mesh.positions[v].y, mesh.positions[v].z}] = v;
  std::vector<uint32_t> moved(count);
  for (uint32_t v = 0; v < count; ++v) {
    const Vec3f p = mesh.positions[v] + Vec3f{1, 1, 0};
    const auto [place, is_new] = at.try_emplace({p.x, p.y, p.z}, static_cast<uint32_t>(mesh.positions.size()));
    if (is_new) mesh.positions.push_back(p);
    moved[v] = place->second;
  }
  for (size_t f = 0; f < one_box; ++f) {
    const Triangle t = mesh.triangles[f];
    mesh.triangles.push_back({moved[t[0]], moved[t[1]], moved[t[2]]});
  }
  return mesh;
}

TriangleMesh Scattered(const TriangleMesh& piece, uint32_t count) {
  std::mt19937 random(count);
  const auto coordinate = [&] { return static_cast<float>(random() % 1000001) / 500000 - 1; };
  const float radius = 0.6f / std::cbrt(static_cast<float>(count));
  TriangleMesh mesh;
  for (uint32_t i = 0; i < count; ++i) {
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    const float x = coordinate(), y = coordinate(), z = coordinate();
    for (const Vec3f& p : piece.positions) mesh.positions.push_back(Vec3f{x, y, z} + p * radius);
    for (const Triangle& t : piece.triangles) mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return mesh;
}

TriangleMesh WithStick(TriangleMesh mesh, float width, float length) {
  const Vec3f foot = *std::max_element(mesh.positions.begin(), mesh.positions.end(), [](const Vec3f& a, const Vec3f& b) { return a.z < b.z; });
  const TriangleMesh cube = CreasedBox(1);
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  for (const Vec3f& p : cube.positions) mesh.positions.push_back(foot + Vec3f{p.x > 0 ? width : 0, p.y > 0 ? width : 0, p.z > 0 ? length : 0});
  for (const Triangle& t : cube.triangles) mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  return mesh;
}

std::vector<NamedShape> AllShapes() {
  const auto closed = [](std::string name, TriangleMesh mesh, int genus) {
    return NamedShape{std::move(name), std::move(mesh), true, true, 0, genus};
  };
  const auto bordered = [](std::string name, TriangleMesh mesh, int num_borders) {
    return NamedShape{std::move(name), std::move(mesh), true, true, num_borders, 0};
  };
  const auto broken = [](std::string name, TriangleMesh mesh, bool manifold, bool oriented) {
    return NamedShape{std::move(name), std::move(mesh), manifold, oriented, 0, 0};
  };
  std::vector<NamedShape> shapes;
  shapes.push_back(closed("icosphere", Icosphere(3), 0));
  shapes.push_back(closed("torus", Torus(48, 24), 1));
  shapes.push_back(closed("bumpy_sphere", BumpySphere(4, 0.1f, 0.001f), 0));
  shapes.push_back(closed("spiky_sphere", SpikySphere(4), 0));
  shapes.push_back(closed("creased_box", CreasedBox(8), 0));
  shapes.push_back(closed("two_holed_plate", TwoHoledPlate(4), 2));
  shapes.push_back(closed("thin_plate", ThinPlate(8), 0));
  shapes.push_back(bordered("grid_with_border", GridWithBorder(16, 12, 0.2f), 1));
  shapes.push_back(bordered("punctured_sphere", PuncturedSphere(3), 1));
  shapes.push_back(broken("pinched", Pinched(), false, true));
  shapes.push_back(broken("non_manifold_edge", NonManifoldEdge(), false, false));
  shapes.push_back(broken("misoriented", Misoriented(3), true, false));
  shapes.push_back(broken("with_degenerate_faces", WithDegenerateFaces(3), false, false));
  shapes.push_back(bordered("triangle_soup", TriangleSoup(2), 320));
  return shapes;
}

TriangleMesh SheetsAroundACurve(uint32_t num_sheets, uint32_t rows, uint32_t columns) {
  TriangleMesh mesh;
  for (uint32_t i = 0; i <= rows; ++i) mesh.positions.push_back({0, 0, static_cast<float>(i)});
  for (uint32_t s = 0; s < num_sheets; ++s) {
    const double angle = 2 * kPi * s / num_sheets;
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    for (uint32_t j = 1; j <= columns; ++j) {
      const auto x = static_cast<float>(j * std::cos(angle)), y = static_cast<float>(j * std::sin(angle));
      for (uint32_t i = 0; i <= rows; ++i) mesh.positions.push_back({x, y, static_cast<float>(i)});
    }
    const auto at = [&](uint32_t i, uint32_t j) { return j == 0 ? i : first + (j - 1) * (rows + 1) + i; };
    for (uint32_t i = 0; i < rows; ++i) {
      for (uint32_t j = 0; j < columns; ++j) {
        mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
        mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
      }
    }
  }
  for (Vec3f& p : mesh.positions) p += Vec3f{2 * std::sin(0.2f * p.z), 2 * std::cos(0.15f * p.z), 0};
  return mesh;
}

}  // namespace lacerta::shapes
