#include "remesh/mend_tears.h"

#include <algorithm>
#include <deque>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "common/subdivision.h"
#include "geometry/triangle_tree.h"
#include "geometry/vertex_area_vectors.h"
#include "remesh/edge_corners.h"
#include "remesh/manifold.h"

namespace lacerta {
namespace {

constexpr size_t kMostFacesAtVertex = 64;  // of one on a tear: keeps the time linear

using Loop = std::deque<uint32_t>;  // vertices of a closed border, against the direction of its faces

class Mender {
 public:
  Mender(const TriangleMesh& cleaned, double distance, const MendOptions& options)
      : whole_(MakeManifold(cleaned)), distance_(static_cast<float>(distance)), options_(options) {
    if (whole_.report.cut_edges == 0) return;
    num_copies_.assign(cleaned.positions.size(), 0);
    for (const uint32_t source : whole_.source_vertex) ++num_copies_[source];
    tree_.emplace(cleaned);
    for (const Triangle& t : cleaned.triangles) budget_ += Area(t);
    budget_ *= options.share * distance * distance;
  }

  std::optional<MendedMesh> Mend() {
    if (whole_.report.cut_edges == 0) return std::nullopt;
    std::vector<uint8_t> is_open(whole_.mesh.positions.size(), 0);  // vertices
    const std::vector<Loop> tears = Tears(&is_open);
    FindFaces(tears);
    uint64_t num_closed = 0;
    for (const Loop& tear : tears) {
      const Loop open = Close(tear);
      num_closed += open.size() < tear.size();
      for (const uint32_t v : tear) is_open[v] = 0;
      for (const uint32_t v : open) is_open[v] = 1;
    }
    const std::vector<uint8_t> is_stray = Strays();
    const auto num_strays = static_cast<uint64_t>(std::count(is_stray.begin(), is_stray.end(), 1));
    if (num_closed == 0 && num_strays == 0) return std::nullopt;
    return MendedMesh{Mended(is_open, is_stray), num_closed, num_strays};
  }

 private:
  const Vec3f& At(uint32_t v) const { return whole_.mesh.positions[v]; }

  // Borders of large components with a vertex that cutting made copies of. is_open: marked for the vertices of all borders.
  std::vector<Loop> Tears(std::vector<uint8_t>* is_open) const {
    const std::vector<Triangle>& triangles = whole_.mesh.triangles;
    const EdgeCorners edges = GroupByEdge(whole_.mesh.positions.size(), triangles);
    std::vector<uint32_t> next(whole_.mesh.positions.size(), kNone);
    for (uint32_t e = 0; e < edges.num_edges(); ++e) {
      const Span<const uint32_t> corners = edges.of(e);
      if (corners.size() != 1) continue;
      const uint32_t start = StartOfEdge(triangles, corners[0]), end = EndOfEdge(triangles, corners[0]);
      (*is_open)[start] = (*is_open)[end] = 1;
      if (whole_.components[whole_.component[corners[0] / 3]].faces >= options_.fewest_faces) next[end] = start;
    }
    std::vector<Loop> tears;
    for (uint32_t first = 0; first < next.size(); ++first) {
      Loop loop;
      bool is_torn = false;
      for (uint32_t v = first; next[v] != kNone; v = std::exchange(next[v], kNone)) {
        loop.push_back(v);
        is_torn = is_torn || num_copies_[whole_.source_vertex[v]] > 1;
      }
      if (is_torn) tears.push_back(std::move(loop));
    }
    return tears;
  }

  // What is open still hangs together by its vertices. All else has no need to, and would be cut again: it has vertices of its own.
  TriangleMesh Mended(const std::vector<uint8_t>& is_open, const std::vector<uint8_t>& is_stray) const {
    TriangleMesh mended;
    std::vector<uint32_t> of_source(num_copies_.size(), kNone), of_vertex(is_open.size(), kNone), source;
    for (size_t f = 0; f < whole_.mesh.triangles.size(); ++f) {
      if (f < whole_.component.size() && is_stray[whole_.component[f]]) continue;
      mended.triangles.push_back(whole_.mesh.triangles[f]);
      for (uint32_t& v : mended.triangles.back()) {
        uint32_t& number = is_open[v] ? of_source[whole_.source_vertex[v]] : of_vertex[v];
        if (number == kNone) {
          number = static_cast<uint32_t>(mended.positions.size());
          mended.positions.push_back(At(v));
          source.push_back(is_open[v] ? kNone : whole_.source_vertex[v]);
        }
        v = number;
      }
    }
    PartCopies(source, &mended);
    return mended;
  }

