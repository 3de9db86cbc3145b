#include "draco/attributed_stream.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "common/base_tags.h"
#include "common/glued_base.h"
#include "common/octahedral.h"
#include "common/stream_layout.h"
#include "draco/attributed_base_codec.h"
#include "draco/base_mesh_codec.h"
#include "draco/base_weights.h"
#include "encoder/attribute_quantizer.h"
#include "encoder/coefficient_descent.h"
#include "encoder/level_order.h"
#include "encoder/quantizer.h"
#include "encoder/step_law.h"
#include "encoder/stream_writer.h"
#include "encoder/surface_target.h"
#include "geometry/value_difference.h"

namespace lacerta {
namespace {

// Of the base, for an error over the surface: base values are few, and what they are off spreads over many finer ones.
AttributeLattice PrecisionFor(const LevelAttribute& a, double error, bool is_four) {
  AttributeLattice p{a.name, a.kind, a.components, 0.0f, 0};
  if (a.kind == AttributeKind::kNormal) {
    constexpr double kDegreesOfOneBit = 92.0;
    p.octahedral_bits = std::clamp(static_cast<int>(std::ceil(std::log2(kDegreesOfOneBit / error))), 4, 12);
    return p;
  }
  float largest = 0;
  for (const float v : a.values) largest = std::max(largest, std::fabs(v));
  constexpr double kStepOverError = 1.5;
  constexpr float kMostLatticePoint = 65535.0f;  // times a step of 8 bits it is exact in float
  const double unit = a.kind == AttributeKind::kTangent ? error / kDegreesPerRadian : error;
  if (a.kind == AttributeKind::kWeights && is_four) {
    p.step = WeightStep(kStepOverError * unit);
    return p;
  }
  p.step = ShortStep(std::max({static_cast<float>(kStepOverError * unit), 1.01f * largest / kMostLatticePoint, 1e-30f}));
  return p;
}

Status CheckShapes(const AttributedNormalMesh& mesh, const AttributedStreamOptions& options) {
  const size_t num_faces = mesh.surface.mesh.base_triangles.size();
  if (!(options.lambda > 0)) return InvalidArgument("lambda must be positive");
  if (options.errors.size() != mesh.attributes.size()) return InvalidArgument("errors and attributes are not as many");
  if (!mesh.base_groups.empty() && mesh.base_groups.size() != num_faces) return InvalidArgument("groups and base triangles are not as many");
  for (size_t i = 0; i < mesh.attributes.size(); ++i) {
    const LevelAttribute& a = mesh.attributes[i];
    if (!(options.errors[i] > 0)) return InvalidArgument("the error of attribute " + a.name + " must be positive");
    if (!HasLegalComponents({a.name, a.kind, a.components}) || a.base_corners.size() != num_faces || a.num_values() < a.num_base_values)
      return InvalidArgument("attribute " + a.name + " has not the shape that its base tells");
    if (!std::all_of(a.values.begin(), a.values.end(), [](float x) { return std::isfinite(x); }))
      return InvalidArgument("attribute " + a.name + " has values that are not finite");
    if (a.kind == AttributeKind::kWeights && !options.joints.empty() && options.joints.size() != a.components)
      return InvalidArgument("joints and components of attribute " + a.name + " are not as many");
    for (const Triangle& corners : a.base_corners) {
      const bool any = std::any_of(corners.begin(), corners.end(), [](uint32_t r) { return r == MeshAttribute::kNoValue; });
      const bool all = std::all_of(corners.begin(), corners.end(), [](uint32_t r) { return r == MeshAttribute::kNoValue; });
      if (any != all || (!any && *std::max_element(corners.begin(), corners.end()) >= a.num_base_values))
        return InvalidArgument("a base corner of attribute " + a.name + " refers to a value that is not there");
    }
  }
  return Status();
}

void AppendIntegers(const AttributeLattice& p, const float* row, bool is_four, std::vector<int32_t>* values) {
  if (p.kind == AttributeKind::kWeights && is_four) {
    AppendRoundedWeights(row, p.components, p.step, values);
    return;
  }
  if (p.octahedral_bits > 0) {
    const auto point = OctahedralFromNormal({row[0], row[1], row[2]}, p.octahedral_bits);
    values->insert(values->end(), point.begin(), point.end());
    return;
  }
  for (uint32_t c = 0; c < p.components; ++c) values->push_back(static_cast<int32_t>(std::lround(row[c] / p.step)));
}

// On a lattice of that step, or of one so much finer that points which stand apart still do: triangles hang together by their places, and
// Draco leaves out those that have collapsed.
BaseMesh LatticeThatKeepsApart(const TriangleMesh& base, double step) {
  constexpr int kMostHalvings = 12;
  std::map<std::array<float, 3>, uint32_t> first_at;
  std::vector<uint32_t> first;
  for (const Vec3f& p : base.positions) first.push_back(first_at.emplace(std::array<float, 3>{p.x, p.y, p.z}, static_cast<uint32_t>(first.size())).first->second);
  BaseMesh lattice = RoundToLattice(base, static_cast<float>(step));
  for (int i = 0; i < kMostHalvings && FirstAtSamePoint(lattice.lattice) != first; ++i) {
    step /= 2;
    lattice = RoundToLattice(base, static_cast<float>(step));
  }
  return lattice;
}

// The base on its lattices, triangles by groups; order: which triangle of the mesh each one is.
StatusOr<AttributedBase> BaseOf(const AttributedNormalMesh& mesh, const AttributedStreamOptions& options, std::vector<uint32_t>* order) {
  const SemiRegularMesh& surface = mesh.surface.mesh;
  const std::vector<Vec3f> positions(surface.positions.begin(), surface.positions.begin() + surface.num_base_vertices);
  const BaseMesh lattice = LatticeThatKeepsApart({positions, surface.base_triangles}, BaseStepForSlope(options.lambda, surface.num_base_vertices));
  const uint32_t num_groups = mesh.base_groups.empty() ? 1 : *std::max_element(mesh.base_groups.begin(), mesh.base_groups.end()) + 1;
  if (num_groups > surface.base_triangles.size()) return InvalidArgument("there are groups without a triangle");
  AttributedBase base;
  base.mesh.step = lattice.step;
  base.group_sizes.assign(num_groups, 0);
  for (size_t i = 0; i < mesh.attributes.size(); ++i)
    base.attributes.push_back({PrecisionFor(mesh.attributes[i], options.errors[i], !options.joints.empty()),
                               {},
                               std::vector<uint8_t>(num_groups, 0)});
  for (uint32_t f = 0; f < surface.base_triangles.size(); ++f) order->push_back(f);
  const auto group_of = [&](uint32_t f) { return mesh.base_groups.empty() ? 0u : mesh.base_groups[f]; };
  std::stable_sort(order->begin(), order->end(), [&](uint32_t a, uint32_t b) { return group_of(a) < group_of(b); });
  std::map<std::vector<uint32_t>, uint32_t> vertices;  // by group, position and rows
  for (const uint32_t f : *order) {
    const uint32_t group = group_of(f);
    ++base.group_sizes[group];
    for (size_t a = 0; a < mesh.attributes.size(); ++a) {
      const bool has = mesh.attributes[a].base_corners[f][0] != MeshAttribute::kNoValue;
      uint8_t& in_group = base.attributes[a].in_group[group];
      if (base.group_sizes[group] > 1 && has != (in_group != 0)) return InvalidArgument("a group has the attribute " + mesh.attributes[a].name + " on some triangles only");
      in_group = has;
    }
    Triangle triangle;
    for (size_t k = 0; k < 3; ++k) {
      std::vector<uint32_t> key = {group, surface.base_triangles[f][k]};
      for (const LevelAttribute& a : mesh.attributes) key.push_back(a.base_corners[f][k]);
      const auto [at, is_new] = vertices.emplace(std::move(key), static_cast<uint32_t>(vertices.size()));
      triangle[k] = at->second;
      if (!is_new) continue;
      base.mesh.lattice.push_back(lattice.lattice[surface.base_triangles[f][k]]);
      for (size_t a = 0; a < mesh.attributes.size(); ++a) {
        const LevelAttribute& attribute = mesh.attributes[a];
        BaseAttribute& to = base.attributes[a];
        if (attribute.base_corners[f][k] != MeshAttribute::kNoValue)
          AppendIntegers(to.precision, &attribute.values[size_t{attribute.base_corners[f][k]} * attribute.components],
                         !options.joints.empty(), &to.values);
        to.values.resize(base.mesh.lattice.size() * to.numbers_per_value());
      }
    }
    base.mesh.triangles.push_back(triangle);
  }
  return base;
}

// A mesh in the order of its coded and glued base.
struct Reordered {
  NormalMesh surface;
  std::vector<std::vector<float>> values;  // of each attribute, rows of all levels
};

template <typename T>
std::vector<T> Pick(const std::vector<T>& from, const std::vector<uint32_t>& rows, size_t row_size = 1) {
  std::vector<T> result;
  result.reserve(rows.size() * row_size);
  for (const uint32_t row : rows) {
    const auto first = from.begin() + static_cast<ptrdiff_t>(row * row_size);
    result.insert(result.end(), first, first + static_cast<ptrdiff_t>(row_size));
  }
  return result;
}

// Joined borders are those that the coded base has, whatever was joined before.
std::vector<uint32_t> JoinedBorders(const BaseMesh& base, BaseTags tags) {
  tags.joined = FirstAtSamePoint(base.lattice);
  const StatusOr<Topology> t = BuildTopology(static_cast<uint32_t>(base.lattice.size()), base.triangles, tags);
  if (!t.ok()) return {};
  const bool any = std::any_of(t.value().master.begin(), t.value().master.end(), [](uint32_t m) { return m != kNone; });
  return any ? tags.joined : std::vector<uint32_t>();
}

StatusOr<Reordered> Reorder(const AttributedNormalMesh& mesh, const GluedBase& glued, const std::vector<FaceSource>& faces) {
  const SemiRegularMesh& from = mesh.surface.mesh;
  Reordered result;
  SemiRegularMesh& to = result.surface.mesh;
  to.base_triangles = glued.mesh.triangles;
  to.num_base_vertices = static_cast<uint32_t>(glued.mesh.lattice.size());
  to.num_levels = from.num_levels;
  for (size_t f = 0; f < faces.size() && !from.tags.still.empty(); ++f) to.tags.still.push_back(from.tags.still[faces[f].face]);
  const LevelOrder order{to.base_triangles, from.base_triangles, to.num_base_vertices, from.num_base_vertices, faces, to.tags.still};
  LACERTA_ASSIGN_OR_RETURN(const std::vector<uint32_t> rows, SourceRows(order, from.num_levels));
  if (!from.tags.crease.empty()) {
    LACERTA_ASSIGN_OR_RETURN(const std::vector<uint32_t> edges, SourceEdges(order));
    to.tags.crease = Pick(from.tags.crease, edges);
  }
  const std::vector<uint32_t> base_rows(rows.begin(), rows.begin() + to.num_base_vertices);
  if (!from.tags.corner.empty()) to.tags.corner = Pick(from.tags.corner, base_rows);
  to.tags.joined = JoinedBorders(glued.mesh, to.tags);
  to.positions = Pick(from.positions, rows);
  result.surface.surface_normals = Pick(mesh.surface.surface_normals, rows);
  for (size_t v = to.num_base_vertices; v < rows.size(); ++v) result.surface.piercing.push_back(mesh.surface.piercing[rows[v] - from.num_base_vertices]);
  result.surface.keeps_vertices = mesh.surface.keeps_vertices;
  for (size_t a = 0; a < mesh.attributes.size(); ++a) {
    const LevelAttribute& source = mesh.attributes[a];
    const LevelAttribute& coded = glued.attributes[a];
    const LevelOrder wedges{coded.base_corners, source.base_corners, coded.num_base_values, source.num_base_values, faces, to.tags.still};
    StatusOr<std::vector<uint32_t>> value_rows = SourceRows(wedges, from.num_levels);
    if (!value_rows.ok()) return value_rows.status().WithContext("attribute " + source.name);
    const uint32_t most = value_rows.value().empty() ? 0 : *std::max_element(value_rows.value().begin(), value_rows.value().end());
    if (most >= source.num_values()) return InvalidArgument("attribute " + source.name + " has not the values of all levels");
    result.values.push_back(Pick(source.values, value_rows.value(), source.components));
  }
  return result;
}

// values: as in Reordered, of the attributes of `decoded`, whose own are the base's.
void Refit(const AttributedStreamOptions& options, AttributedSemiRegularMesh decoded, std::vector<std::vector<float>>* values) {
  for (size_t a = 0; a < values->size(); ++a) decoded.attributes[a].values = std::move((*values)[a]);
  options.refit(&decoded);
  for (size_t a = 0; a < values->size(); ++a) (*values)[a] = std::move(decoded.attributes[a].values);
}

CodedSurface CodePositions(const SurfaceTarget& target, const BaseMesh& base, const AttributedStreamOptions& options) {
  const std::vector<double> scales = DetailScales(target);
  const int last = options.last_detailed > 0 ? std::min(options.last_detailed, target.num_levels()) : LastDetailedLevel(target, scales, options.lambda);
  DescentOptions descent;
  descent.lambda = options.lambda;
  descent.passes = options.passes;
  descent.move_base = false;  // its order hangs on the very integers
  return Descend(target, QuantizeClosedLoop(target, base, StepsForSlope(target, last, options.lambda)), descent);
}

}  // namespace

size_t AttributedStream::size() const {
  size_t sum = refinement.size() + bytes_beside;
  for (const Bytes& b : bases) sum += b.size();
  return sum;
}

StatusOr<NormalMesh> AsNormalMesh(SemiRegularMesh surface) {
  LACERTA_ASSIGN_OR_RETURN(const TriangleMesh finest, MeshAtLevel(surface, surface.num_levels));
  NormalMesh result;
  result.surface_normals.assign(finest.positions.size(), Vec3f{});
  for (const Triangle& t : finest.triangles) {
    const Vec3f area = Cross(finest.positions[t[1]] - finest.positions[t[0]], finest.positions[t[2]] - finest.positions[t[0]]);
    for (const uint32_t v : t) result.surface_normals[v] += area;
  }
  for (Vec3f& n : result.surface_normals) {
    n = Normalized(n);
    if (n == Vec3f{}) n = {0, 0, 1};
  }
  result.piercing.assign(finest.positions.size() - surface.num_base_vertices, PiercingKind::kClosest);
  result.mesh = std::move(surface);
  return result;
}

StatusOr<AttributedStream> EncodeAttributedStream(const AttributedNormalMesh& mesh, const AttributedStreamOptions& options) {
  LACERTA_RETURN_IF_ERROR(CheckShapes(mesh, options));
  std::vector<uint32_t> by_group;
  LACERTA_ASSIGN_OR_RETURN(const AttributedBase given, BaseOf(mesh, options, &by_group));
  LACERTA_ASSIGN_OR_RETURN(CodedAttributedBase coded_base, EncodeAttributedBase(given, options.joints));
  for (FaceSource& f : coded_base.faces) f.face = by_group[f.face];
  LACERTA_ASSIGN_OR_RETURN(const GluedBase glued, GlueBase(coded_base.base));
  LACERTA_ASSIGN_OR_RETURN(Reordered reordered, Reorder(mesh, glued, coded_base.faces));
  const BaseTags& tags = reordered.surface.mesh.tags;
  LACERTA_ASSIGN_OR_RETURN(const std::vector<Topology> topologies, BuildTopologies(glued.mesh, reordered.surface.mesh.num_levels, tags));

  const SurfaceTarget target = MakeSurfaceTarget(reordered.surface);
  const CodedSurface coded = CodePositions(target, glued.mesh, options);
  AttributedStream stream;
  stream.decoded.surface = {glued.mesh.triangles, reordered.surface.mesh.num_base_vertices, target.num_levels(), Synthesize(target, coded), tags};
  stream.decoded.base_groups = glued.groups;
  stream.decoded.attributes = glued.attributes;
  if (options.refit) Refit(options, stream.decoded, &reordered.values);
  WrittenAttributes written{BaseChecksum(coded_base.base), {}, {}};
  for (size_t a = 0; a < glued.attributes.size(); ++a) {
    const std::vector<Triangle> corners = WithoutStill(glued.attributes[a].base_corners, tags.still);
    LACERTA_ASSIGN_OR_RETURN(
        AttributeTarget attribute,
        MakeAttributeTarget(coded_base.base.attributes[a].precision, corners, glued.attributes[a].values,
                            reordered.values[a], topologies, stream.decoded.surface.positions));
    if (options.factors) {
      AttributedSemiRegularMesh wanted = stream.decoded;
      wanted.attributes[a].values = reordered.values[a];
      attribute.factors = options.factors(wanted, a);
    }
    CodedAttribute best = EncodeAttribute(attribute, options.errors[a], topologies, stream.decoded.surface.positions);
    stream.errors.push_back(AttributeRmsError(attribute, best.decoded));
    stream.residual_bytes.push_back(static_cast<size_t>(AttributeBits(attribute, best) / 8));
    stream.decoded.attributes[a].values = best.decoded;
    LACERTA_ASSIGN_OR_RETURN(AttributeWedges wedges, MakeAttributeWedges(corners, glued.attributes[a].num_base_values));
    written.wedges.push_back(std::move(wedges));
    written.coded.push_back(std::move(best));
  }
  LACERTA_ASSIGN_OR_RETURN(RefinementBytes refinement,
                           WriteRefinement(glued.mesh, topologies, coded.steps, coded.levels, tags, BaseStepField::kWritten, &written));
  stream.bases = std::move(coded_base.streams);
  stream.refinement = std::move(refinement.bytes);
  stream.part_sizes = std::move(refinement.part_sizes);
  stream.base = std::move(coded_base.base);
  if (options.beside) stream.bytes_beside = static_cast<size_t>(options.beside(stream.base));
  return stream;
}

}  // namespace lacerta
