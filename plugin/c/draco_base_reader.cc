#include <utility>

#include "base_reader.h"
#include "draco/base_mesh_codec.h"

namespace lacerta {

bool CanReadStockBase() { return true; }

StatusOr<StockBase> ReadStockBase(Span<const uint8_t> bytes, const DecodeLimits& limits) {
  LACERTA_ASSIGN_OR_RETURN(DecodedBase base, DecodeBaseMesh(bytes, limits));
  return StockBase{std::move(base.mesh), base.bytes_used};
}

}  // namespace lacerta
