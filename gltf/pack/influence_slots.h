// In which of its places a vertex names a joint: nothing to a viewer, but neighbors that agree compress better.
#ifndef LACERTA_PACK_INFLUENCE_SLOTS_H_
#define LACERTA_PACK_INFLUENCE_SLOTS_H_

#include <vector>

#include "document/primitive.h"

namespace lacerta {

// Gives every joint of one skin one of the four places in JOINTS_0 and WEIGHTS_0, the same in all primitives (vertices
// on their borders stay alike), so that joints that move the same vertices have other ones where that can be, and puts
// it there wherever that is free. Joints with a weight of 0 become joint 0. Primitives stay as they are where that
// takes no fewer bytes, where one has several sets, or sets of unknown types; those without joints do not matter.
void ArrangeInfluences(std::vector<Primitive*> primitives);

}  // namespace lacerta

#endif  // LACERTA_PACK_INFLUENCE_SLOTS_H_
