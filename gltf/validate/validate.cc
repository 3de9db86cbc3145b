#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "document/accessor.h"
#include "document/gltf_document.h"
#include "document/place.h"
#include "document/primitive.h"
#include "document/references.h"
#include "document/scene.h"
#include "extension/progressive.h"
#include "lacerta/gltf.h"
#include "lacerta/surface_distance.h"
#include "pack/repair.h"
#include "pack/single_mesh.h"
#include "unpack/surface_reader.h"

namespace lacerta {
namespace {

class Validator {
 public:
  Validator(const GltfDocument& document, const ValidateOptions& options)
      : document_(document), options_(options), progressive_(ParseProgressive(document)) {}

  void CheckStructure() {
    const std::vector<std::string> dangling = DanglingReferences(document_.json);
    for (const std::string& reference : dangling) Error("", reference);
    if (!dangling.empty()) return;
    if (const Status scene = CollectInstances(document_).status(); !scene.ok()) Error("", scene.message());
  }

  void CheckData() {
    for (uint64_t i = 0; i < ArraySize(document_.json, "bufferViews"); ++i) {
      if (progressive_.ok() && IsTransmitted(i)) continue;  // may be cut short
      const Status status = BufferViewBytes(document_, i).status();
      if (!status.ok()) Error("", status.message());
    }
    for (uint64_t i = 0; i < ArraySize(document_.json, "accessors"); ++i) {
      Status status = ReadAccessor(document_, i).status();
      if (status.code() == StatusCode::kUnsupported) status = CheckAccessor(document_, i);  // matrices
      if (status.code() == StatusCode::kInvalidData) Error("", status.message());
    }
  }

  void CheckExtension() {
    const bool listed = UsesExtension(document_.json, kProgressiveName);
    if (!progressive_.ok()) {
      if (progressive_.status().code() != StatusCode::kNotFound || listed) Error("", progressive_.status().message());
      return;
    }
    if (!listed) Error("", std::string(kProgressiveName) + " is not listed in extensionsUsed");
    const Progressive& progressive = progressive_.value();
    const StatusOr<Bytes> data = TransmittedBytes(document_, progressive);
    if (!data.ok()) return Error("", data.status().message());
    std::set<uint64_t> bases;
    uint64_t sum = 0;
    for (size_t i = 0; i < progressive.segments.size(); ++i) {
      if (i < progressive.streams.size() && !bases.insert(progressive.segments[i].stream).second) {
        Error("", "segment " + std::to_string(i) + " comes before the base of another stream");
      }
      sum += progressive.segments[i].length;
      if (i + 1 == progressive.streams.size() && data.value().size() < sum) Error("", "the bases are not complete");
    }
    if (data.value().size() > sum) Note("", "there are bytes after the last segment");
    if (data.value().size() < sum) {
      Note("", "trimmed: " + std::to_string(data.value().size()) + " of " + std::to_string(sum) + " bytes are there");
    }
    for (size_t s = 0; s < progressive.streams.size(); ++s) CheckStream(s, progressive.streams[s]);
  }

  void CheckPrimitives() {
    for (const std::vector<Place>& places : GroupByGeometry(document_)) {
      const Place place = places[0];
      if (FindExtension(PrimitiveAt(document_, place), kProgressiveName) != nullptr) {
        CheckProgressive(place);
      } else {
        CheckPlain(place);
      }
    }
  }

  void SetOriginal(const GltfDocument* original) { original_ = original; }
  ValidationReport Take() { return std::move(report_); }

 private:
  void Error(const std::string& where, const std::string& message) { report_.issues.push_back({true, where, message}); }
  void Note(const std::string& where, const std::string& message) { report_.issues.push_back({false, where, message}); }

  bool IsTransmitted(uint64_t view) const {
    return view == progressive_.value().data || progressive_.value().refinements == view;
  }

  void CheckStream(size_t index, const ProgressiveStream& stream) {
    const std::string name = "stream " + std::to_string(index);
    for (size_t level = 0; level < stream.vertex_counts.size(); ++level) {
      if (stream.errors[level] < 0.0) Error("", name + ": a negative error");
      if (level == 0) continue;
      if (stream.triangle_counts[level] < stream.triangle_counts[level - 1]) Error("", name + ": levels get coarser");
      if (stream.errors[level] > stream.errors[level - 1] * 1.01) {
        Note("", name + ": level " + std::to_string(level) + " is farther from the original than the one before");
      }
    }
    for (int axis = 0; axis < 3; ++axis) {
      if (stream.min[axis] > stream.max[axis]) Error("", name + ": min is above max");
    }
  }

