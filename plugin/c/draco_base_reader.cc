#include <utility>

#include "base_reader.h"
#include "draco/attributed_base_codec.h"
#include "draco/base_mesh_codec.h"

namespace lacerta {

bool CanReadStockBase() { return true; }

StatusOr<StockBase> ReadStockBase(Span<const uint8_t> bytes, const DecodeLimits& limits) {
  LACERTA_ASSIGN_OR_RETURN(DecodedBase base, DecodeBaseMesh(bytes, limits));
  return StockBase{std::move(base.mesh), base.bytes_used};
}

StatusOr<VertexSoup> ReadStockGroup(Span<const uint8_t> bytes, const std::vector<std::string>& names, const DecodeLimits& limits) {
  return DecodeAttributedGroup(bytes, names, limits);
}

}  // namespace lacerta
