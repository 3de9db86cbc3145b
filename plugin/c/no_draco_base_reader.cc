#include "base_reader.h"

namespace lacerta {

bool CanReadStockBase() { return false; }

StatusOr<StockBase> ReadStockBase(Span<const uint8_t>, const DecodeLimits&) {
  return Unsupported("this library was built without Draco");
}

StatusOr<VertexSoup> ReadStockGroup(Span<const uint8_t>, const std::vector<std::string>&, const DecodeLimits&) {
  return Unsupported("this library was built without Draco");
}

}  // namespace lacerta