  void CheckProgressive(const Place& place) {
    const std::string where = PlaceName(document_, place);
    const Json& primitive = PrimitiveAt(document_, place);
    if (AsIndex(Find(primitive, "mode")).value_or(4) != 4) Error(where, "a progressive primitive is not of triangles");
    if (FindExtension(primitive, kDracoName) != nullptr && !UsesExtension(document_.json, kDracoName)) {
      Error(where, std::string(kDracoName) + " is not listed in extensionsUsed");
    }
    int num_levels = 0;
    for (int level = 0; level <= num_levels; ++level) {
      if (caches_.size() <= static_cast<size_t>(level)) caches_.emplace_back();
      UnpackOptions options;
      options.level = level;
      options.limits = options_.limits;
      const StatusOr<ProgressiveSurface> surface = ReadRefinedSurface(document_, progressive_, place, options, &caches_[static_cast<size_t>(level)]);
      if (!surface.ok()) return Error(where, surface.status().message());
      if (surface.value().from_fallback) return Error(where, surface.value().note);
      num_levels = surface.value().num_levels;
      if (surface.value().level < level) {
        const bool trimmed = !IsComplete(primitive);
        return trimmed ? Note(where, surface.value().note) : Error(where, surface.value().note);
      }
      const uint64_t stream = *AsIndex(Find(*FindExtension(primitive, kProgressiveName), "stream"));
      const ProgressiveStream& announced = progressive_.value().streams[static_cast<size_t>(stream)];
      // What several groups are off together says nothing about one of them.
      const bool is_alone = announced.base_lengths.size() <= 1;
      Measure(place, surface.value().surface, level,
              is_alone ? std::optional<double>(announced.errors[static_cast<size_t>(level)]) : std::nullopt);
    }
  }

  bool IsComplete(const Json& primitive) const {
    const uint64_t stream = *AsIndex(Find(*FindExtension(primitive, kProgressiveName), "stream"));
    const StatusOr<GatheredStream> gathered = GatherStream(document_, progressive_.value(), stream);
    return gathered.ok() && gathered.value().complete;
  }

  void CheckPlain(const Place& place) {
    const StatusOr<Primitive> read = ReadPrimitive(document_, PrimitiveAt(document_, place), options_.limits);
    if (read.ok()) {
      const Status finite = CheckFinite(PrimitiveAt(document_, place), read.value(), {});
      if (!finite.ok()) Error(PlaceName(document_, place), finite.message());
      return Measure(place, Surface(read.value()), std::nullopt, std::nullopt);
    }
    if (read.status().code() != StatusCode::kUnsupported) Error(PlaceName(document_, place), read.status().message());
  }

  // Against the primitive at the same place of the original.
  void Measure(const Place& place, const TriangleMesh& surface, std::optional<int> level,
               std::optional<double> announced) {
    constexpr double kTolerance = 1.05;  // two sets of samples
    if (original_ == nullptr) return;
    const std::string where = PlaceName(document_, place);
    const Json* mesh = FindElement(original_->json, "meshes", place.mesh);
    if (mesh == nullptr || place.primitive >= ArraySize(*mesh, "primitives")) {
      return Error(where, "is not in the original");
    }
    const StatusOr<Primitive> before = ReadPrimitive(*original_, PrimitiveAt(*original_, place), options_.limits);
    if (!before.ok()) return Note(where, "the original cannot be measured: " + before.status().message());
    const StatusOr<SurfaceDistanceMeter> meter = SurfaceDistanceMeter::Create(Surface(before.value()));
    if (!meter.ok()) return Note(where, "the original cannot be measured: " + meter.status().message());
    const StatusOr<SurfaceDistance> distance = meter.value().Measure(surface, SurfaceDistanceOptions::RmsOnly());
    if (!distance.ok()) return Note(where, "cannot be measured: " + distance.status().message());
    const double error = distance.value().Rms();
    const double psnr = Psnr(error, meter.value().diagonal());
    report_.measured.push_back({place.mesh, place.primitive, level, announced, error, psnr});
    if (announced.has_value() && error > *announced * kTolerance + 1e-7 * meter.value().diagonal()) {
      Error(where, "level " + std::to_string(*level) + " is " + std::to_string(error) +
                       " off the original, more than the announced " + std::to_string(*announced));
    }
  }

  const GltfDocument& document_;
  const ValidateOptions& options_;
  const StatusOr<Progressive> progressive_;
  const GltfDocument* original_ = nullptr;
  std::vector<AttributedCache> caches_;  // one per level
  ValidationReport report_;
};

}  // namespace

bool ValidationReport::IsValid() const {
  return std::none_of(issues.begin(), issues.end(), [](const ValidationIssue& issue) { return issue.is_error; });
}

namespace {

// As PackMesh made it. An asset of one primitive may hold the shape alone, and shape is all that is measured.
GltfDocument OriginalOf(const FileMesh& mesh, const GltfDocument& packed) {
  const Json* first = FindElement(packed.json, "meshes", 0);
  const bool is_one = first != nullptr && ArraySize(*first, "primitives") == 1;
  return is_one ? SingleMeshDocument(mesh.mesh.surface, "") : SingleMeshDocument(mesh, "");
}

}  // namespace

ValidationReport ValidateGltf(Span<const uint8_t> asset, const ValidateOptions& options) {
  const StatusOr<GltfDocument> document = ParseGltf(asset, options.folder);
  if (!document.ok()) return {{{true, "", document.status().message()}}, {}};
  Validator validator(document.value(), options);
  StatusOr<GltfDocument> original = NotFound("");
  if (options.original_mesh.has_value() || !options.original.empty()) {
    original = options.original_mesh.has_value() ? OriginalOf(*options.original_mesh, document.value())
                                                 : ParseGltf(options.original, options.original_folder);
    if (!original.ok()) return {{{true, "", "the original: " + original.status().message()}}, {}};
    validator.SetOriginal(&original.value());
  }
  validator.CheckStructure();
  validator.CheckData();
  validator.CheckExtension();
  validator.CheckPrimitives();
  return validator.Take();
}

}  // namespace lacerta
