// Work on several candidates of a surface.
#ifndef LACERTA_DRACO_FOR_EACH_CANDIDATE_H_
#define LACERTA_DRACO_FOR_EACH_CANDIDATE_H_

#include <cstddef>

#include "geometry/for_each_branch.h"

namespace lacerta {

// Vertices of the input from which on the memory of several candidates, each as large as the input, counts for more than time.
inline constexpr double kOneCandidateAtATime = 250'000;

// Calls work(0) .. work(count - 1): in parallel, or in order where the input is that large. What can run in parallel within a
// candidate does so anyway.
template <typename Work>
void ForEachCandidate(double num_input_vertices, size_t count, const Work& work) {
  if (num_input_vertices < kOneCandidateAtATime) {
    ForEachBranch(count, work);
  } else {
    for (size_t i = 0; i < count; ++i) work(i);
  }
}

}  // namespace lacerta

#endif  // LACERTA_DRACO_FOR_EACH_CANDIDATE_H_
