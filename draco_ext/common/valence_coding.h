// Coding of the connectivity of a base mesh by the valences of its vertices [Touma, Gotsman 1998]: one piece of code for encoder
// and decoder, so that they cannot drift apart. Specified in docs/format.md, "Connectivity of the compact base".
//
// A region grows over the mesh, whose borders are closed by dummy vertices, triangle by triangle at its front. Where to grow
// follows from the valences known so far: at the vertex with the fewest edges left, which makes the front rarely touch itself
// [Alliez, Desbrun 2001]. Departures: all loops of the front are open at a time and the choice is among all of their vertices,
// so that meeting the own loop (split) and another one (merge) are the same operation.
#ifndef LACERTA_COMMON_VALENCE_CODING_H_
#define LACERTA_COMMON_VALENCE_CODING_H_

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "common/growing_front.h"
#include "common/symbol_coding.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// What lies beyond an edge of the front.
struct GrowthStep {
  bool joins = false;
  // A new vertex.
  bool dummy = false;
  uint32_t valence = 3;
  // One of the front: its entry, and how many of its free edges come between the edge to the focus and the entry after it.
  uint32_t target = 0;
  uint32_t free_after = 0;
};

// A mesh while it grows. Dummies have numbers from num_vertices on.
struct GrownMesh {
  std::vector<Triangle> triangles;  // without dummies
  uint32_t num_vertices = 0;        // there are so far, without dummies
  uint32_t num_dummies = 0;
  uint64_t num_dummy_triangles = 0;
};

struct GrowthLimits {
  uint32_t num_vertices = 0;   // to be made
  uint32_t num_dummies = 0;
  uint64_t max_triangles = 0;  // without dummies
};

class ValenceModels {
 public:
  ValenceModels() {
    for (size_t context = 0; context < kContexts; ++context) {
      large_[context] = BitModel(kLarge[context], kSeen);
      for (size_t i = 0; i < kUnary; ++i) larger_[context][i] = BitModel(kLarger[context][std::min<size_t>(i, 2)], kSeen);
      for (size_t i = 0; i < 2; ++i) smaller_[context][i] = BitModel(kSmaller[context][i], kSeen);
    }
  }

  // context: of the gate.
  template <typename Coder>
  uint32_t CodeValence(uint32_t context, uint32_t valence, Coder* coder) {
    constexpr uint32_t kMiddle = 6;
    if (coder->Code(large_[context], valence >= kMiddle)) {
      uint32_t result = kMiddle;
      while (result < kMiddle + kUnary && coder->Code(larger_[context][result - kMiddle], valence > result)) ++result;
      return result < kMiddle + kUnary ? result : result + CodeByLength(huge_, valence - result, coder);
    }
    uint32_t result = kMiddle - 1;
    while (result > 3 && coder->Code(smaller_[context][result - 4], valence < result)) --result;
    return result;
  }
  template <typename Coder>
  uint32_t CodeDummyValence(uint32_t valence, Coder* coder) {
    return 3 + CodeByLength(dummy_valence_, valence - 3, coder);
  }

  static constexpr uint32_t kContexts = 6;
  BitModel dummy{600, kSeen};
  std::array<BitModel, 2> joins{BitModel(130, kSeen), BitModel(470, kSeen)};  // with one free edge at the focus, with more
  BitModel joins_far;
  IntegerModels join_distance;

 private:
  static constexpr uint32_t kUnary = 10;
  static constexpr uint32_t kSeen = 16;
  // To begin with, as bases of many meshes have them.
  static constexpr uint32_t kLarge[kContexts] = {57000, 51000, 39000, 31000, 20000, 43000};
  static constexpr uint32_t kLarger[kContexts][3] = {{37000, 18000, 10000}, {24500, 13000, 8000},  {22000, 12000, 8000},
                                                     {22600, 17000, 17000}, {16000, 8000, 8000}, {27000, 17000, 15000}};
  static constexpr uint32_t kSmaller[kContexts][2] = {{12000, 9000}, {3200, 6300}, {2300, 11700}, {4700, 19600}, {2700, 20800}, {12000, 13000}};
  std::array<BitModel, kContexts> large_;
  std::array<std::array<BitModel, kUnary>, kContexts> larger_;
  std::array<std::array<BitModel, 2>, kContexts> smaller_;
  IntegerModels huge_, dummy_valence_;
};

