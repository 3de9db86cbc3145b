// glTF assets with progressive meshes: packing, unpacking, looking inside. The extension LACERTA_mesh_progressive is
// described in gltf/LACERTA_mesh_progressive/README.md. No type of a glTF library in sight: assets travel as the bytes
// of their files.
#ifndef LACERTA_GLTF_H_
#define LACERTA_GLTF_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lacerta/codec.h"
#include "lacerta/decoder.h"
#include "lacerta/file_mesh.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// What a reader that does not know LACERTA_mesh_progressive shows.
enum class Fallback {
  kDraco,  // the base mesh, for readers of KHR_draco_mesh_compression; costs no bytes
  kPlain,  // the base mesh, for every reader
  kNone,   // nothing: such a reader refuses the asset
};

// How far attributes may be off where they are stored with less than their full precision: root mean square over the
// surface; of simplified surfaces over the 99 % of it where the error is least.
struct AttributeTargets {
  // Texels of the largest texture of the asset, at least 1024. One texel is the distance over which bilinear filtering
  // blurs anyway. Of coordinates that no texture is laid by: of such a texture four times over their range, where that is above 4.
  double uv_texels = 1.0;
  // Of normals and tangents. Two degrees are below what a mesh at 70 dB shows of its own shape.
  double normal_degrees = 2.0;
  // Of each component of colors as screens show them (sRGB): 1.5 of 255 steps are what a good JPEG is off. Colors are stored as linear light: they
  // may be off by what comes to that in the mean over the surface, less where it is dark, but never less than integers of 8 bits are.
  double color = 1.5 / 255;
  // Of each component of weights that no skin uses, as 8-bit integers do it, the coarsest that core glTF has: 1 / (255 sqrt(12)). Others are held to what
  // poses show.
  double weight = 0.00113;
  // Of each component of application attributes (`_X`) of floats that are not all whole numbers, relative to the range of the values in
  // meshes that touch. Whole numbers may name something: they stay exact, as all do at 0, and their meshes keep their vertices.
  double custom = 0.00113;
  // Simplified surfaces meet `normal_degrees` over their whole area, too, or are as good as all vertices rounded are: the last
  // hundredth, small parts and sharp rims, takes half as many bytes again.
  bool normals_everywhere = false;
  // Share of the area that may look away from all of the original near it, or from its own normals; over twenty times that share the back
  // of a thin sheet may come before its front. At targets below 70 dB up to as many times more as errors are larger, but no more than a hundredth.
  double turned = 5e-4;
};

struct PackOptions {
  // For the whole asset: bytes are those of all its geometry, errors are relative to the diagonal of its default scene.
  // No mesh gets worse than 40 dB of its own diagonal for an error that asks for more.
  EncodeOptions encode;
  AttributeTargets attributes;
  // Whether surfaces with attributes may be simplified where that is smaller and the errors are met: of skinned ones in poses of
  // the animations and of turned joints, too, with morph targets at weight 1 of each.
  bool simplify = true;
  Fallback fallback = Fallback::kDraco;
  // Offsets of morph targets stay floats. Else those that stand beside Draco become integers where these are precise enough, for readers
  // that know KHR_mesh_quantization.
  bool float_targets = false;
  // Attributes that nothing in the asset shows go from what is stored anew: texture coordinates that no texture is laid by, normals and tangents of unlit
  // materials, tangents without a normal map or anisotropy, colors beyond COLOR_0, joints and weights without a skin. Else they stay, for materials that may come
  // later, and the report has a note on them.
  bool drop_unused = false;
  // So do tangents that readers may compute from normals and texture coordinates, by MikkTSpace as glTF 2.0 says [3.7.2.1]: those of normal maps, not of
  // anisotropy. Some readers take derivatives on the screen instead, and some, such as VTK 9.1, shade dark without.
  bool drop_tangents = false;
  // Of a glTF asset: numbers that are not finite are mended, each primitive with a note in the report, instead of refused. Vertices
  // without a finite position go with their triangles; other values follow those beside them.
  bool repair = false;
  std::string folder;  // where the external buffers and images of a .gltf are
  // Images in files of their own become part of the GLB, which may then lie anywhere. Those of data URIs always do.
  bool embed_images = false;
  // Not empty: refinements go into a file of their own, which the GLB refers to by this relative URI.
  std::string external_uri;
};

enum class PrimitiveStorage {
  kProgressive,  // LACERTA_mesh_progressive
  kDraco,        // KHR_draco_mesh_compression with all attributes
  kUntouched,    // as it was
};

// An attribute of a primitive that is stored anew.
struct AttributeReport {
  std::string name;
  int bits = 0;        // per component, of KHR_draco_mesh_compression; 0: exact
  double error = 0.0;  // measured, RMS over the surface
  std::string unit;    // "texels", "degrees", or empty: that of the values
};

