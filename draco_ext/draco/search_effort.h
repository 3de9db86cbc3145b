// How much the search for a stream tries.
#ifndef LACERTA_DRACO_SEARCH_EFFORT_H_
#define LACERTA_DRACO_SEARCH_EFFORT_H_

#include <cstddef>
#include <vector>

#include "lacerta/codec.h"

namespace lacerta {

struct SearchEffort {
  double size_ratio = 1.5;   // between neighbors of the base sizes tried
  double much_worse = 0.06;  // share of the bytes: neighbors that are worse by that end the walk over base sizes
  size_t enough_sizes = 100;  // after so many the best is taken, worse neighbors on either side or not; 1: the usual size, where it can do
  size_t at_a_time = 2;      // of those, taken to the target together: the best of them is kept
  // Passes of the descent: scores compare candidates, which a few tell; the stream that is kept is worth more.
  int score_passes = 2, meet_passes = 8;
  int suit_passes = 3;  // where steps are suited to the surface; 0: they are not
  int draws = 3;        // codings at the target: slopes that hardly differ give streams that differ by a percent, of which the best goes on
  std::vector<double> shape_sizes = {0.6, 1.0, 1.6};  // as in BestShapedHistory
  double zero_level_tries = 1.0;  // share of the usual ones, at the end of the search for a stream without levels
  bool every_shape = false;       // all of ShapedHistories are searched, not the one that looks best
};

// docs/results/effort_table.md has what they cost and gain.
inline SearchEffort EffortOf(Effort effort) {
  switch (effort) {
    case Effort::kFast: return {1.5, 0.03, 1, 1, 1, 3, 0, 1, {}, 0.25};
    case Effort::kNormal: return {};
    case Effort::kBest: {  // what kNormal finds is among what this finds
      SearchEffort widest;
      widest.every_shape = true;
      return widest;
    }
  }
  return {};
}

}  // namespace lacerta

#endif  // LACERTA_DRACO_SEARCH_EFFORT_H_
