#include "draco/smallest_predictions.h"

#include <draco/compression/config/compression_shared.h>

#include <cstddef>
#include <utility>

namespace lacerta {
namespace {

// At its most thorough Draco predicts texture coordinates from positions, which is of no use where the texture is stretched unevenly, and all
// but them and normals by several parallelograms.
std::vector<int> OthersOf(draco::GeometryAttribute::Type type) {
  switch (type) {
    case draco::GeometryAttribute::NORMAL:
      return {draco::PREDICTION_DIFFERENCE};
    case draco::GeometryAttribute::TEX_COORD:
      return {draco::MESH_PREDICTION_PARALLELOGRAM, draco::MESH_PREDICTION_CONSTRAINED_MULTI_PARALLELOGRAM, draco::PREDICTION_DIFFERENCE};
    default:
      return {draco::MESH_PREDICTION_PARALLELOGRAM, draco::PREDICTION_DIFFERENCE};
  }
}

}  // namespace

Status SetPredictions(const Predictions& predictions, draco::ExpertEncoder* encoder) {
  for (size_t i = 0; i < predictions.size(); ++i) {
    if (predictions[i] == draco::PREDICTION_UNDEFINED) continue;
    const draco::Status status = encoder->SetAttributePredictionScheme(static_cast<int>(i), predictions[i]);
    if (!status.ok()) return Unsupported("Draco refuses a prediction (" + status.error_msg_string() + ")");
  }
  return Status();
}

Predictions FindPredictions(const draco::Mesh& mesh, const std::function<StatusOr<Bytes>(const Predictions&)>& encode, Bytes* stream) {
  Predictions best(static_cast<size_t>(mesh.num_attributes()), draco::PREDICTION_UNDEFINED);
  for (size_t i = 0; i < best.size(); ++i) {
    for (const int other : OthersOf(mesh.attribute(static_cast<int>(i))->attribute_type())) {
      Predictions predictions = best;
      predictions[i] = other;
      StatusOr<Bytes> bytes = encode(predictions);  // a refusal costs only that prediction
      if (!bytes.ok() || bytes.value().size() >= stream->size()) continue;
      *stream = std::move(bytes).value();
      best = std::move(predictions);
    }
  }
  return best;
}

}  // namespace lacerta
