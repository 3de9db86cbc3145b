// The C functions: arguments are checked, one lock is taken, statuses become codes and messages, and nothing is thrown.
#include "lacerta.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base_reader.h"
#include "caller_allocator.h"
#include "caller_data.h"
#include "stream_decoder.h"

using lacerta::CallerAllocator;
using lacerta::Status;
using lacerta::StatusCode;

struct lacerta_decoder {
  lacerta_decoder(const lacerta::StreamDecoder::Options& options, const CallerAllocator<uint8_t>& allocator)
      : stream(options, allocator), memory(allocator) {}

  std::mutex mutex;
  lacerta::StreamDecoder stream;
  std::string message;
  CallerAllocator<uint8_t> memory;
};

namespace {

constexpr lacerta_allocator kDefaultAllocator = {[](void*, size_t size) { return std::malloc(size); },
                                                 [](void*, void* memory, size_t) { std::free(memory); }, nullptr};

lacerta_result ResultOf(StatusCode code) {
  switch (code) {
    case StatusCode::kOk: return LACERTA_OK;
    case StatusCode::kInvalidArgument: return LACERTA_INVALID_ARGUMENT;
    case StatusCode::kInvalidData: return LACERTA_INVALID_DATA;
    case StatusCode::kUnsupported: return LACERTA_UNSUPPORTED;
    case StatusCode::kLimitExceeded: return LACERTA_LIMIT_EXCEEDED;
    default: return LACERTA_INTERNAL;
  }
}

// Runs `call`, which returns a result, and turns what it throws into one.
template <typename Call>
lacerta_result Guarded(const Call& call) noexcept {
#ifdef __cpp_exceptions
  try {
    return call();
  } catch (const std::bad_alloc&) {
    return LACERTA_OUT_OF_MEMORY;
  } catch (...) {
    return LACERTA_INTERNAL;
  }
#else
  return call();
#endif
}

// Keeps the message of a status.
lacerta_result Told(const Status& status, lacerta_decoder* decoder) {
  decoder->message = status.message();
  return ResultOf(status.code());
}

// Runs `call`, which returns a Status, with the decoder locked, and keeps its message.
template <typename Call>
lacerta_result Locked(lacerta_decoder* decoder, const Call& call) noexcept {
  if (decoder == nullptr) return LACERTA_INVALID_ARGUMENT;
  return Guarded([&] {
    const std::lock_guard<std::mutex> lock(decoder->mutex);
    decoder->message.clear();
    const lacerta_result result = Guarded([&] { return Told(call(), decoder); });
    if (result == LACERTA_OUT_OF_MEMORY) decoder->message = "out of memory";  // short: needs none
    return result;
  });
}

lacerta_result NeedsBaseOr(lacerta_result result, lacerta_decoder* decoder) {
  if (result != LACERTA_OK) return result;
  const std::lock_guard<std::mutex> lock(decoder->mutex);
  return decoder->stream.needs_base() ? LACERTA_NEEDS_BASE : LACERTA_OK;
}

// Whether a struct of the caller is one of this version or newer. All fields so far are of the first version, but for the options'.
template <typename Struct>
bool IsSized(const Struct* value) {
  return value != nullptr && value->struct_size >= sizeof(Struct);
}
constexpr size_t kFirstOptionsSize = offsetof(lacerta_decoder_options, base_lengths);

Status BadStruct(const char* name) {
  return lacerta::InvalidArgument(std::string(name) + " is NULL or its struct_size is not set; use the macro beside the struct");
}

std::optional<size_t> GroupOf(uint32_t group) {
  return group == LACERTA_ALL_GROUPS ? std::nullopt : std::optional<size_t>(group);
}

}  // namespace

uint32_t lacerta_version(void) { return LACERTA_VERSION_MAJOR << 16 | LACERTA_VERSION_MINOR << 8 | LACERTA_VERSION_PATCH; }

int32_t lacerta_has_draco(void) { return lacerta::CanReadStockBase() ? 1 : 0; }

