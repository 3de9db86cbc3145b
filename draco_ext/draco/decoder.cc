#include <draco/compression/config/decoder_options.h>

#include <utility>

#include "draco/custom_form.h"
#include "draco/decode_mesh.h"
#include "draco/mesh_conversion.h"
#include "draco/mesh_decoder.h"
#include "draco/stock_stream.h"
#include "lacerta/draco.h"

namespace lacerta {

draco::StatusOr<std::unique_ptr<draco::Mesh>> Decoder::DecodeMeshFromBuffer(draco::DecoderBuffer* in_buffer) {
  level_ = 0;
  num_levels_ = 0;
  refinement_ = Status();
  if (const Status status = CheckDecodeOptions(options_); !status.ok()) return ToDracoStatus(status);
  const Span<const uint8_t> stream(reinterpret_cast<const uint8_t*>(in_buffer->data_head()),
                                   static_cast<size_t>(in_buffer->remaining_size()));
  if (IsCustomForm(stream)) {
    // The header is checked here because Draco's own check lets older bitstream versions through.
    if (const auto parts = SplitCustomForm(stream); !parts.ok()) return ToDracoStatus(parts.status());
    ProgressiveMeshDecoder decoder(options_);
    auto mesh = std::make_unique<draco::Mesh>();
    const draco::Status status = decoder.Decode(draco::DecoderOptions(), in_buffer, mesh.get());
    if (!decoder.status().ok()) return ToDracoStatus(decoder.status());
    if (!status.ok()) return status;
    level_ = decoder.level();
    num_levels_ = decoder.num_levels();
    refinement_ = decoder.refinement();
    return mesh;
  }
  StatusOr<StockMesh> stock = DecodeStockStream(stream, options_.limits);
  if (!stock.ok()) return ToDracoStatus(stock.status());
  StatusOr<TriangleMesh> base = FromDracoMesh(*stock.value().mesh);
  if (!base.ok()) return ToDracoStatus(base.status());
  const DecodedMesh decoded = RefineBase(std::move(base).value(), stream.Subspan(stock.value().bytes_used), options_);
  in_buffer->Advance(in_buffer->remaining_size());
  level_ = decoded.level;
  num_levels_ = decoded.num_levels;
  refinement_ = decoded.refinement;
  if (decoded.level == 0) return std::move(stock.value().mesh);
  return ToDracoMesh(decoded.mesh);
}

}  // namespace lacerta
