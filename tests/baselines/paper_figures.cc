// Rate-distortion points of the coders of the paper's comparison on one mesh, as CSV: paper_figures [--base N] [--levels N] FILE...
// What the columns mean is in docs/results/paper_figures.md, which tests/bench/paper_figures makes of them.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "baselines/coders.h"
#include "baselines/remeshes.h"
#include "baselines/transform.h"
#include "draco/normal_mesh_candidate.h"
#include "lacerta/clean.h"
#include "lacerta/mesh_file.h"
#include "lacerta/surface_distance.h"

namespace lacerta::baselines {
namespace {

struct Options {
  uint32_t base_vertices = 250;
  int levels = 5;
};

constexpr double kLowestRate = 0.2, kHighestRate = 16.0;  // b/iv
constexpr uint64_t kSamples = 200'000;
constexpr uint64_t kRemeshSamples = 1'000'000;  // Table I is about differences below a thousandth

// One mesh and how coders are measured on it.
class Comparison {
 public:
  Comparison(std::string name, const TriangleMesh& input, const Remeshes& remeshes, const SurfaceDistanceMeter& to_input)
      : name_(std::move(name)), input_(input), remeshes_(remeshes), to_input_(to_input) {}

  // The finest level of a mesh over the common base.
  TriangleMesh Finest(const std::vector<Vec3f>& positions) const {
    SemiRegularMesh mesh = remeshes_.normal.mesh;
    mesh.positions = positions;
    return MeshAtLevel(mesh, mesh.num_levels).value();
  }

  // A curve: codes with parameters from first_parameter on, each `ratio` times the last one, until the highest rate is reached.
  // remesh: what is coded.
  Status Curve(const char* coder, const char* remesh_name, const std::vector<Vec3f>& remesh, double first_parameter, double ratio,
               const std::function<StatusOr<CodedMesh>(double)>& code) const {
    if (const char* only = std::getenv("ONLY"); only && std::string(coder).rfind(only, 0) != 0) return Status();
    const TriangleMesh unquantized = Finest(remesh);
    LACERTA_ASSIGN_OR_RETURN(const SurfaceDistanceMeter to_remesh, SurfaceDistanceMeter::Create(unquantized));
    LACERTA_ASSIGN_OR_RETURN(const double limit, PsnrOf(unquantized));
    const uint64_t samples = std::string(coder) == "paper" ? kRemeshSamples : kSamples / 10;
    double rate = 0;
    for (double parameter = first_parameter; rate < kHighestRate; parameter *= ratio) {
      LACERTA_ASSIGN_OR_RETURN(const CodedMesh coded, code(parameter));
      rate = 8.0 * static_cast<double>(coded.bytes) / static_cast<double>(input_.positions.size());
      if (rate < kLowestRate) continue;
      const TriangleMesh decoded = Finest(coded.positions);
      LACERTA_ASSIGN_OR_RETURN(const double psnr, PsnrOf(decoded));
      LACERTA_ASSIGN_OR_RETURN(const SurfaceDistance moved, to_remesh.Measure(decoded, SurfaceDistanceOptions::RmsOnly(samples)));
      double squares = 0;
      for (size_t v = 0; v < remesh.size(); ++v) squares += SquaredNorm(Vec3Cast<double>(coded.positions[v] - remesh[v]));
      const double diagonal = to_input_.diagonal();
      std::printf("%s,%s,%s,%.6g,%zu,%.5f,%.4f,%.3f,%.8g,%.8g,%.8g\n", name_.c_str(), coder, remesh_name, parameter, coded.bytes, rate, psnr,
                  limit, moved.forward.rms / diagonal, moved.backward.rms / diagonal,
                  squares / static_cast<double>(remesh.size()) / (diagonal * diagonal));
      std::fflush(stdout);
    }
    return Status();
  }

 private:
  StatusOr<double> PsnrOf(const TriangleMesh& mesh) const {
    LACERTA_ASSIGN_OR_RETURN(const SurfaceDistance d, to_input_.Measure(mesh, SurfaceDistanceOptions::RmsOnly(kSamples)));
    return Psnr(d.Rms(), to_input_.diagonal());
  }

