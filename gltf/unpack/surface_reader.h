// One progressive primitive out of a document, or its fallback where the asset was edited or damaged.
#ifndef LACERTA_UNPACK_SURFACE_READER_H_
#define LACERTA_UNPACK_SURFACE_READER_H_

#include <vector>

#include "document/gltf_document.h"
#include "document/place.h"
#include "document/primitive.h"
#include "extension/progressive.h"
#include "lacerta/gltf.h"
#include "pack/source.h"
#include "unpack/attributed_reader.h"

namespace lacerta {

struct Bounds {
  Vec3f min, max;
};
Bounds BoundsOf(const std::vector<Vec3f>& positions);

// The surface of the stream, or, where the stream is not to be used, `from_fallback` with the reason in `note` and an
// empty surface: a host that has the fallback already need not read it. `progressive` is what ParseProgressive said of
// the document; `cache` holds what several primitives have in common. The primitive at `place` has the extension. Fails
// where there is neither.
StatusOr<ProgressiveSurface> ReadRefinedSurface(const GltfDocument& document, const StatusOr<Progressive>& progressive,
                                                const Place& place, const UnpackOptions& options, AttributedCache* cache);

// The same with the geometry of the fallback where that is used. Fails only where neither the stream nor a fallback
// gives a mesh.
StatusOr<ProgressiveSurface> ReadSurface(const GltfDocument& document, const StatusOr<Progressive>& progressive,
                                         const Place& place, const UnpackOptions& options, AttributedCache* cache);

// Values of an attribute that came with a surface: floats, and joints in as few bytes as hold them all.
AccessorData ToAccessor(const VertexSoup::Attribute& attribute);

// Morph targets of `surface`; empty where it has none.
std::vector<MorphTarget> ToTargets(const ProgressiveSurface& surface);

// As a primitive: positions, attributes and derived normals of `surface`.
Primitive ToPrimitive(const ProgressiveSurface& surface);

}  // namespace lacerta

#endif  // LACERTA_UNPACK_SURFACE_READER_H_
