// How the error of one coefficient spreads over the finest mesh: the weights w_i of [Payan & Antonini 2004], (10)-(11).
//
// Synthesis is linear in the coefficients as long as the local frames stand still, and the frames are orthonormal, so
// that the energy of a coefficient depends on its level alone, not on its direction: E = sum over the finest vertices
// of the squared displacement that a unit coefficient causes. Valid for the open loop, where every level predicts from
// the decoded coarser one and details are those of the exact one.
#ifndef LACERTA_ENCODER_ALLOCATION_SUBBAND_WEIGHTS_H_
#define LACERTA_ENCODER_ALLOCATION_SUBBAND_WEIGHTS_H_

#include <vector>

#include "common/subdivision.h"

namespace lacerta {

// E of a coefficient after `num_subdivisions` >= 0 further subdivisions of a mesh whose vertices all have valence 6:
// 1, 2.640625, 10.077637, ..., toward 0.627394 * 4^k.
double RegularEnergy(int num_subdivisions);

// E by level, num_levels + 1 entries: [0] of a base position, [i] of a detail of level i.
std::vector<double> RegularEnergies(int num_levels);

// The same measured on the synthesis operator of a real mesh: random signs on all coefficients of one level, squared
// sum over the finest vertices, mean of 3 * num_probes draws (fixed seed: the same result on every machine up to float
// rounding). Relative standard deviation about sqrt(2 / (3 num_probes * number of coefficients)) or less. num_levels >=
// 0, num_probes >= 1; 4^num_levels #F must fit in 32 bits.
std::vector<double> ProbeEnergies(const Topology& base, int num_levels, int num_probes);

}  // namespace lacerta

#endif  // LACERTA_ENCODER_ALLOCATION_SUBBAND_WEIGHTS_H_
