// Bases in Draco form. One of two sources is built: draco_base_reader.cc, or no_draco_base_reader.cc where the library goes without Draco, as in
// WebAssembly beside a host that has one already.
#ifndef LACERTA_PLUGIN_C_BASE_READER_H_
#define LACERTA_PLUGIN_C_BASE_READER_H_

#include <cstddef>
#include <string>
#include <vector>

#include "lacerta/attributed_mesh.h"
#include "lacerta/decoder.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

struct StockBase {
  TriangleMesh mesh;
  size_t bytes_used = 0;  // length of the Draco stream at the front of the bytes
};

bool CanReadStockBase();
// Fails with kInvalidData where the bytes end too early or are damaged. Only where CanReadStockBase().
StatusOr<StockBase> ReadStockBase(Span<const uint8_t> bytes, const DecodeLimits& limits);
// The Draco stream of one group of a base with attributes: those of `names` that the group has. Fails as ReadStockBase does.
StatusOr<VertexSoup> ReadStockGroup(Span<const uint8_t> bytes, const std::vector<std::string>& names, const DecodeLimits& limits);

}  // namespace lacerta

#endif  // LACERTA_PLUGIN_C_BASE_READER_H_
