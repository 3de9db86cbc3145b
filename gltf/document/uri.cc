#include "document/uri.h"

#include <filesystem>

#include "lacerta/file_io.h"

namespace lacerta {
namespace {

int Base64Value(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+' || c == '-') return 62;
  if (c == '/' || c == '_') return 63;
  return -1;
}

StatusOr<Bytes> DecodeBase64(std::string_view text) {
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  Bytes bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  uint32_t bits = 0;
  int num_bits = 0;
  for (const char c : text) {
    const int value = Base64Value(c);
    if (value < 0) return InvalidData("a data URI is not valid base64");
    bits = (bits << 6 | static_cast<uint32_t>(value)) & 0xffffu;
    num_bits += 6;
    if (num_bits >= 8) {
      num_bits -= 8;
      bytes.push_back(static_cast<uint8_t>(bits >> num_bits));
    }
  }
  return bytes;
}

int HexValue(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string DecodePercent(std::string_view uri) {
  std::string text;
  for (size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && i + 2 < uri.size() && HexValue(uri[i + 1]) >= 0 && HexValue(uri[i + 2]) >= 0) {
      text.push_back(static_cast<char>(HexValue(uri[i + 1]) * 16 + HexValue(uri[i + 2])));
      i += 2;
    } else {
      text.push_back(uri[i]);
    }
  }
  return text;
}

}  // namespace

bool LeavesFolder(const std::filesystem::path& path) { return path.is_absolute() || path.empty() || *path.begin() == ".."; }

StatusOr<Bytes> LoadUri(std::string_view uri, const std::string& folder) {
  if (uri.substr(0, 5) == "data:") {
    const size_t comma = uri.find(',');
    if (comma == uri.npos || uri.substr(0, comma).find(";base64") == uri.npos) {
      return Unsupported("a data URI is not base64 encoded; only base64 is read");
    }
    return DecodeBase64(uri.substr(comma + 1));
  }
  const std::filesystem::path relative = DecodePercent(uri);
  const std::filesystem::path normal = relative.lexically_normal();
  if (LeavesFolder(normal) || uri.find(':') != uri.npos || relative.string().find('\0') != std::string::npos) {
    return Unsupported("the URI \"" + std::string(uri.substr(0, 80)) +
                       "\" does not name a file in the folder of the asset");
  }
  return ReadFile((std::filesystem::path(folder) / normal).string());
}

}  // namespace lacerta
