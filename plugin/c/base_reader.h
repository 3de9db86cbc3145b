// Bases in Draco form. One of two sources is built: draco_base_reader.cc, or no_draco_base_reader.cc where the library goes without Draco, as in
// WebAssembly beside a host that has one already.
#ifndef LACERTA_PLUGIN_C_BASE_READER_H_
#define LACERTA_PLUGIN_C_BASE_READER_H_

#include <cstddef>

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

}  // namespace lacerta

#endif  // LACERTA_PLUGIN_C_BASE_READER_H_
