// The edges that a simplification may collapse, the cheapest first. What was not possible may be after changes nearby.
#ifndef LACERTA_REMESH_COLLAPSE_QUEUE_H_
#define LACERTA_REMESH_COLLAPSE_QUEUE_H_

#include <cstdint>
#include <optional>
#include <queue>
#include <vector>

namespace lacerta {

// Candidate: an edge with what its collapse costs, the cheapest the largest by operator<.
template <typename Candidate>
class CollapseQueue {
 public:
  explicit CollapseQueue(uint32_t num_triangles) : alive_at_retry_(num_triangles) {}

  void Push(const Candidate& candidate) { heap_.push(candidate); }
  // Puts it by: it is pushed again when a tenth of the triangles has gone since that was last done, and when nothing
  // else is left and any has gone.
  void Block(const Candidate& candidate) { blocked_.push_back(candidate); }

  // Takes the cheapest out of those that are not void; none when all is done. num_alive: triangles that are left.
  template <typename IsVoid>
  std::optional<Candidate> Next(uint32_t num_alive, const IsVoid& is_void) {
    constexpr double kRetryShare = 0.9;
    if (num_alive < kRetryShare * alive_at_retry_) Retry(num_alive, is_void);
    for (;;) {
      if (heap_.empty() && alive_at_retry_ != num_alive) Retry(num_alive, is_void);
      if (heap_.empty()) return std::nullopt;
      const Candidate candidate = heap_.top();
      heap_.pop();
      if (!is_void(candidate)) return candidate;
    }
  }

 private:
  template <typename IsVoid>
  void Retry(uint32_t num_alive, const IsVoid& is_void) {
    alive_at_retry_ = num_alive;
    for (const Candidate& candidate : blocked_) {
      if (!is_void(candidate)) heap_.push(candidate);
    }
    blocked_.clear();
  }

  std::priority_queue<Candidate> heap_;
  std::vector<Candidate> blocked_;
  uint32_t alive_at_retry_;
};

}  // namespace lacerta

#endif  // LACERTA_REMESH_COLLAPSE_QUEUE_H_