const char* lacerta_result_name(lacerta_result result) {
  switch (result) {
    case LACERTA_OK: return "ok";
    case LACERTA_INVALID_ARGUMENT: return "invalid argument";
    case LACERTA_INVALID_DATA: return "invalid data";
    case LACERTA_UNSUPPORTED: return "unsupported";
    case LACERTA_LIMIT_EXCEEDED: return "limit exceeded";
    case LACERTA_OUT_OF_MEMORY: return "out of memory";
    case LACERTA_INTERNAL: return "internal error";
    case LACERTA_NEEDS_BASE: return "needs base";
    default: return "unknown result";
  }
}

lacerta_result lacerta_decoder_create(const lacerta_decoder_options* options, lacerta_decoder** decoder) {
  if (decoder == nullptr) return LACERTA_INVALID_ARGUMENT;
  *decoder = nullptr;
  lacerta_decoder_options given = LACERTA_DECODER_OPTIONS_INIT;
  if (options != nullptr) {
    if (options->struct_size < kFirstOptionsSize) return LACERTA_INVALID_ARGUMENT;
    std::memcpy(&given, options, std::min<size_t>(options->struct_size, sizeof(given)));
  }
  options = &given;
  const lacerta_allocator& allocator = options->allocator != nullptr ? *options->allocator : kDefaultAllocator;
  if (allocator.allocate == nullptr || allocator.deallocate == nullptr) return LACERTA_INVALID_ARGUMENT;
  lacerta::StreamDecoder::Options stream;
  if (options->max_level >= 0) stream.refinement.max_level = options->max_level;
  if (options->max_vertices != 0) stream.refinement.limits.max_vertices = options->max_vertices;
  if (options->max_triangles != 0) stream.refinement.limits.max_triangles = options->max_triangles;
  stream.base_size = options->base_size;
  return Guarded([&] {
    if (!lacerta::ReadGroupOptions(*options, &stream.groups, &stream.base_size)) return LACERTA_INVALID_ARGUMENT;
    void* memory = allocator.allocate(allocator.user, sizeof(lacerta_decoder));
    if (memory == nullptr) return LACERTA_OUT_OF_MEMORY;
    *decoder = new (memory) lacerta_decoder(stream, CallerAllocator<uint8_t>(allocator));
    return LACERTA_OK;
  });
}

void lacerta_decoder_destroy(lacerta_decoder* decoder) {
  if (decoder == nullptr) return;
  CallerAllocator<uint8_t> memory = decoder->memory;
  decoder->~lacerta_decoder();
  memory.deallocate(reinterpret_cast<uint8_t*>(decoder), sizeof(lacerta_decoder));
}

lacerta_result lacerta_decoder_append(lacerta_decoder* decoder, const void* bytes, size_t size, int32_t* level) {
  const lacerta_result result = Locked(decoder, [&] {
    if (bytes == nullptr && size != 0) return lacerta::InvalidArgument("bytes is NULL");
    const Status status = decoder->stream.Append({static_cast<const uint8_t*>(bytes), size});
    if (level != nullptr) *level = decoder->stream.level();
    return status;
  });
  return NeedsBaseOr(result, decoder);
}

lacerta_result lacerta_decoder_finish(lacerta_decoder* decoder, int32_t* level) {
  const lacerta_result result = Locked(decoder, [&] {
    const Status status = decoder->stream.Finish();
    if (level != nullptr) *level = decoder->stream.level();
    return status;
  });
  return NeedsBaseOr(result, decoder);
}

lacerta_result lacerta_decoder_set_base(lacerta_decoder* decoder, const float* positions, uint32_t num_vertices,
                                        const uint32_t* indices, uint32_t num_triangles) {
  return Locked(decoder, [&] {
    lacerta::TriangleMesh base;
    LACERTA_RETURN_IF_ERROR(lacerta::ReadBase(positions, num_vertices, indices, num_triangles, &base.positions, &base.triangles));
    return decoder->stream.SetBase(std::move(base));
  });
}

lacerta_result lacerta_decoder_set_base_group(lacerta_decoder* decoder, uint32_t group, const lacerta_base_group* base) {
  return Locked(decoder, [&]() -> Status {
    if (!IsSized(base)) return BadStruct("base");
    LACERTA_ASSIGN_OR_RETURN(lacerta::VertexSoup soup, lacerta::ReadBaseGroup(*base, decoder->stream.attribute_names()));
    return decoder->stream.SetBaseGroup(group, std::move(soup));
  });
}

