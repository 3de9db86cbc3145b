// Shows a stream as a client sees it that is still downloading: decode_progressively IN.drc [OUT]
// Ever longer prefixes are decoded; with OUT each level is written to OUT_0.ply, OUT_1.ply, ... as soon as it is there.
#include <lacerta/codec.h>
#include <lacerta/file_io.h>
#include <lacerta/mesh_file.h>

#include <algorithm>
#include <cstdio>
#include <string>

namespace {

constexpr size_t kNumChunks = 32;  // that the stream arrives in

int Fail(const lacerta::Status& status) {
  std::fprintf(stderr, "decode_progressively: %s\n", status.message().c_str());
  return 1;
}

lacerta::Status Show(const lacerta::DecodedMesh& decoded, size_t received, const std::string& out) {
  std::printf("%zu bytes: level %d, %zu triangles\n", received, decoded.level, decoded.mesh.triangles.size());
  if (out.empty()) return {};
  return lacerta::WriteMeshFile(decoded.mesh, out + "_" + std::to_string(decoded.level) + ".ply");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    std::fprintf(stderr, "usage: decode_progressively IN.drc [OUT]\n");
    return 2;
  }
  const std::string out = argc > 2 ? argv[2] : "";
  const lacerta::StatusOr<lacerta::Bytes> file = lacerta::ReadFile(argv[1]);
  if (!file.ok()) return Fail(file.status());
  const lacerta::Span<const uint8_t> stream(file.value());

  const size_t chunk = stream.size() / kNumChunks + 1;
  int shown = -1;
  for (size_t received = std::min(chunk, stream.size());; received = std::min(received + chunk, stream.size())) {
    const bool complete = received == stream.size();
    const lacerta::StatusOr<lacerta::DecodedMesh> decoded = lacerta::DecodeMesh(stream.First(received), {});
    if (!decoded.ok() && complete) return Fail(decoded.status());  // until then, the base has not arrived yet
    if (decoded.ok() && decoded.value().level > shown) {
      shown = decoded.value().level;
      if (const lacerta::Status status = Show(decoded.value(), received, out); !status.ok()) return Fail(status);
    }
    if (complete) return decoded.value().refinement.ok() ? 0 : Fail(decoded.value().refinement);
  }
}