struct PrimitiveReport {
  uint64_t mesh = 0;  // index of the glTF mesh, and of the primitive in it
  uint64_t primitive = 0;
  std::string name;  // of the mesh; may be empty
  PrimitiveStorage storage = PrimitiveStorage::kUntouched;
  std::string reason;         // why it is not progressive, or what EncodeMesh had to say; else empty
  uint64_t bytes_before = 0;  // of its attributes, indices and morph targets, as often as the asset holds them
  uint64_t bytes_after = 0;
  EncodeReport encode;  // of what EncodeMesh made, and of streams with attributes (where several share one, of all of it with each); else it has no levels
  // Of those stored as Draco or with attributes: measured d_S in mesh units (over all primitives that touch it and share its lattice), what
  // was asked for, and the bits of a position.
  double error = 0.0;
  double target_error = 0.0;
  int position_bits = 0;  // of those stored as Draco
  std::vector<AttributeReport> attributes;  // without positions
};

struct PackReport {
  std::vector<PrimitiveReport> primitives;
  std::vector<std::string> notes;  // on the asset as a whole
};

struct PackResult {
  Bytes glb;
  Bytes external;  // the bytes of the file named by PackOptions::external_uri; empty where there is nothing to refine
  PackReport report;
};

// Packs a .glb or .gltf. Every mesh of one primitive with positions only (and normals that can be derived from them)
// becomes progressive, or plain Draco where it has no levels, need not have any, and the fallback is Draco; so do surfaces with attributes, all primitives that touch in one stream, where that is smaller (or
// levels are always wanted). Other triangles are stored as KHR_draco_mesh_compression, and what neither can hold stays as
// it was, each with its reason in the report. Normals of flat shading go from what is stored anew: their absence means the same. All else
// in the asset passes through: nodes, materials, images byte for byte, animations, skins, extras, unknown extensions. Fails with
// kInvalidData, naming mesh, primitive, accessor and index; kUnsupported for compressions and versions that it does not know;
// kInvalidArgument for options that do not go together; kLimitExceeded where memory runs out.
StatusOr<PackResult> PackGltf(Span<const uint8_t> asset, const PackOptions& options);

// Packs one mesh as an asset of its own. `name` may be empty. Fails like EncodeMesh.
StatusOr<PackResult> PackMesh(const TriangleMesh& mesh, const std::string& name, const PackOptions& options);

// The same of a mesh with what its file laid on it: one primitive for each group. Its notes come first in the report's.
StatusOr<PackResult> PackMesh(const FileMesh& mesh, const std::string& name, const PackOptions& options);
// The same without a copy of large surfaces; what is left of `mesh` is of no use.
StatusOr<PackResult> PackMesh(FileMesh&& mesh, const std::string& name, const PackOptions& options);

// A GLB of one mesh in core glTF, uncompressed. Triangle indices must be below #V. Fails with kUnsupported beyond 4 GB.
StatusOr<Bytes> FormatPlainGlb(const TriangleMesh& mesh, const std::string& name, const Vec3d& origin = {});
StatusOr<Bytes> FormatPlainGlb(const FileMesh& mesh, const std::string& name);

struct UnpackOptions {
  std::optional<int> level;  // stop there; empty: as far as the data goes
  std::string folder;
  bool embed_images = false;  // of UnpackGltf: as in PackOptions
  DecodeLimits limits;
  Vec3d origin = {};  // of FlattenGltf: positions are relative to it
};

// A progressive primitive as read.
struct ProgressiveSurface {
  uint64_t mesh = 0;
  uint64_t primitive = 0;
  TriangleMesh surface;
  // Of streams that carry attributes: one value per vertex of `surface`, which has a vertex for each side of a seam.
  // WEIGHTS_0 of skins has the sum 1, and JOINTS_0 whole numbers.
  std::vector<VertexSoup::Attribute> attributes;
  // Of each morph target its attributes (POSITION, NORMAL, TANGENT): three numbers per vertex of `surface`.
  std::vector<std::vector<VertexSoup::Attribute>> targets;
  bool smooth_normals = false;  // the asset wants normals derived from the surface; else flat shading
  int level = 0;                // of `surface`
  int num_levels = 0;           // levels above the base that the asset announces
  bool from_fallback = false;   // `surface` is the fallback geometry, not taken from the stream
  std::string note;             // why the level is not the one asked for, or why the fallback was drawn; else empty
};

// All progressive primitives. A reference that leads nowhere, a checksum or bounds that do not match and the like make
// the reader fall back to the core or KHR_draco geometry of that primitive and say so in its note; it fails only where
// there is no such geometry.
StatusOr<std::vector<ProgressiveSurface>> ReadProgressive(Span<const uint8_t> asset, const UnpackOptions& options);

struct UnpackResult {
  Bytes glb;
  std::vector<std::string> notes;  // of ReadProgressive, each with its mesh
};

