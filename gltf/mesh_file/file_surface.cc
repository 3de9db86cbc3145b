#include "mesh_file/file_surface.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <utility>

#include "decoder/smooth_normals.h"
#include "document/normals.h"

namespace lacerta {
namespace {

constexpr uint32_t kNone = MeshAttribute::kNoValue;
constexpr const char* kRepaired = "repaired: ";  // notes on the shape itself

bool HasAll(const Triangle& corners) { return std::find(corners.begin(), corners.end(), kNone) == corners.end(); }

// Faces have an attribute at all corners or at none. Why it cannot be used; empty where it can.
std::string Trouble(MeshAttribute* attribute) {
  for (size_t f = 0; f < attribute->corners.size(); ++f) {
    Triangle& corners = attribute->corners[f];
    if (!HasAll(corners)) corners = {kNone, kNone, kNone};
    for (const uint32_t row : corners) {
      if (row == kNone) continue;
      if (row >= attribute->num_values()) {
        return "triangle " + std::to_string(f) + " has value " + std::to_string(row) + " of " + std::to_string(attribute->num_values()) +
               " (counted from 0)";
      }
      for (uint32_t c = 0; c < attribute->components; ++c) {
        if (!std::isfinite(attribute->values[row * attribute->components + c])) return "value " + std::to_string(row) + " is not finite";
      }
    }
  }
  return "";
}

bool IsUsed(const MeshAttribute& attribute) { return std::any_of(attribute.corners.begin(), attribute.corners.end(), HasAll); }

Vec3f NormalAt(const MeshAttribute& normals, uint32_t row) {
  const float* const n = &normals.values[size_t{3} * row];
  return {n[0], n[1], n[2]};
}

// glTF wants unit vectors. Writers leave zeros where they could not tell.
void MakeUnit(const TriangleMesh& surface, MeshAttribute* normals) {
  std::vector<Vec3f> smooth;
  for (size_t f = 0; f < normals->corners.size(); ++f) {
    for (size_t i = 0; i < 3; ++i) {
      uint32_t& row = normals->corners[f][i];
      if (row == kNone || Norm(Vec3Cast<double>(NormalAt(*normals, row))) > 0) continue;
      if (smooth.empty()) smooth = SmoothNormals(surface.positions, surface.triangles);
      const Vec3f& normal = smooth[surface.triangles[f][i]];
      row = normals->num_values();
      normals->values.insert(normals->values.end(), {normal.x, normal.y, normal.z});
    }
  }
  for (uint32_t row = 0; row < normals->num_values(); ++row) {
    const Vec3d normal = Vec3Cast<double>(NormalAt(*normals, row));
    const Vec3d unit = Norm(normal) > 0 ? Normalized(normal) : Vec3d{0, 0, 1};
    for (int axis = 0; axis < 3; ++axis) normals->values[3 * row + static_cast<uint32_t>(axis)] = static_cast<float>(unit[axis]);
  }
}

// IEC 61966-2-1.
float LinearOf(float screen) {
  const double s = std::clamp(static_cast<double>(screen), 0.0, 1.0);
  return static_cast<float>(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
}

// Three components where all is opaque.
void MakeLinear(MeshAttribute* colors) {
  const uint32_t components = colors->components;
  bool is_opaque = components == 4;
  for (uint32_t row = 0; row < colors->num_values() && is_opaque; ++row) is_opaque = colors->values[4 * row + 3] >= 1;
  const uint32_t kept = is_opaque ? 3 : components;
  std::vector<float> values;
  values.reserve(size_t{kept} * colors->num_values());
  for (uint32_t row = 0; row < colors->num_values(); ++row) {
    for (uint32_t c = 0; c < kept; ++c) {
      const float value = colors->values[row * components + c];
      values.push_back(c < 3 ? LinearOf(value) : std::clamp(value, 0.0f, 1.0f));
    }
  }
  colors->components = kept;
  colors->values = std::move(values);
}

CornerValues Values(const char* name, AttributeKind kind, uint32_t components) {
  CornerValues values;
  values.attribute.name = name;
  values.attribute.kind = kind;
  values.attribute.components = components;
  return values;
}

// What shows a texture was meant to show it as it is, and glTF would multiply the two.
void LeaveOutColorsBelowTextures(const std::vector<uint32_t>& triangle_materials, FileMesh* file) {
  MeshAttribute* colors = nullptr;
  const MeshAttribute* texture = nullptr;
  for (MeshAttribute& attribute : file->mesh.attributes) {
    if (attribute.kind == AttributeKind::kColor) colors = &attribute;
    if (attribute.kind == AttributeKind::kTextureCoordinates) texture = &attribute;
  }
  if (colors == nullptr || texture == nullptr || triangle_materials.empty()) return;
  bool is_any = false;
  for (size_t f = 0; f < triangle_materials.size(); ++f) {
    const uint32_t material = triangle_materials[f];
    const bool is_below = material != FileMesh::kNoMaterial && file->materials[material].base_color_image && HasAll(texture->corners[f]);
    if (is_below) colors->corners[f] = {kNone, kNone, kNone};
    is_any = is_any || is_below;
  }
  if (!is_any) return;
  file->notes.push_back("COLOR_0 is left aside where a texture is shown, which has the colors");
  if (!IsUsed(*colors)) file->mesh.attributes.erase(file->mesh.attributes.begin() + (colors - file->mesh.attributes.data()));
}

// The value that all faces have; empty where they do not.
std::vector<float> TheOnlyValue(const MeshAttribute& attribute) {
  const auto at = [&](uint32_t row) { return attribute.values.begin() + static_cast<std::ptrdiff_t>(size_t{row} * attribute.components); };
  const uint32_t first = attribute.corners[0][0];
  for (const Triangle& corners : attribute.corners) {
    for (const uint32_t row : corners) {
      if (row == kNone || first == kNone || !std::equal(at(row), at(row) + attribute.components, at(first))) return {};
    }
  }
  return {at(first), at(first) + attribute.components};
}

// What is the same everywhere need not lie on the surface, which is stored the better without: one color of all vertices, as many programs write
// it, is one of the material where there is no other, and white is none.
void TakeOffWhatIsTheSameEverywhere(std::vector<uint32_t>* triangle_materials, FileMesh* file) {
  std::vector<MeshAttribute> kept;
  for (MeshAttribute& attribute : file->mesh.attributes) {
    const std::vector<float> value = TheOnlyValue(attribute);
    const bool is_color = attribute.kind == AttributeKind::kColor;
    const bool is_white = std::all_of(value.begin(), value.end(), [](float component) { return component == 1; });
    const bool is_idle = is_color ? is_white || file->materials.empty()
                                  : attribute.kind == AttributeKind::kTextureCoordinates && file->images.empty();
    if (value.empty() || !is_idle) {
      kept.push_back(std::move(attribute));
    } else if (!is_color) {
      file->notes.push_back(attribute.name + " is left aside: it is the same everywhere");
    } else if (!is_white) {
      std::copy(value.begin(), value.end(), file->materials.emplace_back().base_color.begin());
      triangle_materials->assign(file->mesh.surface.triangles.size(), 0);
    }
  }
  file->mesh.attributes = std::move(kept);
}

// Normals of flat shading need not be stored.
void TakeOffFlatNormals(FileMesh* file) {
  std::vector<MeshAttribute>& attributes = file->mesh.attributes;
  const auto found = std::find_if(attributes.begin(), attributes.end(), [](const MeshAttribute& a) { return a.kind == AttributeKind::kNormal; });
  const bool has_maps = std::any_of(file->materials.begin(), file->materials.end(), [](const FileMaterial& m) { return m.normal_image.has_value(); });
  if (found == attributes.end() || has_maps) return;
  const TriangleMesh& surface = file->mesh.surface;
  const auto position_at = [&](uint32_t v) { return surface.positions[v]; };
  if (!NormalsAreFlat(surface.triangles, position_at, found->corners, [&](uint32_t row) { return NormalAt(*found, row); })) return;
  file->notes.emplace_back("NORMAL is left aside: it has the normals of the faces, which glTF shades by where there are none");
  attributes.erase(found);
}

// One group for each material and set of attributes, in the order of their first faces.
void GroupFaces(const std::vector<uint32_t>& triangle_materials, FileMesh* file) {
  AttributedMesh& mesh = file->mesh;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> groups;
  mesh.groups.reserve(mesh.surface.triangles.size());
  for (size_t f = 0; f < mesh.surface.triangles.size(); ++f) {
    uint32_t has = 0;  // a bit for each attribute
    for (size_t a = 0; a < mesh.attributes.size(); ++a) has |= static_cast<uint32_t>(HasAll(mesh.attributes[a].corners[f])) << a;
    const uint32_t material = triangle_materials.empty() ? FileMesh::kNoMaterial : triangle_materials[f];
    const auto [group, is_new] = groups.emplace(std::make_pair(material, has), static_cast<uint32_t>(groups.size()));
    if (is_new) file->group_materials.push_back(material);
    mesh.groups.push_back(group->second);
  }
}

}  // namespace

CornerValues TextureValues() { return Values("TEXCOORD_0", AttributeKind::kTextureCoordinates, 2); }
CornerValues NormalValues() { return Values("NORMAL", AttributeKind::kNormal, 3); }
CornerValues ColorValues(uint32_t components) { return Values("COLOR_0", AttributeKind::kColor, components); }

void AppendFan(const std::vector<uint32_t>& rows, std::vector<Triangle>* corners) {
  for (size_t i = 2; i < rows.size(); ++i) corners->push_back({rows[0], rows[i - 1], rows[i]});
}

void CountFromZeroToOne(MeshAttribute* colors) {
  if (std::none_of(colors->values.begin(), colors->values.end(), [](float value) { return value > 1; })) return;
  for (float& value : colors->values) value /= 255;
}

FileMesh ShapeOf(FileMesh mesh) {
  FileMesh shape;
  shape.mesh.surface = std::move(mesh.mesh.surface);
  shape.origin = mesh.origin;
  shape.group_materials = {FileMesh::kNoMaterial};
  std::copy_if(mesh.notes.begin(), mesh.notes.end(), std::back_inserter(shape.notes), [](const std::string& note) { return note.rfind(kRepaired, 0) == 0; });
  return shape;
}

Status RemoveNotFinite(FileSurface* surface) {
  TriangleMesh& mesh = surface->surface;
  const auto is_finite = [&](uint32_t v) {
    const Vec3f& p = mesh.positions[v];
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  };
  const size_t num_before = mesh.triangles.size();
  size_t kept = 0;
  for (size_t f = 0; f < num_before; ++f) {
    const Triangle t = mesh.triangles[f];
    if (!is_finite(t[0]) || !is_finite(t[1]) || !is_finite(t[2])) continue;
    mesh.triangles[kept] = t;
    for (CornerValues& values : surface->attributes) {
      if (!values.attribute.corners.empty()) values.attribute.corners[kept] = values.attribute.corners[f];
    }
    if (!surface->triangle_materials.empty()) surface->triangle_materials[kept] = surface->triangle_materials[f];
    ++kept;
  }
  if (kept == 0) return InvalidData("has no triangle with finite positions; it cannot be repaired");
  mesh.triangles.resize(kept);
  if (!surface->triangle_materials.empty()) surface->triangle_materials.resize(kept);
  uint64_t removed = 0;
  for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
    if (is_finite(v)) continue;
    mesh.positions[v] = mesh.positions[mesh.triangles[0][0]];
    ++removed;
  }
  uint64_t mended = 0;
  for (CornerValues& values : surface->attributes) {
    MeshAttribute& attribute = values.attribute;
    if (!attribute.corners.empty()) attribute.corners.resize(kept);
    for (size_t i = 0; attribute.kind == AttributeKind::kNormal && i < attribute.num_values(); ++i) {
      float* const normal = attribute.values.data() + 3 * i;
      if (std::isfinite(normal[0]) && std::isfinite(normal[1]) && std::isfinite(normal[2])) continue;
      std::fill(normal, normal + 3, 0.0f);  // which ToFileMesh takes for none
      ++mended;
    }
  }
  if (removed > 0) {
    surface->notes.push_back(kRepaired + std::to_string(removed) + " vertices without a finite position removed with " +
                             std::to_string(num_before - kept) + " triangles");
  }
  if (mended > 0) surface->notes.push_back(kRepaired + std::to_string(mended) + " normals that were not finite made from the surface");
  return Status();
}

FileMesh ToFileMesh(FileSurface surface, std::vector<FileMaterial> materials, std::vector<FileImage> images) {
  FileMesh file;
  file.mesh.surface = std::move(surface.surface);
  file.materials = std::move(materials);
  file.images = std::move(images);
  file.notes = std::move(surface.notes);
  for (CornerValues& values : surface.attributes) {
    MeshAttribute& attribute = values.attribute;
    if (!IsUsed(attribute)) continue;
    if (values.trouble.empty()) values.trouble = Trouble(&attribute);
    if (!values.trouble.empty()) {
      file.notes.push_back(attribute.name + " is left aside: " + values.trouble);
      continue;
    }
    for (float& value : attribute.values) value = std::isfinite(value) ? value : 0.0f;  // in rows that nothing uses
    if (attribute.kind == AttributeKind::kNormal) MakeUnit(file.mesh.surface, &attribute);
    if (attribute.kind == AttributeKind::kColor) MakeLinear(&attribute);
    file.mesh.attributes.push_back(std::move(attribute));
  }
  LeaveOutColorsBelowTextures(surface.triangle_materials, &file);
  TakeOffWhatIsTheSameEverywhere(&surface.triangle_materials, &file);
  TakeOffFlatNormals(&file);
  GroupFaces(surface.triangle_materials, &file);
  return file;
}

}  // namespace lacerta
