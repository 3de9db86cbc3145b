// An asset of two primitives that touch and carry attributes, packed as one stream, made once.
#ifndef LACERTA_TESTS_GLTF_TORUS_ASSET_H_
#define LACERTA_TESTS_GLTF_TORUS_ASSET_H_

#include "gltf/test_assets.h"
#include "lacerta/gltf.h"
#include "shapes/attributed_shapes.h"

namespace lacerta::testing {

inline Json AddSoup(const VertexSoup& soup, AssetBuilder* builder) {
  Json primitive = builder->Primitive({soup.positions, soup.triangles});
  for (const VertexSoup::Attribute& attribute : soup.attributes) {
    primitive["attributes"][attribute.name] =
        AddAccessor(MakeAccessor(MakeFloatAccessor(attribute.values, attribute.components), AccessorUse::kAttribute, false,
                                 &builder->document()),
                    &builder->document());
  }
  return primitive;
}

// A torus of two primitives, with a texture and normals.
inline Bytes Torus() {
  AssetBuilder builder;
  Json primitives = Json::array();
  for (const VertexSoup& half : shapes::HalvedTorus(96, 48)) primitives.push_back(AddSoup(half, &builder));
  builder.document().json["materials"] = Json::array({{{"name", "red"}}});  // without numbers that might be an accessor's
  builder.AddMesh("torus", std::move(primitives));
  return builder.Glb();
}

inline const PackResult& PackedTorus() {
  static const PackResult* const kResult = [] {
    PackOptions options;
    options.encode.target = {EncodeTarget::Kind::kPsnr, 65.0};
    options.encode.levels = LevelChoice::kAlways;
    return new PackResult(PackGltf(Torus(), options).value());
  }();
  return *kResult;
}

}  // namespace lacerta::testing

#endif  // LACERTA_TESTS_GLTF_TORUS_ASSET_H_