// The asset in core glTF: progressive and Draco-compressed primitives become plain accessors. Fails like
// ReadProgressive.
StatusOr<UnpackResult> UnpackGltf(Span<const uint8_t> asset, const UnpackOptions& options);

struct TrimOptions {
  std::optional<int> level;       // keep no bytes of levels above it; exactly one of the two has to be set
  std::optional<uint64_t> bytes;  // of the GLB at most
  std::string folder;
  bool embed_images = false;  // as in PackOptions; they count in `bytes`
};

struct TrimResult {
  Bytes glb;
  bool has_levels = true;   // false: no mesh has any, and the asset stays whole
  bool meets_bytes = true;  // false: even the base meshes and all that is not geometry are larger
  std::vector<std::string> notes;  // images that stay references
};

// A packed asset with fewer refinements, as a legal asset again: the segments that stay are whole, everything else is as
// it was, and the fallback with it. Refinements in a file of their own come back into the GLB. A GLB of which no mesh has levels stays as it is, but for
// images. Fails with kInvalidArgument, kUnsupported where there is nothing to trim and no GLB, and like ReadProgressive.
StatusOr<TrimResult> TrimGltf(Span<const uint8_t> asset, const TrimOptions& options);

struct ValidateOptions {
  std::string folder;
  DecodeLimits limits;
  // The asset before packing, to measure the announced errors against; empty: they are not measured.
  Span<const uint8_t> original;
  std::string original_folder;
  std::optional<FileMesh> original_mesh;  // instead of an asset: what PackMesh was given, or whose shape alone it was given
};

struct ValidationIssue {
  bool is_error = true;  // false: legal, but worth to know
  std::string where;     // "mesh 2 (Helmet), primitive 0", or empty: the asset as a whole
  std::string message;
};

// A level of a stream, or a primitive that is no stream, beside the original.
struct MeasuredError {
  uint64_t mesh = 0;
  uint64_t primitive = 0;
  std::optional<int> level;          // of a stream
  std::optional<double> announced;   // mesh units
  double measured = 0.0;             // d_S, mesh units
  double psnr = 0.0;                 // dB
};

struct ValidationReport {
  std::vector<ValidationIssue> issues;
  std::vector<MeasuredError> measured;
  bool IsValid() const;  // no issue is an error
};

// Looks at all that this library can judge: the extension's JSON, every reference and range, that each level of every
// stream decodes to the counts and bounds that the asset announces, that the fallback is the base, that Draco streams
// decode; with an original, the errors. What core glTF demands beyond that is the official validator's to say.
ValidationReport ValidateGltf(Span<const uint8_t> asset, const ValidateOptions& options);

struct FlattenResult {
  TriangleMesh mesh;
  std::vector<std::string> notes;
};

// All triangles of the default scene (the first scene where none is named, all meshes where there is no scene) in world
// coordinates. Skins and morph targets are not applied. Fails with kInvalidData or kUnsupported.
StatusOr<FlattenResult> FlattenGltf(Span<const uint8_t> asset, const UnpackOptions& options);

// One progressive stream: as the JSON of an asset describes it, or as read from its own headers.
struct StreamInfo {
  struct Level {
    uint64_t vertices = 0;
    uint64_t triangles = 0;
    uint64_t bytes = 0;           // of the stream up to and with this level
    std::optional<double> error;  // mesh units; a bare stream does not say
    bool available = false;       // all its bytes are in the file
  };
  uint64_t mesh = 0;  // the first primitive that shows it
  uint64_t primitive = 0;
  std::string name;
  double diagonal = 0.0;  // of the bounding box, mesh units
  std::vector<Level> levels;
};

struct PrimitiveInfo {
  uint64_t mesh = 0;
  uint64_t primitive = 0;
  std::string name;
  PrimitiveStorage storage = PrimitiveStorage::kUntouched;
  uint64_t vertices = 0;   // as its accessors say: of the fallback where it is progressive
  uint64_t triangles = 0;  // 0 for points and lines
  uint64_t bytes = 0;      // of its own data; 0 where it is progressive, see its stream
};

struct AssetInfo {
  std::vector<StreamInfo> streams;
  std::vector<PrimitiveInfo> primitives;
  Fallback fallback = Fallback::kDraco;  // of the first stream; means nothing where there is no stream
  uint64_t num_primitives = 0;
  uint64_t num_draco_primitives = 0;  // with KHR_draco_mesh_compression but not progressive
};

// What is inside, without decoding. Fails with kInvalidData when the extension contradicts itself.
StatusOr<AssetInfo> DescribeGltf(Span<const uint8_t> asset, const std::string& folder);

// What a bare stream (.drc) holds: either form of ours, or a stock Draco mesh with its one level. Where the refinement
// ends early, the levels after its end are left out. Fails like DecodeMesh.
StatusOr<StreamInfo> DescribeStream(Span<const uint8_t> stream, const DecodeLimits& limits);

}  // namespace lacerta

#endif  // LACERTA_GLTF_H_