lacerta_result lacerta_decoder_base_section(lacerta_decoder* decoder, const uint8_t** bytes, size_t* size) {
  return Locked(decoder, [&] {
    if (bytes == nullptr || size == nullptr) return lacerta::InvalidArgument("bytes or size is NULL");
    const lacerta::Span<const uint8_t> section = decoder->stream.base_section();
    *bytes = section.data();
    *size = section.size();
    return section.empty() ? lacerta::InvalidArgument("the decoder does not ask for a base") : Status();
  });
}

lacerta_result lacerta_decoder_get_progress(lacerta_decoder* decoder, lacerta_progress* progress) {
  return Locked(decoder, [&] {
    if (!IsSized(progress)) return BadStruct("progress");
    const lacerta::StreamDecoder& stream = decoder->stream;
    progress->level = stream.level();
    progress->num_levels = stream.num_levels();
    progress->state = stream.state();
    progress->has_layers = stream.has_layers() ? 1 : 0;
    progress->is_complete = stream.is_complete() ? 1 : 0;
    progress->bytes_used = stream.bytes_used();
    progress->num_groups = static_cast<uint32_t>(stream.num_groups());
    progress->num_attributes = static_cast<uint32_t>(stream.attribute_names().size());
    return Status();
  });
}

size_t lacerta_decoder_message(lacerta_decoder* decoder, char* text, size_t size) {
  if (decoder == nullptr) return 0;
  const std::lock_guard<std::mutex> lock(decoder->mutex);
  if (text != nullptr && size > 0) {
    const size_t length = std::min(size - 1, decoder->message.size());
    std::memcpy(text, decoder->message.data(), length);
    text[length] = '\0';
  }
  return decoder->message.size();
}

lacerta_result lacerta_decoder_get_attribute(lacerta_decoder* decoder, uint32_t index, lacerta_attribute* attribute) {
  return Locked(decoder, [&] {
    if (!IsSized(attribute)) return BadStruct("attribute");
    const std::vector<std::string>& names = decoder->stream.attribute_names();
    if (index >= names.size()) return lacerta::InvalidArgument("attribute " + std::to_string(index) + " is not there; the stream has " + std::to_string(names.size()));
    attribute->components = decoder->stream.components_of(index);
    std::memcpy(attribute->name, names[index].c_str(), names[index].size() + 1);
    return Status();
  });
}

lacerta_result lacerta_decoder_get_mesh_size(lacerta_decoder* decoder, int32_t level, uint32_t group, lacerta_mesh_size* mesh_size) {
  return Locked(decoder, [&]() -> Status {
    if (!IsSized(mesh_size)) return BadStruct("mesh_size");
    LACERTA_ASSIGN_OR_RETURN(const lacerta::LevelView view, decoder->stream.ViewOf(level, GroupOf(group)));
    mesh_size->num_vertices = static_cast<uint32_t>(view.positions.size());
    mesh_size->num_triangles = static_cast<uint32_t>(view.triangles.size());
    mesh_size->attributes = 0;
    const std::vector<std::string>& names = decoder->stream.attribute_names();
    for (size_t i = 0; i < names.size(); ++i) mesh_size->attributes |= uint32_t{lacerta::AttributeOf(view, names[i]) != nullptr} << i;
    return Status();
  });
}

lacerta_result lacerta_decoder_read_mesh(lacerta_decoder* decoder, int32_t level, uint32_t group, const lacerta_mesh_buffers* buffers) {
  return Locked(decoder, [&]() -> Status {
    if (!IsSized(buffers)) return BadStruct("buffers");
    return lacerta::WriteMesh(&decoder->stream, level, GroupOf(group), *buffers);
  });
}

lacerta_result lacerta_decode_prefix(const void* bytes, size_t size, const lacerta_decoder_options* options, lacerta_decoder** decoder) {
  const lacerta_result created = lacerta_decoder_create(options, decoder);
  if (created != LACERTA_OK) return created;
  int32_t level = -1;
  lacerta_result result = lacerta_decoder_append(*decoder, bytes, size, &level);
  if (result == LACERTA_OK) result = lacerta_decoder_finish(*decoder, &level);
  if (level < 0 && result != LACERTA_OK && result != LACERTA_NEEDS_BASE) {
    lacerta_decoder_destroy(*decoder);
    *decoder = nullptr;
  }
  return result;
}