  std::string name_;
  const TriangleMesh& input_;
  const Remeshes& remeshes_;
  const SurfaceDistanceMeter& to_input_;
};

std::function<StatusOr<CodedMesh>(double)> Product(const NormalMeshCandidate& candidate, EncodeMode mode) {
  return [&candidate, mode](double lambda) -> StatusOr<CodedMesh> {
    LACERTA_ASSIGN_OR_RETURN(CodedStream stream, candidate.Code(lambda, mode));
    return CodedMesh{stream.size(), std::move(stream.decoded.positions)};
  };
}

Status Compare(const std::string& path, const Options& options) {
  LACERTA_ASSIGN_OR_RETURN(const TriangleMesh mesh, ReadMeshFile(path));
  LACERTA_ASSIGN_OR_RETURN(const CleanedMesh cleaned, Clean(mesh));
  LACERTA_ASSIGN_OR_RETURN(const Remeshes remeshes, MakeRemeshes(cleaned.mesh, options.base_vertices, options.levels));
  LACERTA_ASSIGN_OR_RETURN(const SurfaceDistanceMeter meter, SurfaceDistanceMeter::Create(cleaned.mesh));
  const Comparison comparison(std::filesystem::path(path).stem().string(), cleaned.mesh, remeshes, meter);
  const double diagonal = meter.diagonal();
  const double first_lambda = 1e-8 * diagonal * diagonal, first_threshold = 1e-2 * diagonal;
  const double lambda_ratio = std::pow(0.1, 1.0 / 3), threshold_ratio = std::pow(0.5, 1.0 / 3);

  const std::vector<Vec3f>& normal = remeshes.normal.mesh.positions;
  const auto num_base = static_cast<uint32_t>(remeshes.base.mesh.lattice.size());
  const std::vector<Triangle>& triangles = remeshes.base.mesh.triangles;
  LACERTA_ASSIGN_OR_RETURN(const auto butterfly, MakeButterflyTransform(num_base, triangles, options.levels));
  LACERTA_ASSIGN_OR_RETURN(const auto loop, MakeLoopTransform(num_base, triangles, options.levels));

  const NormalMeshCandidate pierced(remeshes.base, remeshes.normal), fitted(remeshes.base, remeshes.fitted);
  LACERTA_RETURN_IF_ERROR(comparison.Curve("paper", "normal", normal, first_lambda, lambda_ratio, Product(pierced, EncodeMode::kPaper)));
  LACERTA_RETURN_IF_ERROR(comparison.Curve("default", "fitted", fitted.normal_mesh().mesh.positions, first_lambda, lambda_ratio,
                                           Product(fitted, EncodeMode::kDefault)));
  const auto zerotrees = [&](const Transform& transform, const Decomposition& decomposition, double tangential_scale) {
    return [&, tangential_scale](double threshold) {
      return CodeWithZerotrees(remeshes.base, transform, decomposition, {threshold, tangential_scale});
    };
  };
  LACERTA_ASSIGN_OR_RETURN(const Decomposition normal_details, butterfly->Analyze(normal));
  for (const double scale : {1.0, 0.5, 0.25}) {
    LACERTA_RETURN_IF_ERROR(comparison.Curve(("nmc" + std::to_string(scale)).c_str(), "normal", normal, first_threshold, threshold_ratio,
                                             zerotrees(*butterfly, normal_details, scale)));
  }
  const std::vector<Vec3f>& maps = remeshes.maps.positions;
  LACERTA_ASSIGN_OR_RETURN(const Decomposition maps_details, loop->Analyze(maps));
  for (const double scale : {1.0, 0.5, 0.25}) {
    LACERTA_RETURN_IF_ERROR(comparison.Curve(("pgc" + std::to_string(scale)).c_str(), "maps", maps, first_threshold, threshold_ratio,
                                             zerotrees(*loop, maps_details, scale)));
  }
  LACERTA_RETURN_IF_ERROR(comparison.Curve("maps_model_loop", "maps", maps, first_lambda, lambda_ratio, [&](double lambda) {
    return CodeWithModel(remeshes.base, *loop, maps_details, lambda);
  }));
  LACERTA_ASSIGN_OR_RETURN(const Decomposition maps_butterfly, butterfly->Analyze(maps));
  return comparison.Curve("maps_model_butterfly", "maps", maps, first_lambda, lambda_ratio, [&](double lambda) {
    return CodeWithModel(remeshes.base, *butterfly, maps_butterfly, lambda);
  });
}

}  // namespace
}  // namespace lacerta::baselines

int main(int argc, char** argv) {
  lacerta::baselines::Options options;
  std::printf("mesh,coder,remesh,parameter,bytes,bpv,psnr,remesh_psnr,forward,backward,vertex_mse\n");
  int failures = 0;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--base" && i + 1 < argc) {
      options.base_vertices = static_cast<uint32_t>(std::atoi(argv[++i]));
    } else if (word == "--levels" && i + 1 < argc) {
      options.levels = std::atoi(argv[++i]);
    } else if (const lacerta::Status status = lacerta::baselines::Compare(word, options); !status.ok()) {
      std::fprintf(stderr, "%s: %s\n", word.c_str(), status.message().c_str());
      ++failures;
    }
  }
  return failures > 0;
}
