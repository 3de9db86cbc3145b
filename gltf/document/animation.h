// What animations do to the nodes of a document, and to the morph targets of their meshes.
#ifndef LACERTA_DOCUMENT_ANIMATION_H_
#define LACERTA_DOCUMENT_ANIMATION_H_

#include <cstdint>
#include <vector>

#include "document/accessor.h"
#include "document/gltf_document.h"
#include "document/scene.h"

namespace lacerta {

// Keyframes of one part of a node's placement.
struct AnimationTrack {
  enum class Part { kTranslation, kRotation, kScale };
  uint64_t node = 0;  // of the document
  Part part = Part::kTranslation;
  std::vector<float> times;  // seconds, ascending; not empty
  AccessorData values;       // one for each time
  bool is_stepped = false;

  // Where it is at a time. Between keyframes straight from one to the other, for cubic splines, too: close to what a
  // viewer shows, not the same.
  void Place(double time, NodePlacement* placement) const;
};

struct Animation {
  std::vector<AnimationTrack> tracks;
  double begin = 0.0, end = 0.0;  // seconds
};

// All animations that move nodes. Tracks that cannot be read are left out, and those beyond 16 million keyframes.
std::vector<Animation> ReadAnimations(const GltfDocument& document);

// Weights of the morph targets of a node's mesh at its keyframes.
struct WeightTrack {
  uint64_t node = 0;
  uint64_t num_targets = 0;  // > 0
  AccessorData values;       // keyframe after keyframe, one for each target; at least one keyframe
};

// Of all animations; those that cannot be read are left out, as above.
std::vector<WeightTrack> ReadWeightTracks(const GltfDocument& document);

}  // namespace lacerta

#endif  // LACERTA_DOCUMENT_ANIMATION_H_