// Places of the loop around `focus` that a new triangle may join, the nearest first: at most kJoinReach on either side.
inline constexpr uint32_t kJoinReach = 16;
std::vector<uint32_t> NearJoins(const GrowingFront& front, uint32_t focus);

// Guide: what knows the mesh. On the encoding side it answers, on the decoding side it is asked for nothing that matters.
//   std::array<uint32_t, 3> Start()                  valences of the first triangle of the next component
//   GrowthStep Ask(front, focus)                     the vertex beyond focus -> next
//   void Started(entries), Added(focus, entry), Joined(focus, target, other), Closed(before, removed)
//                                                    the front after each step
template <typename Coder, typename Guide>
class MeshGrower {
 public:
  MeshGrower(const GrowthLimits& limits, Guide* guide, Coder* coder) : limits_(limits), guide_(*guide), coder_(*coder) {}

  // Grows all components. Fails with kInvalidData where the valences do not fit together, and with kLimitExceeded.
  StatusOr<GrownMesh> Grow() {
    while (mesh_.num_vertices < limits_.num_vertices) {
      LACERTA_RETURN_IF_ERROR(StartComponent());
      while (!front_.empty()) {
        const uint32_t focus = front_.TakeFocus();
        LACERTA_RETURN_IF_ERROR(front_[focus].free == 0 ? Close(focus) : Extend(focus));
      }
    }
    if (mesh_.num_dummies != limits_.num_dummies) return InvalidData("connectivity of the base has fewer borders than announced");
    return std::move(mesh_);
  }

 private:
  static Status DoNotFit() { return InvalidData("valences of the base do not fit together"); }
  bool IsDummy(uint32_t vertex) const { return vertex >= limits_.num_vertices; }

  StatusOr<uint32_t> NewVertex(uint32_t valence, bool dummy) {
    if (!dummy && mesh_.num_vertices == limits_.num_vertices) return InvalidData("connectivity of the base has more vertices than announced");
    const uint32_t vertex = dummy ? limits_.num_vertices + mesh_.num_dummies++ : mesh_.num_vertices++;
    valence_.resize(std::max<size_t>(valence_.size(), dummy ? 0 : vertex + 1));
    if (!dummy) valence_[vertex] = valence;
    return vertex;
  }

  Status AddTriangle(const Triangle& t) {
    const int dummies = IsDummy(t[0]) + IsDummy(t[1]) + IsDummy(t[2]);
    if (dummies > 1 || t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return DoNotFit();
    if (dummies == 0) mesh_.triangles.push_back(t);
    mesh_.num_dummy_triangles += dummies != 0;
    if (mesh_.triangles.size() > limits_.max_triangles || mesh_.num_dummy_triangles / 3 > limits_.max_triangles) {
      return LimitExceeded("base has more than " + std::to_string(limits_.max_triangles) + " triangles");
    }
    return Status();
  }

  Status StartComponent() {
    const std::array<uint32_t, 3> asked = guide_.Start();
    Triangle t{};
    std::array<uint32_t, 3> free{};
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t valence = models_.CodeValence(kStartContext, asked[k], &coder_);
      LACERTA_ASSIGN_OR_RETURN(t[k], NewVertex(valence, false));
      free[k] = valence - 2;
    }
    LACERTA_RETURN_IF_ERROR(AddTriangle(t));
    guide_.Started(front_.AddTriangle(t, free));
    return Status();
  }

