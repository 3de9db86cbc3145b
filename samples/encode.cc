// Turns a mesh file into a progressive stream: encode IN OUT.drc [PSNR in dB]
#include <lacerta/codec.h>
#include <lacerta/file_io.h>
#include <lacerta/mesh_file.h>

#include <cstdio>
#include <cstdlib>

namespace {

int Fail(const lacerta::Status& status) {
  std::fprintf(stderr, "encode: %s\n", status.message().c_str());
  return 1;
}

void Print(const lacerta::EncodeReport& report) {
  if (!report.reason.empty()) std::printf("note: %s\n", report.reason.c_str());
  for (size_t level = 0; level < report.levels.size(); ++level) {
    const lacerta::LevelReport& at = report.levels[level];
    std::printf("level %zu: %llu triangles in the first %llu bytes, %.2f dB\n", level,
                static_cast<unsigned long long>(at.triangles), static_cast<unsigned long long>(at.bytes), at.psnr);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3 || argc > 4) {
    std::fprintf(stderr, "usage: encode IN.ply|obj|off|stl|glb OUT.drc [PSNR]\n");
    return 2;
  }
  const lacerta::StatusOr<lacerta::TriangleMesh> mesh = lacerta::ReadMeshFile(argv[1]);
  if (!mesh.ok()) return Fail(mesh.status());

  lacerta::EncodeOptions options;
  options.target = {lacerta::EncodeTarget::Kind::kPsnr, argc > 3 ? std::atof(argv[3]) : 70.0};
  const lacerta::StatusOr<lacerta::EncodedMesh> encoded = lacerta::EncodeMesh(mesh.value(), options);
  if (!encoded.ok()) return Fail(encoded.status());

  const lacerta::Status written = lacerta::WriteFileAtomically(argv[2], encoded.value().stream);
  if (!written.ok()) return Fail(written);
  Print(encoded.value().report);
  return 0;
}
