// Equal values of an attribute as one, before Draco codes them.
#ifndef LACERTA_DRACO_MERGE_VALUES_H_
#define LACERTA_DRACO_MERGE_VALUES_H_

#include <draco/mesh/mesh.h>

namespace lacerta {

// What draco::Mesh::DeduplicateAttributeValues does, to the letter, on attributes that map point i to value i, as they are when they have just been
// filled; O(#points). Draco's own hashes a value to the exclusive or of its numbers: points of a lattice of n^3 have about 2 n hashes, so that it takes
// time with the square of their number.
void MergeEqualValues(draco::Mesh* mesh);

}  // namespace lacerta

#endif  // LACERTA_DRACO_MERGE_VALUES_H_
