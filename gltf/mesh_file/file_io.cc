#include "lacerta/file_io.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>
#include <random>
#include <system_error>

#if defined(__unix__) || defined(__APPLE__)
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace lacerta {
namespace {

namespace fs = std::filesystem;

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, FileCloser>;

std::string Reason() { return std::strerror(errno); }

// Closes the file as well: on many file systems a full disk shows only then.
Status WriteAll(File file, Span<const uint8_t> bytes, const std::string& path) {
  const size_t written = bytes.empty() ? 0 : std::fwrite(bytes.data(), 1, bytes.size(), file.get());
  const bool complete = written == bytes.size();
  if (std::fclose(file.release()) != 0 || !complete) {
    return IoError(path + ": writing failed (" + Reason() +
                   "); check the free space and the permissions of the folder");
  }
  return Status();
}

}  // namespace

StatusOr<Bytes> ReadFile(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) return NotFound(path + ": no such file");
  if (fs::is_directory(status)) return IoError(path + ": is a directory; name a file in it");
  const File file(std::fopen(path.c_str(), "rb"));
  if (file == nullptr) return IoError(path + ": cannot be opened (" + Reason() + ")");
  Bytes bytes;
  if (fs::is_regular_file(status)) {
    const auto size = fs::file_size(path, error);
    if (!error) bytes.reserve(static_cast<size_t>(size));
  }
  uint8_t chunk[1 << 16];
  while (const size_t count = std::fread(chunk, 1, sizeof(chunk), file.get())) {
    bytes.insert(bytes.end(), chunk, chunk + count);
  }
  if (std::ferror(file.get()) != 0) return IoError(path + ": reading failed (" + Reason() + ")");
  return bytes;
}

StatusOr<FileBytes> FileBytes::Open(const std::string& path, uint64_t map_from) {
#if defined(__unix__) || defined(__APPLE__)
  std::error_code error;
  const auto size = fs::is_regular_file(path, error) ? fs::file_size(path, error) : 0;
  if (!error && size >= map_from && size > 0) {
    const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) return IoError(path + ": cannot be opened (" + Reason() + ")");
    void* const mapped = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file, 0);
    close(file);
    if (mapped != MAP_FAILED) {
      FileBytes result;
      result.mapped_ = static_cast<const uint8_t*>(mapped);
      result.mapped_size_ = size;
      return result;
    }
  }
#else
  (void)map_from;
#endif
  LACERTA_ASSIGN_OR_RETURN(Bytes bytes, ReadFile(path));
  return FileBytes(std::move(bytes));
}

#if defined(__unix__) || defined(__APPLE__)
FileBytes::~FileBytes() {
  if (is_mapped()) munmap(const_cast<uint8_t*>(mapped_), mapped_size_);
}

void FileBytes::PassTo(const uint8_t* end) const {
  const std::less<> before;
  if (!is_mapped() || before(end, mapped_) || before(mapped_ + mapped_size_, end)) return;
  const auto page = static_cast<size_t>(sysconf(_SC_PAGESIZE));
  madvise(const_cast<uint8_t*>(mapped_), static_cast<size_t>(end - mapped_) / page * page, MADV_DONTNEED);
}
#else
FileBytes::~FileBytes() = default;
void FileBytes::PassTo(const uint8_t*) const {}
#endif

Status WriteFileAtomically(const std::string& path, Span<const uint8_t> bytes) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) return IoError(path + ": is a directory; name a file in it");
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    File file(std::fopen(path.c_str(), "wb"));
    if (file == nullptr) return IoError(path + ": cannot be opened for writing (" + Reason() + ")");
    return WriteAll(std::move(file), bytes, path);
  }
  const std::string temporary = path + ".partial-" + std::to_string(std::random_device()());
  File file(std::fopen(temporary.c_str(), "wbx"));
  if (file == nullptr) {
    return IoError(path + ": cannot be created (" + Reason() + "); check that the folder exists and may be written to");
  }
  Status written = WriteAll(std::move(file), bytes, path);
  if (written.ok()) {
    fs::rename(temporary, path, error);
    if (error) written = IoError(path + ": cannot be replaced (" + error.message() + ")");
  }
  if (!written.ok()) fs::remove(temporary, error);
  return written;
}

}  // namespace lacerta
