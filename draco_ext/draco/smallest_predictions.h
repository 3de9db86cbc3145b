// The predictions by which the attributes of a stock Draco stream take the fewest bytes.
#ifndef LACERTA_DRACO_SMALLEST_PREDICTIONS_H_
#define LACERTA_DRACO_SMALLEST_PREDICTIONS_H_

#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>

#include <functional>
#include <vector>

#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// By attribute, draco::PredictionSchemeMethod; PREDICTION_UNDEFINED is what Draco itself chooses.
using Predictions = std::vector<int>;

// Fails where Draco refuses one.
Status SetPredictions(const Predictions& predictions, draco::ExpertEncoder* encoder);

// Tries one attribute after the other. Which prediction an attribute has changes neither values nor order of what is decoded.
//   mesh    whose attributes these are
//   encode  the stream of the mesh by edgebreaker with the given predictions
//   stream  that of Draco's own choice; becomes the smallest
// Returns the predictions of `stream`.
Predictions FindPredictions(const draco::Mesh& mesh, const std::function<StatusOr<Bytes>(const Predictions&)>& encode, Bytes* stream);

}  // namespace lacerta

#endif  // LACERTA_DRACO_SMALLEST_PREDICTIONS_H_
