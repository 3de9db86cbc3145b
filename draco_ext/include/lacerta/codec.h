// The codec in two calls: a mesh goes in and a progressive stream comes out, and back. No Draco type in sight; the pair in
// Draco's own manner is in lacerta/draco.h.
#ifndef LACERTA_CODEC_H_
#define LACERTA_CODEC_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lacerta/clean.h"
#include "lacerta/decoder.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// What a stream is asked to be. Rate counts every byte of the stream; distortion is the two-sided surface distance d_S to
// the input (lacerta/surface_distance.h).
struct EncodeTarget {
  enum class Kind {
    kBytes,          // at most this many bytes, and within 2 % of them
    kBitsPerVertex,  // the same in bits per vertex of the cleaned input (b/iv)
    kPsnr,           // at least this many dB: 20 log10(bounding-box diagonal / d_S), and less than 0.3 dB over it
    kError,          // d_S at most this share of the bounding-box diagonal
    kDistance,       // d_S at most this many units of the mesh; of a scene, of the world
  };
  Kind kind = Kind::kPsnr;
  double value = 70.0;
};

// Where the stream can be opened.
enum class StreamForm {
  kDraco,   // begins with a complete stock Draco stream of the base mesh: every Draco decoder shows the base
  kCustom,  // Draco's header with our own method byte, then a base mesh in compact form: smaller, and only Lacerta opens it
};

// How the coefficients are chosen and quantized (docs/decisions).
enum class EncodeMode {
  kDefault,  // the best known
  kPaper,    // [Payan & Antonini 2004] as written: open loop, model-based allocation
};

// Whether a stream has refinement levels.
enum class LevelChoice {
  kWhereTheyPay,  // unless a simplified mesh without levels is clearly smaller or closer
  kAlways,        // wherever there is a component to remesh, for the sake of streaming
  kNever,         // a simplified mesh
};

// How much the encoder tries; decoding takes the same time whatever it was.
enum class Effort {
  kFast,    // one base size and fewer passes: about half the time, 4 % more bytes
  kNormal,
  kBest,    // all that kNormal tries, and base sizes halfway between: 1.3 times the time, 0.3 % fewer bytes
};

struct EncodeOptions {
  EncodeTarget target;
  StreamForm form = StreamForm::kDraco;
  EncodeMode mode = EncodeMode::kDefault;
  LevelChoice levels = LevelChoice::kWhereTheyPay;
  Effort effort = Effort::kNormal;
  // 1..8. With more than one the coefficients of a level come in several rounds, coarse values first, so that a stream cut short is
  // nearer to the surface; the whole takes some more bytes (docs/results/prefix_table.md).
  int quality_layers = 1;
  // Bytes that encoding should do with, the mesh included; 0: no limit. Where they are fewer than the usual need, the input is followed by way of
  // a mesh of as few triangles as they allow, errors are measured to the input all the same, and subdivision of the input is not looked for.
  // Allocations are not counted; where one fails, less is tried. Else the stream depends on this number, not on what is free.
  uint64_t memory = 0;
  // Called now and then with the finished share (0..1) and what is being done; may be empty.
  std::function<void(double share, const char* stage)> progress;
};

// One decodable state of the stream: a level or, with quality layers, a level at some quality.
struct LevelReport {
  uint64_t vertices = 0;
  uint64_t triangles = 0;
  uint64_t bytes = 0;   // length of the prefix of the stream that holds it
  double error = 0.0;   // measured d_S to the cleaned input, in model units
  double psnr = 0.0;    // dB
};

// The connected components of an input.
struct PartsReport {
  uint64_t refined_components = 0;  // remeshed, with all levels
  uint64_t still_components = 0;    // too few triangles to be worth that: simplified, the same at every level
  uint64_t hidden_components = 0;   // of those, left out: nearer to a refined one than the error that was asked for
  uint64_t flipped_triangles = 0;   // turned over to agree with their neighbors
  uint64_t cut_edges = 0;           // edges of more than two faces, or where orientations could not agree
  uint64_t split_vertices = 0;      // by those cuts, and where parts touched in a point
  uint64_t mended_tears = 0;        // borders that such cuts would have opened, closed instead
  uint64_t stray_components = 0;    // handfuls of triangles at such places, left out
};

struct EncodeReport {
  CleanReport clean;
  PartsReport parts;  // of a remeshed input
  uint64_t input_vertices = 0;    // after cleaning
  uint64_t input_triangles = 0;
  double diagonal = 0.0;          // of the input's bounding box, model units
  bool progressive = false;       // false: a zero-level stream, stock Draco alone
  // The input had subdivision connectivity and was coded on it: vertices and triangles come back one for one.
  bool subdivided_input = false;
  std::string reason;             // why it is not progressive, or why the target could not be met; else empty
  double normal_share = 0.0;      // share of detail coefficients whose remeshed position lies on the normal line
  double remesh_psnr = 0.0;       // of the unquantized remesh
  int measurements = 0;           // of the surface distance that it took to bring this stream to its target
  std::vector<LevelReport> levels;  // base first; one per part of the stream
};

struct EncodedMesh {
  Bytes stream;
  // Lengths of the parts of `stream`, in order: the base section, then one part per decodable state, that is per level or, with
  // quality layers, per state of ProgressiveDecoder (the refinement header belongs to the first of them). They add up to stream.size().
  std::vector<size_t> part_sizes;
  EncodeReport report;
};

// Encodes a triangle mesh. Fails with kInvalidData on positions that are not finite, indices out of range, or no triangle
// left after cleaning; with kInvalidArgument on a target that makes no sense; with kLimitExceeded where memory runs out or
// `options.memory` is too little.
StatusOr<EncodedMesh> EncodeMesh(const TriangleMesh& mesh, const EncodeOptions& options);
// The same without a copy of large meshes; what is left of `mesh` is of no use.
StatusOr<EncodedMesh> EncodeMesh(TriangleMesh&& mesh, const EncodeOptions& options);

struct DecodedMesh {
  TriangleMesh mesh;
  int level = 0;          // of `mesh`
  int num_levels = 0;     // refinement levels that the stream announces
  bool has_layers = false;  // quality layers: see EncodeOptions
  int state = 0;            // as ProgressiveDecoder::state()
  // Ok, or why the refinement stopped before num_levels (a damaged or truncated segment): `mesh` is what came before it.
  Status refinement;
};

struct DecodeOptions {
  std::optional<int> max_level;  // stop there; empty: as far as the bytes go
  DecodeLimits limits;
};

// Decodes either form, a stock Draco mesh stream, and any prefix of them that holds the base section.
StatusOr<DecodedMesh> DecodeMesh(Span<const uint8_t> stream, const DecodeOptions& options);

}  // namespace lacerta

#endif  // LACERTA_CODEC_H_
