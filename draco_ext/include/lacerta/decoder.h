// Progressive decoding of the refinement of a base mesh that the caller already has. Integers steer, floats only
// follow. Everything here is safe on untrusted bytes: counts are checked against DecodeLimits before memory is taken.
#ifndef LACERTA_DECODER_H_
#define LACERTA_DECODER_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lacerta/attributed_levels.h"
#include "lacerta/attributed_mesh.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// Budget of a decoder. A stream that would exceed it is refused with kLimitExceeded, or decoded up to the last level
// that fits.
struct DecodeLimits {
  uint64_t max_vertices = 64u << 20;
  uint64_t max_triangles = 128u << 20;
};

// A base mesh on an integer lattice: vertex v lies at `step` * lattice[v]. A refinement fits exactly one of them: the
// same vertices and triangles in the same order.
struct BaseMesh {
  float step = 0.0f;                            // model units, > 0 and finite
  std::vector<std::array<int32_t, 3>> lattice;  // #V0, |value| < 2^24
  std::vector<Triangle> triangles;              // #F0

  TriangleMesh ToMesh() const;
};

// The base mesh of a host that holds floats, as glTF and Draco decoders do: every coordinate is rounded to the nearest
// multiple of `step`. Fails with kInvalidArgument where the step is not a positive number and with kInvalidData where a
// coordinate is not finite, further than a quarter of a step away from the lattice, or |lattice| reaches 2^24.
StatusOr<BaseMesh> BaseMeshFromPositions(const TriangleMesh& mesh, float step);

// A base mesh as it comes out of its compact form, which the custom form of a stream carries (docs/format.md, "Compact base").
struct CompactBase {
  BaseMesh mesh;
  Vec3f offset{0, 0, 0};  // model units, added to the positions of `mesh`; zero where a refinement follows

  TriangleMesh ToMesh() const;
};

// Decodes the compact base that fills `bytes`: connectivity by valences, positions by differences. Its triangles are an oriented
// manifold, with or without border, and every vertex has one. Safe on untrusted bytes. Fails with kInvalidData, or with kLimitExceeded
// before memory is taken for more than `limits`.
StatusOr<CompactBase> DecodeCompactBase(Span<const uint8_t> bytes, const DecodeLimits& limits);

// The triangle mesh of one level (0 = base) of a semi-regular mesh; above the base, the still triangles come last. Fails with
// kInvalidArgument where it has no such level and with kInvalidData where the base is not manifold or its tags do not fit it.
StatusOr<TriangleMesh> MeshAtLevel(const SemiRegularMesh& mesh, int level);

// Where the values of an attribute lie in the base: what a host needs to turn its floats into integers.
struct AttributeLattice {
  std::string name;  // as in glTF
  AttributeKind kind = AttributeKind::kGeneric;
  uint32_t components = 1;
  float step = 0.0f;        // values are multiples of it; 0 for normals
  int octahedral_bits = 0;  // of normals, as in Draco: 2..16; else 0
};

// What the header of a refinement tells before anything is decoded.
struct RefinementInfo {
  int num_levels = 0;
  float base_step = 0.0f;  // model units: what BaseMeshFromPositions wants; 0 where only the compact base tells it
  bool has_layers = false;  // levels come in several rounds
  bool is_attributed = false;  // the refinement wants an AttributedBase (lacerta/attributed_base.h)
  std::vector<AttributeLattice> attributes;
};

struct AttributedBase;

// Reads the header at the beginning of the bytes that follow the base section. Fails with kInvalidData where there is
// no complete and sound header, and with kUnsupported on an unknown version.
StatusOr<RefinementInfo> ReadRefinementInfo(Span<const uint8_t> refinement);

struct RefinementOptions {
  std::optional<int> max_level;  // stop there; empty: as far as the bytes go
  DecodeLimits limits;
};

