#include "pack/large_shape.h"

#include <utility>

#include "draco/memory_plan.h"
#include "lacerta/codec.h"
#include "pack/single_mesh.h"

namespace lacerta {
namespace {

bool IsBare(const FileMesh& mesh) {
  return mesh.mesh.attributes.empty() && mesh.materials.empty() && mesh.group_materials == std::vector<uint32_t>{FileMesh::kNoMaterial};
}

// Of positions and indices in core glTF.
uint64_t PlainBytes(const TriangleMesh& mesh) {
  const uint64_t bytes_of_index = mesh.positions.size() < 0xffff ? 2 : 4;
  return sizeof(Vec3f) * mesh.positions.size() + 3 * bytes_of_index * mesh.triangles.size();
}

}  // namespace

StatusOr<bool> IsLargeShape(const FileMesh& mesh, const PackOptions& options) {
  if (!IsBare(mesh)) return false;
  LACERTA_ASSIGN_OR_RETURN(const MemoryPlan plan, PlanMemory(mesh.mesh.surface.positions.size(), mesh.mesh.surface.triangles.size(), options.encode.memory));
  return plan.is_lean;
}

StatusOr<LargeShape> PlanLargeShape(FileMesh mesh, const std::string& name, const PackOptions& options) {
  TriangleMesh surface = std::move(mesh.mesh.surface);
  mesh.mesh = {};
  const TriangleMesh place_holder{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  LargeShape shape{SingleMeshDocument(place_holder, name, mesh.origin), std::vector<PrimitivePlan>(1)};
  PrimitivePlan& plan = shape.plans[0];
  plan.places = plan.geometries = {Place()};
  plan.weight = 1;
  plan.report.name = name;
  plan.report.bytes_before = PlainBytes(surface);
  LACERTA_ASSIGN_OR_RETURN(EncodedMesh encoded, EncodeMesh(std::move(surface), options.encode));
  TakeStream(std::move(encoded), options.encode.target, &plan);
  return shape;
}

}  // namespace lacerta