  // Triangles between vertices at one point have no area and no normal, and are in the way of everything: vertices of one source (#V; kNone: stays
  // where it is) move a little towards the middle of their neighbors, each of its own.
  void PartCopies(const std::vector<uint32_t>& source, TriangleMesh* mesh) const {
    constexpr float kWay = 0.01f, kMostOfDistance = 0.1f;
    const auto is_copy = [&](uint32_t v) { return source[v] != kNone && num_copies_[source[v]] > 1; };
    std::vector<Vec3f> sum(source.size(), Vec3f{});
    std::vector<float> count(source.size(), 0);
    for (const Triangle& t : mesh->triangles) {
      for (size_t k = 0; k < 3; ++k) {
        if (!is_copy(t[k])) continue;
        sum[t[k]] += mesh->positions[t[(k + 1) % 3]] - mesh->positions[t[k]];
        ++count[t[k]];
      }
    }
    const float most = kMostOfDistance * distance_;
    for (uint32_t v = 0; v < source.size(); ++v) {
      if (count[v] > 0) mesh->positions[v] += sum[v] * std::min(kWay / count[v], most / Norm(sum[v]));
    }
  }

  void FindFaces(const std::vector<Loop>& tears) {
    faces_.resize(whole_.mesh.positions.size());
    std::vector<uint8_t> on_tear(faces_.size(), 0);
    for (const Loop& tear : tears) {
      for (const uint32_t v : tear) on_tear[v] = 1;
    }
    for (uint32_t f = 0; f < whole_.mesh.triangles.size(); ++f) {
      for (const uint32_t v : whole_.mesh.triangles[f]) {
        if (on_tear[v]) faces_[v].push_back(f);
      }
    }
  }

  std::set<uint32_t> Neighbors(uint32_t v) const {
    std::set<uint32_t> neighbors;
    for (const uint32_t f : faces_[v]) neighbors.insert(whole_.mesh.triangles[f].begin(), whole_.mesh.triangles[f].end());
    neighbors.erase(v);
    return neighbors;
  }

  // Zips the tear, then fills what is left of it. Returns what stays open.
  Loop Close(const Loop& tear) {
    const bool is_crowded = std::any_of(tear.begin(), tear.end(), [&](uint32_t v) { return faces_[v].size() > kMostFacesAtVertex; });
    if (is_crowded) return tear;
    Loop rest = tear;
    for (size_t unmoved = 0; rest.size() > 3 && unmoved < rest.size();) {
      if (CanZip(rest)) {
        Rename(rest[2], rest[0]);
        rest.erase(rest.begin() + 1, rest.begin() + 3);
        rest.push_front(rest.back());  // what was before it may lie on what comes now
        rest.pop_back();
        unmoved = 0;
      } else {
        rest.push_back(rest.front());
        rest.pop_front();
        ++unmoved;
      }
    }
    return rest.size() == 2 || Fill(rest) ? Loop() : rest;
  }

  // Whether the first two edges of the border lie on each other, and may be one.
  bool CanZip(const Loop& loop) const {
    const uint32_t a = loop[0], middle = loop[1], b = loop[2];
    if (a == b || !(At(a) == At(b)) || faces_[a].size() + faces_[b].size() > kMostFacesAtVertex) return false;
    const std::set<uint32_t> around_a = Neighbors(a), around_b = Neighbors(b);
    if (around_a.count(b) != 0) return false;
    // A second edge between the same two vertices would come of any other neighbor that both have.
    const uint32_t other = loop.size() == 4 ? loop[3] : middle;
    return std::all_of(around_a.begin(), around_a.end(), [&](uint32_t v) { return around_b.count(v) == 0 || v == middle || v == other; });
  }

  void Rename(uint32_t gone, uint32_t kept) {
    for (const uint32_t f : faces_[gone]) {
      for (uint32_t& v : whole_.mesh.triangles[f]) v = v == gone ? kept : v;
      faces_[kept].push_back(f);
    }
    faces_[gone].clear();
  }

