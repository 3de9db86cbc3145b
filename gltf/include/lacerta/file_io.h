// Whole files in and out.
#ifndef LACERTA_FILE_IO_H_
#define LACERTA_FILE_IO_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// All bytes of a file. Fails with kNotFound when there is none, kIoError when it cannot be read (a directory,
// permissions).
StatusOr<Bytes> ReadFile(const std::string& path);

// The bytes of a file, read or, where it is large and the system can, mapped: pages come as they are looked at and need not stay. Nobody may shorten
// such a file meanwhile. Not copied.
class FileBytes {
 public:
  // Fails as ReadFile does. map_from: files of so many bytes are mapped.
  static StatusOr<FileBytes> Open(const std::string& path, uint64_t map_from = uint64_t{32} << 20);

  FileBytes() = default;
  explicit FileBytes(Bytes bytes) : bytes_(std::move(bytes)) {}
  FileBytes(FileBytes&& other) noexcept { Swap(&other); }
  FileBytes& operator=(FileBytes&& other) noexcept {
    Swap(&other);
    return *this;
  }
  FileBytes(const FileBytes&) = delete;
  FileBytes& operator=(const FileBytes&) = delete;
  ~FileBytes();

  Span<const uint8_t> span() const { return is_mapped() ? Span<const uint8_t>(mapped_, mapped_size_) : Span<const uint8_t>(bytes_); }
  bool is_mapped() const { return mapped_ != nullptr; }
  // Lets go of the pages before `end`, a place in span(). They come again where they are looked at again.
  void PassTo(const uint8_t* end) const;

 private:
  void Swap(FileBytes* other) {
    std::swap(bytes_, other->bytes_);
    std::swap(mapped_, other->mapped_);
    std::swap(mapped_size_, other->mapped_size_);
  }

  Bytes bytes_;
  const uint8_t* mapped_ = nullptr;
  size_t mapped_size_ = 0;
};

// Writes all bytes under a temporary name in the same folder and renames it, so that `path` never holds half a file.
// Something that exists and is no regular file (/dev/null, a pipe) is written to directly. Fails with kIoError.
Status WriteFileAtomically(const std::string& path, Span<const uint8_t> bytes);

}  // namespace lacerta

#endif  // LACERTA_FILE_IO_H_