  // No edge is left at the focus: the vertices beside it are neighbors.
  Status Close(uint32_t focus) {
    const uint32_t before = front_[focus].prev, after = front_[focus].next;
    LACERTA_RETURN_IF_ERROR(AddTriangle({front_[after].vertex, front_[focus].vertex, front_[before].vertex}));
    if (front_[after].next == before) {
      if (front_[before].free != 0 || front_[after].free != 0) return DoNotFit();
      guide_.Closed(before, focus);
      for (const uint32_t entry : {focus, before, after}) front_.Remove(entry);
      return Status();
    }
    if (front_[before].free == 0 || front_[after].free == 0) return DoNotFit();
    front_.SetFree(before, front_[before].free - 1);
    front_.SetFree(after, front_[after].free - 1);
    front_.Remove(focus);
    guide_.Closed(before, focus);
    return Status();
  }

  Status Extend(uint32_t focus) {
    const uint32_t after = front_[focus].next;
    GrowthStep step = guide_.Ask(front_, focus);
    if (front_.live().size() >= 5) {
      step.joins = coder_.Code(models_.joins[front_[focus].free > 1], step.joins);
    } else {
      step.joins = false;
    }
    const uint32_t u = front_[focus].vertex, v = front_[after].vertex;
    if (front_[after].free == 0) return DoNotFit();
    if (step.joins) return Join(focus, &step);
    const uint32_t context = Context(focus);
    front_.SetFree(after, front_[after].free - 1);
    front_.SetFree(focus, front_[focus].free - 1);
    if (mesh_.num_dummies < limits_.num_dummies) step.dummy = coder_.Code(models_.dummy, step.dummy);
    step.valence = step.dummy ? models_.CodeDummyValence(step.valence, &coder_) : models_.CodeValence(context, step.valence, &coder_);
    LACERTA_ASSIGN_OR_RETURN(const uint32_t w, NewVertex(step.valence, step.dummy));
    LACERTA_RETURN_IF_ERROR(AddTriangle({v, u, w}));
    guide_.Added(focus, front_.InsertAfter(focus, w, step.valence - 2));
    return Status();
  }

  Status Join(uint32_t focus, GrowthStep* step) {
    const uint32_t after = front_[focus].next;
    const std::vector<uint32_t> near = NearJoins(front_, focus);
    const auto found = static_cast<uint32_t>(std::find(near.begin(), near.end(), step->target) - near.begin());
    const bool far = near.empty() || coder_.Code(models_.joins_far, found == near.size());
    if (far) {
      const auto count = static_cast<uint32_t>(front_.live().size());
      step->target = front_.live()[CodeUniform(count, front_[step->target].place, &coder_)];
    } else {
      const uint32_t distance = CodeByLength(models_.join_distance, found, &coder_);
      if (distance >= near.size()) return DoNotFit();
      step->target = near[distance];
    }
    const uint32_t target = step->target;
    const bool too_near = target == focus || target == after || target == front_[focus].prev || target == front_[after].next;
    if (too_near || front_[target].free < 2) return DoNotFit();
    const uint32_t rest = front_[target].free - 2;
    step->free_after = CodeUniform(rest + 1, step->free_after, &coder_);
    LACERTA_RETURN_IF_ERROR(AddTriangle({front_[after].vertex, front_[focus].vertex, front_[target].vertex}));
    front_.SetFree(after, front_[after].free - 1);
    front_.SetFree(focus, front_[focus].free - 1);
    guide_.Joined(focus, target, front_.Join(focus, target, step->free_after, rest - step->free_after));
    return Status();
  }

  // Of the valence of the vertex beyond the edge after the focus.
  uint32_t Context(uint32_t focus) const {
    const uint32_t u = front_[focus].vertex, v = front_[front_[focus].next].vertex;
    if (IsDummy(u) || IsDummy(v)) return 4;
    const uint32_t sum = valence_[u] + valence_[v];
    return sum < 11 ? 0 : sum < 13 ? 1 : sum < 15 ? 2 : 3;
  }
  static constexpr uint32_t kStartContext = 5;

  const GrowthLimits limits_;
  Guide& guide_;
  Coder& coder_;
  ValenceModels models_;
  GrowingFront front_;
  GrownMesh mesh_;
  std::vector<uint32_t> valence_;  // of the vertices made
};

}  // namespace lacerta

#endif  // LACERTA_COMMON_VALENCE_CODING_H_
