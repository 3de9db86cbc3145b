// How much the search for a stream tries.
#ifndef LACERTA_DRACO_SEARCH_EFFORT_H_
#define LACERTA_DRACO_SEARCH_EFFORT_H_

#include <cstddef>

#include "lacerta/codec.h"

namespace lacerta {

struct SearchEffort {
  // Shares of the bytes: neighbors that are worse by that end the walk over base sizes; candidates that are worse by that than the best are not
  // taken to the target beside it.
  double much_worse = 0.04, hopeless = 0.015;
  bool every_size = false;     // sizes halfway between those of the walk are tried, too, beside the best
  size_t enough_bases = 100;   // after so many the best is taken, worse neighbors on either side or not; 1: the usual size, where it can do
  size_t at_a_time = 2;        // of those, taken to the target together: the best of them is kept
  // Passes of the descent: scores compare candidates, which a few tell; the stream that is kept is worth more.
  int score_passes = 2, meet_passes = 8;
  int suit_passes = 3;  // where steps are suited to the surface; 0: they are not
  int draws = 3;        // codings at the target: slopes that hardly differ give streams that differ by a percent, of which the best goes on
  double zero_level_tries = 1.0;  // share of the usual ones, at the end of the search for a stream without levels
};

// docs/results/effort_table.md has what they cost and gain.
inline SearchEffort EffortOf(Effort effort) {
  SearchEffort result;
  if (effort == Effort::kFast) {
    result.enough_bases = result.at_a_time = 1;
    result.score_passes = 1;
    result.meet_passes = 3;
    result.suit_passes = 0;
    result.draws = 1;
    result.zero_level_tries = 0.25;
  }
  if (effort == Effort::kBest) result.every_size = true;  // what kNormal finds is among what this finds
  return result;
}

}  // namespace lacerta

#endif  // LACERTA_DRACO_SEARCH_EFFORT_H_