  // Cuts off the ears with the shortest new edges.
  bool Fill(const Loop& hole) {
    if (hole.size() > options_.most_border_edges) return false;
    std::vector<Triangle> filling;
    std::set<std::pair<uint32_t, uint32_t>> added;
    Loop rest = hole;
    while (rest.size() > 3) {
      const size_t n = rest.size();
      size_t best = n;
      float shortest = std::numeric_limits<float>::infinity();
      for (size_t i = 0; i < n; ++i) {
        const uint32_t before = rest[(i + n - 1) % n], after = rest[(i + 1) % n];
        const Vec3f across = At(after) - At(before);
        if (before == after || !(Dot(across, across) < shortest)) continue;
        if (added.count(std::minmax(before, after)) != 0 || Neighbors(before).count(after) != 0) continue;
        shortest = Dot(across, across);
        best = i;
      }
      if (best == n) return false;
      const uint32_t before = rest[(best + n - 1) % n], after = rest[(best + 1) % n];
      filling.push_back({before, rest[best], after});
      added.insert(std::minmax(before, after));
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(best));
    }
    filling.push_back({rest[0], rest[1], rest[2]});
    double added_error = 0;
    for (const Triangle& t : filling) added_error += ErrorTo(*tree_, t);
    if (!(added_error <= budget_)) return false;
    budget_ -= added_error;
    for (const Triangle& t : filling) {
      for (const uint32_t v : t) faces_[v].push_back(static_cast<uint32_t>(whole_.mesh.triangles.size()));
      whole_.mesh.triangles.push_back(t);
    }
    return true;
  }

  // #C: 1 for those that are left out.
  std::vector<uint8_t> Strays() {
    std::vector<uint8_t> is_stray(whole_.components.size(), 0), is_torn_off(whole_.components.size(), 0);
    const auto is_large = [&](uint32_t f) { return f >= whole_.component.size() || whole_.components[whole_.component[f]].faces >= options_.fewest_faces; };
    TriangleMesh large{whole_.mesh.positions, {}};
    for (uint32_t f = 0; f < whole_.mesh.triangles.size(); ++f) {
      const Triangle& t = whole_.mesh.triangles[f];
      if (is_large(f)) {
        large.triangles.push_back(t);
      } else if (whole_.components[whole_.component[f]].faces <= options_.most_stray_faces) {
        for (const uint32_t v : t) is_torn_off[whole_.component[f]] |= num_copies_[whole_.source_vertex[v]] > 1;
      }
    }
    const TriangleTree tree(large);
    std::vector<double> error(whole_.components.size(), 0.0);
    for (uint32_t f = 0; f < whole_.component.size(); ++f) {
      if (is_torn_off[whole_.component[f]]) error[whole_.component[f]] += ErrorTo(tree, whole_.mesh.triangles[f]);
    }
    std::vector<uint32_t> order;
    for (uint32_t c = 0; c < error.size(); ++c) {
      if (is_torn_off[c]) order.push_back(c);
    }
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return error[a] < error[b]; });
    for (const uint32_t c : order) {
      if (!(error[c] <= budget_)) break;
      budget_ -= error[c];
      is_stray[c] = 1;
    }
    return is_stray;
  }

  double Area(const Triangle& t) const { return Norm(AreaVector(whole_.mesh.positions, t)) / 2; }

  // Integral of the squared distance from a triangle to a mesh, by its middle and those of its edges; infinite beyond what is allowed anywhere.
  double ErrorTo(const TriangleTree& tree, const Triangle& t) const {
    const Vec3f &a = At(t[0]), &b = At(t[1]), &c = At(t[2]);
    const float most = 4 * distance_ * distance_;
    double sum = 0;
    for (const Vec3f& p : {(a + b + c) * (1.0f / 3), (a + b) * 0.5f, (b + c) * 0.5f, (c + a) * 0.5f}) {
      const ClosestPointResult nearest = tree.ClosestPoint(p, most);
      if (nearest.point.face == SurfacePoint::kNone) return std::numeric_limits<double>::infinity();
      sum += static_cast<double>(nearest.squared_distance);
    }
    return sum / 4 * Area(t);
  }

  ManifoldMesh whole_;
  const float distance_;
  const MendOptions options_;
  double budget_ = 0;                         // of what is added to the integral of the squared distance
  std::vector<uint32_t> num_copies_;          // of the vertices of the input
  std::optional<TriangleTree> tree_;          // of the input
  std::vector<std::vector<uint32_t>> faces_;  // of the vertices on tears
};

}  // namespace

std::optional<MendedMesh> MendTears(const TriangleMesh& cleaned, double distance, const MendOptions& options) {
  return Mender(cleaned, distance, options).Mend();
}

}  // namespace lacerta
