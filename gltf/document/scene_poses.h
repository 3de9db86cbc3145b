// Poses that the nodes of a document take: to see what its skins do to the surfaces they move.
#ifndef LACERTA_DOCUMENT_SCENE_POSES_H_
#define LACERTA_DOCUMENT_SCENE_POSES_H_

#include <vector>

#include "document/gltf_document.h"
#include "document/scene.h"

namespace lacerta {

// The transform of every node to world space; of nodes that are their own ancestors the identity.
using ScenePose = std::vector<Transform>;

// The pose that the nodes themselves say.
ScenePose RestPose(const GltfDocument& document);

// That one; then those of the animations, at up to eight times evenly spaced over each,
// both ends included (all of them together no more than 48, fewer where nodes are beyond 20,000, by leaving out
// animations evenly where they are many); then two in which every joint of a skin is turned by 30 degrees about its own
// origin, each about an axis of its own: animations may come from other files. Numbers may be anything where the
// document's are.
std::vector<ScenePose> ScenePoses(const GltfDocument& document);

}  // namespace lacerta

#endif  // LACERTA_DOCUMENT_SCENE_POSES_H_
