#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

#include "commands.h"
#include "exit_code.h"
#include "lacerta/mesh_file.h"
#include "lacerta/surface_distance.h"
#include "report.h"

namespace lacerta::cli {
namespace {

struct CompareArguments {
  std::string original;
  std::string other;
  uint64_t samples = SurfaceDistanceOptions().num_samples;
  bool json = false;
};

void Print(const SurfaceDistance& distance, double diagonal, bool json) {
  const double psnr = Psnr(distance.Rms(), diagonal);
  if (json) {
    PrintJson({{"diagonal", NumberOrNull(diagonal)},
               {"forward", {{"rms", distance.forward.rms}, {"max", distance.forward.max}}},
               {"backward", {{"rms", distance.backward.rms}, {"max", distance.backward.max}}},
               {"distance", distance.Rms()},
               {"hausdorff", distance.Hausdorff()},
               {"psnr", NumberOrNull(psnr)}});
    return;
  }
  std::printf("RMS A to B   %s\n", Short(distance.forward.rms, 6).c_str());
  std::printf("RMS B to A   %s\n", Short(distance.backward.rms, 6).c_str());
  std::printf("distance     %s  (larger of the two; %s of the diagonal)\n", Short(distance.Rms(), 6).c_str(),
              Short(distance.Rms() / diagonal, 4).c_str());
  std::printf("Hausdorff    %s  (sampled)\n", Short(distance.Hausdorff(), 6).c_str());
  std::printf("diagonal     %s  (of A)\n", Short(diagonal, 6).c_str());
  std::printf("PSNR         %s dB\n", Fixed(psnr, 2).c_str());
}

Status RunCompare(const CompareArguments& arguments) {
  LACERTA_ASSIGN_OR_RETURN(TriangleMesh original, ReadMeshFile(arguments.original));
  const Vec3d origin = FarOrigin(original);
  if (origin != Vec3d{}) {
    LACERTA_ASSIGN_OR_RETURN(original, ReadMeshFile(arguments.original, origin));
  }
  LACERTA_ASSIGN_OR_RETURN(const TriangleMesh other, ReadMeshFile(arguments.other, origin));
  constexpr size_t kLarge = 2'000'000;  // triangles
  const StatusOr<SurfaceDistanceMeter> meter =
      original.triangles.size() > kLarge ? SurfaceDistanceMeter::CreateLean(original) : SurfaceDistanceMeter::Create(original);
  if (!meter.ok()) return meter.status().WithContext(arguments.original);
  SurfaceDistanceOptions options;
  options.num_samples = arguments.samples;
  const StatusOr<SurfaceDistance> distance = meter.value().Measure(other, options);
  if (!distance.ok()) return distance.status().WithContext(arguments.other);
  Print(distance.value(), meter.value().diagonal(), arguments.json);
  return Status();
}

}  // namespace

void AddCompareCommand(CLI::App* app, int* exit_code) {
  const auto arguments = std::make_shared<CompareArguments>();
  CLI::App* compare = app->add_subcommand("compare", "Measure the distance between two surfaces, both ways");
  compare->add_option("A", arguments->original, "The original; its diagonal is the peak of the PSNR")->required();
  compare->add_option("B", arguments->other, "The mesh to judge; packed files at their finest level")->required();
  compare->add_option("--samples", arguments->samples, "Points on each surface")->check(Positive());
  compare->add_flag("--json", arguments->json, "Print as JSON");
  compare->footer(kExitCodeHelp);
  compare->callback([arguments, exit_code] { *exit_code = Finish(RunCompare(*arguments)); });
}

}  // namespace lacerta::cli
