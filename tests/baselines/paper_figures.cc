// Rate-distortion points of the coders of the paper's comparison on one mesh, as CSV: paper_figures [--base N]
// [--levels N] [--coder NAME] [--samples N] [--lowest RATE] FILE... What the columns mean is in docs/results/paper_figures.md, which
// tests/bench/paper_figures makes of them.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "baselines/coders.h"
#include "baselines/remeshes.h"
#include "baselines/single_rate.h"
#include "baselines/transform.h"
#include "draco/normal_mesh_candidate.h"
#include "lacerta/clean.h"
#include "lacerta/mesh_file.h"
#include "lacerta/surface_distance.h"

namespace lacerta::baselines {
namespace {

struct Options {
  uint32_t base_vertices = 200;
  int levels = 5;
  std::string coder;  // this curve alone; empty: all
  uint64_t remesh_samples = 0;  // of the distances to the remesh; 0: as many as these take
  double lowest_rate = 0.25;    // b/iv
};

constexpr double kHighestRate = 5.0;      // b/iv, of the figures
constexpr double kHighestModelRate = 20;  // of Table I
constexpr uint64_t kSamples = 100'000;
// Table I is about differences below a thousandth at high rates, and of percents at low ones.
constexpr uint64_t kFewRemeshSamples = 300'000, kManyRemeshSamples = 1'000'000;
constexpr double kManySamplesFrom = 2.0;  // b/iv
// PGC and NMC may spend fewer planes on the coordinates that hardly move the surface. See README.md.
constexpr double kTangentialScale = 0.25;

// Mean squared distance of vertices from where they were, squared model units.
double VertexError(const std::vector<Vec3f>& decoded, const std::vector<Vec3f>& exact) {
  double squares = 0;
  for (size_t v = 0; v < exact.size(); ++v) squares += SquaredNorm(Vec3Cast<double>(decoded[v] - exact[v]));
  return squares / static_cast<double>(exact.size());
}

// One mesh and how coders are measured on it.
class Comparison {
 public:
  Comparison(std::string name, const TriangleMesh& input, const Remeshes& remeshes,
             const SurfaceDistanceMeter& to_input, const Options& options)
      : name_(std::move(name)), options_(options), input_(input), remeshes_(remeshes), to_input_(to_input) {}

  // The finest level of a mesh over the common base.
  TriangleMesh Finest(const std::vector<Vec3f>& positions) const {
    SemiRegularMesh mesh = remeshes_.normal.mesh;
    mesh.positions = positions;
    return MeshAtLevel(mesh, mesh.num_levels).value();
  }

  struct CurveOptions {
    const char* coder;
    const char* remesh;                   // name of what is coded
    const std::vector<Vec3f>& positions;  // of it
    double first_parameter, ratio;        // every parameter is `ratio` times the last one
    double highest_rate = kHighestRate;
    bool against_remesh = false;  // measure the distance to the remesh too, Table I
  };
  // Codes with one parameter after the other until the highest rate is reached, and prints a row for each.
  Status Curve(const CurveOptions& curve, const std::function<StatusOr<CodedMesh>(double)>& code) const {
    if (!options_.coder.empty() && options_.coder != curve.coder) return Status();
    const TriangleMesh unquantized = Finest(curve.positions);
    LACERTA_ASSIGN_OR_RETURN(const SurfaceDistanceMeter to_remesh, SurfaceDistanceMeter::Create(unquantized));
    LACERTA_ASSIGN_OR_RETURN(const double limit, PsnrOf(unquantized));
    double rate = 0;
    for (double parameter = curve.first_parameter; rate < curve.highest_rate; parameter *= curve.ratio) {
      LACERTA_ASSIGN_OR_RETURN(const CodedMesh coded, code(parameter));
      rate = 8.0 * static_cast<double>(coded.bytes) / static_cast<double>(input_.positions.size());
      if (rate < options_.lowest_rate) continue;
      const TriangleMesh decoded = Finest(coded.positions);
      LACERTA_ASSIGN_OR_RETURN(const double psnr, PsnrOf(decoded));
      SurfaceDistance moved;
      if (curve.against_remesh) {
        const uint64_t enough = rate < kManySamplesFrom ? kFewRemeshSamples : kManyRemeshSamples;
        const uint64_t samples = options_.remesh_samples > 0 ? options_.remesh_samples : enough;
        LACERTA_ASSIGN_OR_RETURN(moved, to_remesh.Measure(decoded, SurfaceDistanceOptions::RmsOnly(samples)));
      }
      const double diagonal = to_input_.diagonal();
      std::printf("%s,%s,%s,%.6g,%zu,%.5f,%.4f,%.3f,%.8g,%.8g,%.8g\n", name_.c_str(), curve.coder, curve.remesh,
                  parameter, coded.bytes, rate, psnr, limit, moved.forward.rms / diagonal,
                  moved.backward.rms / diagonal, VertexError(coded.positions, curve.positions) / (diagonal * diagonal));
      std::fflush(stdout);
    }
    return Status();
  }