// Decodes a refinement as its bytes arrive.
//   LACERTA_ASSIGN_OR_RETURN(ProgressiveDecoder decoder, ProgressiveDecoder::Create(base, {}));
//   while (more bytes) { if (!decoder.Append(bytes).ok()) break; Draw(decoder.mesh()); }
// After a failure the mesh decoded so far stays, and later bytes are ignored.
class ProgressiveDecoder {
 public:
  // Fails with kInvalidData where a lattice value or the step is out of range, and with kLimitExceeded where the base
  // alone is over the limits.
  static StatusOr<ProgressiveDecoder> Create(const BaseMesh& base, const RefinementOptions& options);
  // For refinements that carry attributes or groups (RefinementInfo::is_attributed). Fails with kInvalidData, too, where arrays do not
  // have the shapes that AttributedBase tells, or a glued base is no manifold.
  static StatusOr<ProgressiveDecoder> Create(const AttributedBase& base, const RefinementOptions& options);
  ProgressiveDecoder(ProgressiveDecoder&&) noexcept;
  ProgressiveDecoder& operator=(ProgressiveDecoder&&) noexcept;
  ~ProgressiveDecoder();

  // Takes the next bytes, however they are cut, and decodes every level that they complete. Returns refinement().
  // Bytes after the last segment are ignored.
  Status Append(Span<const uint8_t> bytes);

  int level() const;          // of the finest complete level
  int num_levels() const;     // that the header announces; 0 before it is complete
  // Meshes above the base that the bytes so far make, one after the other. Without quality layers they are the levels; with layers a
  // later one may have the same level as the one before, and be nearer to the surface. mesh() is the last of them.
  int state() const;
  bool has_layers() const;    // the header announces quality layers
  bool is_complete() const;   // nothing that is wanted is missing
  size_t bytes_used() const;  // length of the prefix that holds mesh(): header and complete segments
  // Ok, or why the refinement ended early: damaged or unsupported bytes (kInvalidData, kUnsupported), a base that it
  // was not made for (kInvalidData), or a level over the limits (kLimitExceeded). Bytes that just end are no failure.
  const Status& refinement() const;
  const SemiRegularMesh& mesh() const;  // base and complete levels

  // Those of mesh() at level(), as MeshAtLevel gives them, but without making all levels anew.
  std::vector<Triangle> Triangles() const;
  // Attributes of mesh(), and groups of its base triangles: empty where the base was a BaseMesh.
  const std::vector<LevelAttribute>& attributes() const;
  const std::vector<uint32_t>& base_groups() const;
  // For each of Triangles() the rows of attributes()[attribute].values at its corners, MeshAttribute::kNoValue x 3 without; and its group.
  std::vector<Triangle> Corners(size_t attribute) const;
  std::vector<uint32_t> Groups() const;
  // mesh(), out of a decoder that is wanted no more.
  SemiRegularMesh TakeMesh() &&;
  // The same with attributes() and base_groups().
  AttributedSemiRegularMesh TakeAttributed() &&;

 private:
  struct State;
  explicit ProgressiveDecoder(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

struct RefinementResult {
  SemiRegularMesh mesh;  // base and complete levels
  int level = 0;         // of mesh
  int num_levels = 0;    // that the header announces; 0 where there is no complete header
  int state = 0;         // as ProgressiveDecoder::state()
  bool is_complete = false;  // as ProgressiveDecoder::is_complete()
  Status refinement;  // as ProgressiveDecoder::refinement(); ok and not complete: the bytes ended
  size_t bytes_used = 0;  // as ProgressiveDecoder::bytes_used()
};

// Decodes a refinement, or any prefix of one, in one go. Fails only where `base` is at fault (see Create).
StatusOr<RefinementResult> DecodeRefinement(const BaseMesh& base, Span<const uint8_t> refinement,
                                            const RefinementOptions& options);

}  // namespace lacerta

#endif  // LACERTA_DECODER_H_
