#include "pack/precision.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "lacerta/surface_distance.h"
#include "pack/attribute_error.h"

namespace lacerta {
namespace {

bool BeginsWith(const std::string& text, const char* prefix) { return text.rfind(prefix, 0) == 0; }

// The fewest bits in [least, most] with error_of(bits) <= target, by steps from `start`: the error falls with the bits.
int FewestBits(int start, int least, int most, double target, const std::function<double(int)>& error_of) {
  int bits = std::clamp(start, least, most);
  if (error_of(bits) <= target) {
    while (bits > least && error_of(bits - 1) <= target) --bits;
  } else {
    while (bits < most && error_of(bits) > target) ++bits;
  }
  return bits;
}

// Rounding to steps of range / 2^bits moves each of n components by an RMS of step / sqrt(12), and interpolation over a
// triangle halves the mean square.
int StartBits(double range, uint32_t components, double target) {
  const double step = target * std::sqrt(24.0 / components);
  return step > 0.0 ? static_cast<int>(std::ceil(std::log2(std::max(range / step, 2.0)))) : kMostLatticeBits;
}

struct Tolerance {
  double target = 0.0;
  double scale = 1.0;  // from the attribute's unit to that of the target
  bool direction = false;
  const char* unit = "";
};

std::optional<Tolerance> ToleranceOf(const Attribute& attribute, const AttributeTargets& targets,
                                     const std::function<double(uint64_t)>& texels_per_unit) {
  const std::string& name = attribute.name;
  if (attribute.data.type != ComponentType::kFloat) return std::nullopt;
  if (name == "NORMAL" && attribute.data.components == 3) return Tolerance{targets.normal_degrees, 1.0, true, "degrees"};
  if (name == "TANGENT" && attribute.data.components == 4) return Tolerance{targets.normal_degrees, 1.0, true, "degrees"};
  if (BeginsWith(name, "TEXCOORD_")) {
    const uint64_t set = std::strtoull(name.c_str() + std::char_traits<char>::length("TEXCOORD_"), nullptr, 10);
    return Tolerance{targets.uv_texels, texels_per_unit(set), false, "texels"};
  }
  const double components = std::sqrt(attribute.data.components);  // theirs are per component
  if (BeginsWith(name, "COLOR_")) return Tolerance{targets.color * components, 1.0, false, ""};
  if (BeginsWith(name, "WEIGHTS_")) return Tolerance{targets.weight * components, 1.0, false, ""};
  return std::nullopt;
}

bool IsFinite(const AccessorData& data) {
  for (uint64_t i = 0; i < data.count; ++i) {
    for (uint32_t c = 0; c < data.components; ++c) {
      if (!std::isfinite(data.Float(i, c))) return false;
    }
  }
  return true;
}

}  // namespace

AttributePrecision FindAttributeBits(const Primitive& primitive, const AttributeTargets& targets,
                                     const std::function<double(uint64_t set)>& texels_per_unit) {
  constexpr int kLeastOctahedralBits = 3;
  AttributePrecision precision;
  const TriangleMesh surface = Surface(primitive);
  for (const Attribute& attribute : primitive.attributes) {
    if (attribute.name == "POSITION") continue;
    const AccessorData& data = attribute.data;
    const std::optional<Tolerance> tolerance = ToleranceOf(attribute, targets, texels_per_unit);
    if (!tolerance.has_value() || !IsFinite(data)) {
      precision.reports.push_back({attribute.name, 0, 0.0, ""});
      continue;
    }
    const bool octahedral = attribute.name == "NORMAL";
    const auto error_of = [&](int bits) {
      const AccessorData rounded =
          octahedral ? RoundOctahedral(data, bits) : RoundToLattice(data, FitLattice(data, bits));
      return tolerance->scale *
             (tolerance->direction ? DirectionRms(surface, data, rounded) : SurfaceRms(surface, data, rounded));
    };
    const double radians = tolerance->target * 3.14159265358979323846 / 180.0;
    const double range = tolerance->direction ? 2.0 : FitLattice(data, 1).range;
    const int start = StartBits(range, data.components, tolerance->direction ? radians : tolerance->target / tolerance->scale);
    const int bits =
        FewestBits(start, octahedral ? kLeastOctahedralBits : 1, kMostLatticeBits, tolerance->target, error_of);
    const double error = error_of(bits);
    const bool meets = error <= tolerance->target;  // else only the exact values do
    if (meets) precision.bits[attribute.name] = bits;
    precision.reports.push_back({attribute.name, meets ? bits : 0, meets ? error : 0.0, tolerance->unit});
  }
  return precision;
}

SharedLattice FindPositionLattice(const TriangleMesh& surface, double error, int least_bits) {
  constexpr uint64_t kSamples = 100'000;
  constexpr double kMostFlipped = 5e-4;
  Vec3f min = surface.positions.empty() ? Vec3f{} : surface.positions[0];
  Vec3f max = min;
  for (const Vec3f& position : surface.positions) {
    for (int axis = 0; axis < 3; ++axis) {
      min[axis] = std::min(min[axis], position[axis]);
      max[axis] = std::max(max[axis], position[axis]);
    }
  }
  const StatusOr<SurfaceDistanceMeter> meter = SurfaceDistanceMeter::Create(surface);
  std::map<int, SharedLattice> measured;
  const auto at = [&](int bits) -> const SharedLattice& {
    const auto known = measured.find(bits);
    if (known != measured.end()) return known->second;
    SharedLattice result;
    result.lattice = PositionLattice(min, max, bits);
    TriangleMesh rounded = surface;
    double squares = 0.0;
    for (size_t v = 0; v < rounded.positions.size(); ++v) {
      Vec3f& position = rounded.positions[v];
      for (int axis = 0; axis < 3; ++axis) {
        const auto c = static_cast<uint32_t>(axis);
        position[axis] = result.lattice.At(result.lattice.Round(position[axis], c), c);
      }
      const Vec3f moved = position - surface.positions[v];
      squares += static_cast<double>(Dot(moved, moved));
    }
    result.flipped = FlippedShare(surface, rounded.positions);
    // What has no area, or loses all of it, is measured at its vertices.
    result.error = std::sqrt(squares / static_cast<double>(std::max<size_t>(rounded.positions.size(), 1)));
    if (meter.ok()) {
      const StatusOr<SurfaceDistance> distance =
          meter.value().Measure(rounded, SurfaceDistanceOptions::RmsOnly(kSamples));
      if (distance.ok()) result.error = distance.value().Rms();
    }
    return measured.emplace(bits, result).first->second;
  };
  const auto excess = [&](int bits) {
    const SharedLattice& lattice = at(bits);
    return std::max(lattice.error / error, lattice.flipped / kMostFlipped);
  };
  const Vec3f extent = max - min;
  const int start = StartBits(std::max({extent.x, extent.y, extent.z}), 1, error);
  return at(FewestBits(start, least_bits, kMostLatticeBits, 1.0, excess));
}

}  // namespace lacerta