  // The original mesh at single rates.
  Status SingleRates() const {
    if (!options_.coder.empty() && options_.coder != "tg") return Status();
    for (const int bits : {6, 7, 8, 9, 10, 11, 12}) {
      LACERTA_ASSIGN_OR_RETURN(const SingleRateMesh coded, CodeSingleRate(input_, bits));
      LACERTA_ASSIGN_OR_RETURN(const double psnr, PsnrOf(coded.mesh));
      std::printf("%s,tg,none,%d,%zu,%.5f,%.4f,%.3f,0,0,0\n", name_.c_str(), bits, coded.bytes,
                  8.0 * static_cast<double>(coded.bytes) / static_cast<double>(input_.positions.size()), psnr,
                  kMaxPsnr);
    }
    return Status();
  }

 private:
  StatusOr<double> PsnrOf(const TriangleMesh& mesh) const {
    LACERTA_ASSIGN_OR_RETURN(const SurfaceDistance d,
                             to_input_.Measure(mesh, SurfaceDistanceOptions::RmsOnly(kSamples)));
    return Psnr(d.Rms(), to_input_.diagonal());
  }

  std::string name_;
  const Options options_;
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
  const Comparison comparison(std::filesystem::path(path).stem().string(), cleaned.mesh, remeshes, meter,
                              options);
  const double diagonal = meter.diagonal();
  const double first_lambda = 3e-9 * diagonal * diagonal, lambda_ratio = std::pow(10.0, -0.4);
  const double first_threshold = 8e-2 * diagonal, threshold_ratio = std::sqrt(0.5);

  // On the normal mesh, and on the fitted one for the default mode, which is made for that.
  const std::vector<Vec3f>& normal = remeshes.normal.mesh.positions;
  const NormalMeshCandidate pierced(remeshes.base, remeshes.normal), fitted(remeshes.base, remeshes.fitted);
  LACERTA_RETURN_IF_ERROR(
      comparison.Curve({"paper", "normal", normal, first_lambda, lambda_ratio, kHighestModelRate, true},
                       Product(pierced, EncodeMode::kPaper)));
  LACERTA_RETURN_IF_ERROR(
      comparison.Curve({"default", "fitted", remeshes.fitted.mesh.positions, first_lambda, lambda_ratio},
                       Product(fitted, EncodeMode::kDefault)));
  const auto num_base = static_cast<uint32_t>(remeshes.base.mesh.lattice.size());
  const std::vector<Triangle>& triangles = remeshes.base.mesh.triangles;
  const auto zerotrees = [&](const Transform& transform, const Decomposition& parts, double tangential_scale) {
    return [&, tangential_scale](double threshold) {
      return CodeWithZerotrees(remeshes.base, transform, parts, {threshold, tangential_scale});
    };
  };
  LACERTA_ASSIGN_OR_RETURN(const auto butterfly, MakeButterflyTransform(num_base, triangles, options.levels));
  LACERTA_ASSIGN_OR_RETURN(const Decomposition normal_parts, butterfly->Analyze(normal));
  LACERTA_RETURN_IF_ERROR(comparison.Curve({"nmc", "normal", normal, first_threshold, threshold_ratio},
                                           zerotrees(*butterfly, normal_parts, kTangentialScale)));
  LACERTA_RETURN_IF_ERROR(comparison.Curve({"nmc_full", "normal", normal, first_threshold, threshold_ratio},
                                           zerotrees(*butterfly, normal_parts, 1.0)));

  const std::vector<Vec3f>& maps = remeshes.maps.positions;
  LACERTA_ASSIGN_OR_RETURN(const auto loop, MakeLoopTransform(num_base, triangles, options.levels));
  LACERTA_ASSIGN_OR_RETURN(const Decomposition maps_parts, loop->Analyze(maps));
  LACERTA_RETURN_IF_ERROR(comparison.Curve({"pgc", "maps", maps, first_threshold, threshold_ratio},
                                           zerotrees(*loop, maps_parts, kTangentialScale)));
  LACERTA_RETURN_IF_ERROR(comparison.SingleRates());
  return comparison.Curve({"maps", "maps", maps, first_lambda, lambda_ratio},
                          [&](double lambda) { return CodeWithModel(remeshes.base, *loop, maps_parts, lambda); });
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
    } else if (word == "--coder" && i + 1 < argc) {
      options.coder = argv[++i];
    } else if (word == "--samples" && i + 1 < argc) {
      options.remesh_samples = static_cast<uint64_t>(std::atoll(argv[++i]));
    } else if (word == "--lowest" && i + 1 < argc) {
      options.lowest_rate = std::atof(argv[++i]);
    } else if (const lacerta::Status status = lacerta::baselines::Compare(word, options); !status.ok()) {
      std::fprintf(stderr, "%s: %s\n", word.c_str(), status.message().c_str());
      ++failures;
    }
  }
  return failures > 0;
}
