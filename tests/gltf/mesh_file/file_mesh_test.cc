#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <utility>

#include "gltf/test_assets.h"
#include "gltf/test_bytes.h"
#include "lacerta/gltf.h"
#include "lacerta/mesh_file.h"

namespace lacerta {
namespace {

using ::testing::ElementsAre;
using ::testing::FloatNear;
using testing::FromText;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

FileMesh Parse(const std::string& text, MeshFormat format, const std::string& folder = "no-such-folder") {
  StatusOr<FileMesh> mesh = ParseFileMesh(FromText(text), format, folder);
  EXPECT_TRUE(mesh.ok()) << mesh.status().message();
  return mesh.ok() ? std::move(mesh).value() : FileMesh();
}
FileMesh Obj(const std::string& text) { return Parse(text, MeshFormat::kObj); }
FileMesh Ply(const std::string& text) { return Parse(text, MeshFormat::kPly); }

std::vector<std::string> Names(const FileMesh& file) {
  std::vector<std::string> names;
  for (const MeshAttribute& attribute : file.mesh.attributes) names.push_back(attribute.name);
  return names;
}

// The values at a corner.
std::vector<float> At(const FileMesh& file, size_t attribute, size_t face, size_t corner) {
  const MeshAttribute& values = file.mesh.attributes[attribute];
  const auto row = values.values.begin() + values.corners[face][corner] * values.components;
  return {row, row + values.components};
}

const char kSquare[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 0.75\nvt 0 1\nvn 0 2 0\nvn 0 0 0\n";

TEST(FileMesh, ObjHasTextureCoordinatesFromAboveAndUnitNormals) {
  const FileMesh file = Obj(std::string(kSquare) + "f 1/1/1 2/2/1 3/3/1 4/4/2\nf -4/-4/-2 -3/-3/-1 -2/-2/-2\n");
  EXPECT_THAT(file.notes, IsEmpty());
  EXPECT_THAT(Names(file), ElementsAre("TEXCOORD_0", "NORMAL"));
  EXPECT_TRUE(CheckAttributedMesh(file.mesh).ok());
  EXPECT_THAT(At(file, 0, 0, 2), ElementsAre(1, 0.25f));
  EXPECT_THAT(At(file, 0, 1, 2), ElementsAre(0, 0));
  EXPECT_THAT(At(file, 0, 2, 0), ElementsAre(0, 1));
  EXPECT_THAT(At(file, 1, 0, 0), ElementsAre(0, 1, 0));
  EXPECT_THAT(At(file, 1, 1, 2), ElementsAre(0, 0, 1));  // had no length: the surface's
  EXPECT_THAT(file.group_materials, ElementsAre(FileMesh::kNoMaterial));
}

TEST(FileMesh, NormalsOfFlatShadingAreLeftAside) {
  const std::string solid = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 -1\nvn 0 -1 0\nvn 0.5774 0.5774 0.5774\n";
  const FileMesh flat = Obj(solid + "f 1//1 3//1 2//1\nf 1//2 2//2 4//2\nf 2//3 3//3 4//3\n");
  EXPECT_THAT(Names(flat), IsEmpty());
  EXPECT_THAT(flat.notes, ElementsAre(HasSubstr("NORMAL is left aside")));
  EXPECT_THAT(flat.mesh.groups, ElementsAre(0, 0, 0));
  EXPECT_THAT(Names(Obj(solid + "f 1//1 3//1 2//1\nf 1//2 2//2 4//3\nf 2//3 3//3 4//3\n")), ElementsAre("NORMAL"));
  EXPECT_THAT(Names(Obj(solid + "f 1//3 3//3 2//3\nf 1//2 2//2 4//2\nf 2//3 3//3 4//3\n")), ElementsAre("NORMAL"));
}

TEST(FileMesh, FacesWithoutAnAttributeAreAGroupOfTheirOwn) {
  const FileMesh file = Obj(std::string(kSquare) + "f 1/1 2/2 3/3\nf 1 3 4\nf 1/1 2/2 3\n");
  EXPECT_THAT(file.mesh.groups, ElementsAre(0, 1, 1));
  EXPECT_TRUE(CheckAttributedMesh(file.mesh).ok());
}

TEST(FileMesh, WhatCannotBeUsedIsLeftAsideWithANoteAndTheSurfaceStays) {
  const std::string faces = "f 1/1/1 2/2/1 3/3/1\n";
  const struct {
    std::string text, note;
  } kCases[] = {
      {std::string(kSquare) + faces + "f 1/9/1 2/2/1 3/3/1\n", "TEXCOORD_0 is left aside: triangle 1 has value 8 of 4"},
      {std::string(kSquare) + faces + "f 1/x/1 2/2/1 3/3/1\n", "TEXCOORD_0 is left aside: \"x\" in a face"},
      {std::string(kSquare) + "vt nan 1\n" + faces + "f 1/5/1 2/2/1 3/3/1\n", "TEXCOORD_0 is left aside: value 4 is not finite"},
      {std::string(kSquare) + "vn 1 inf 1\n" + faces + "f 1/1/3 2/2/1 3/3/1\n", "NORMAL is left aside: value 2 is not finite"},
      {"v 2 2 2 1 0 0\n" + std::string(kSquare) + faces, "COLOR_0 is left aside: 1 of 5 vertices have a color"},
      {"mtllib a b.mtl\n" + std::string(kSquare) + "usemtl red\n" + faces, "the material library \"a b.mtl\" cannot be read"},
  };
  for (const auto& a_case : kCases) {
    const FileMesh file = Obj(a_case.text);
    EXPECT_THAT(file.notes, ElementsAre(HasSubstr(a_case.note)));
    EXPECT_FALSE(file.mesh.surface.triangles.empty());
    EXPECT_THAT(file.group_materials, ElementsAre(FileMesh::kNoMaterial));
    EXPECT_TRUE(CheckAttributedMesh(file.mesh).ok());
  }
  // What nothing uses does no harm.
  EXPECT_THAT(Obj(std::string(kSquare) + "vt nan nan\nvn 0 x 0\n" + faces).notes, IsEmpty());
}

// Refused without being asked to; then the triangles of the vertex go, and a normal that is none is the surface's.
TEST(FileMesh, WhatIsNotFiniteIsRepairedWhereAskedFor) {
  const std::string obj = std::string(kSquare) + "v nan 0 0\nvn nan 0 1\nf 1/1/1 2/2/3 3/3/1\nf 1/1/1 5/2/1 3/3/1\nf 1/1/1 3/3/1 4/4/1\n";
  EXPECT_THAT(ParseFileMesh(FromText(obj), MeshFormat::kObj, "").status().message(), HasSubstr("vertex 4"));
  const FileMesh file = ParseFileMesh(FromText(obj), MeshFormat::kObj, "", true).value();
  EXPECT_TRUE(CheckAttributedMesh(file.mesh).ok());
  EXPECT_THAT(file.mesh.surface.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
  EXPECT_THAT(Names(file), ElementsAre("TEXCOORD_0", "NORMAL"));
  EXPECT_THAT(At(file, 0, 1, 2), ElementsAre(0, 0));  // of the third face, which is the second now
  EXPECT_THAT(At(file, 1, 0, 1), ElementsAre(0, 0, 1));
  EXPECT_THAT(file.notes, ElementsAre(HasSubstr("repaired: 1 vertices without a finite position removed with 1 triangles"),
                                      HasSubstr("repaired: 1 normals")));
  EXPECT_EQ(ShapeOf(file).notes.size(), 2u);

  const std::string body = "4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 inf 0\n3 0 1 2\n3 0 2 3\n", off = "OFF\n" + body;
  EXPECT_FALSE(ParseFileMesh(FromText(off), MeshFormat::kOff, "").ok());
  EXPECT_EQ(ParseFileMesh(FromText(off), MeshFormat::kOff, "", true).value().mesh.surface.triangles.size(), 1u);
  const std::string ply = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 2\n"
                          "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 nan 0\n3 0 1 2\n3 0 2 3\n";
  EXPECT_FALSE(ParseFileMesh(FromText(ply), MeshFormat::kPly, "").ok());
  EXPECT_EQ(ParseFileMesh(FromText(ply), MeshFormat::kPly, "", true).value().mesh.surface.triangles.size(), 1u);
  const std::string lost = "OFF\n3 1 0\n0 0 0\n1 0 0\n1 nan 0\n3 0 1 2\n";
  EXPECT_THAT(ParseFileMesh(FromText(lost), MeshFormat::kOff, "", true).status().message(), HasSubstr("no triangle with finite positions"));
}

TEST(FileMesh, ColorsAreMadeLinear) {
  const FileMesh obj = Obj("v 0 0 0 0 0.5 1\nv 1 0 0 0 0.5 1\nv 0 1 0 1 0 1\nf 1 2 3\n");
  const FileMesh bytes = Obj("v 0 0 0 0 127.5 255\nv 1 0 0 0 127.5 255\nv 0 1 0 255 0 255\nf 1 2 3\n");
  for (const FileMesh* file : {&obj, &bytes}) {
    EXPECT_THAT(Names(*file), ElementsAre("COLOR_0"));
    EXPECT_THAT(At(*file, 0, 0, 1), ElementsAre(0, FloatNear(0.21404f, 1e-5f), 1));
  }
}

TEST(FileMesh, WhatIsTheSameEverywhereIsTakenOff) {
  const auto square = [](const std::string& color) {
    return Obj("v 0 0 0 " + color + "\nv 1 0 0 " + color + "\nv 1 1 0 " + color + "\nvt 0.5 0.5\nf 1/1 2/1 3/1\n");
  };
  const FileMesh white = square("1 1 1"), gray = square("0.5 0.5 0.5");
  for (const FileMesh* file : {&white, &gray}) {
    EXPECT_THAT(Names(*file), IsEmpty());
    EXPECT_THAT(file->notes, ElementsAre(HasSubstr("TEXCOORD_0 is left aside: it is the same everywhere")));
  }
  EXPECT_THAT(white.materials, IsEmpty());
  EXPECT_THAT(white.group_materials, ElementsAre(FileMesh::kNoMaterial));
  ASSERT_EQ(gray.materials.size(), 1u);
  EXPECT_NEAR(gray.materials[0].base_color[1], 0.21404, 1e-5);
  EXPECT_THAT(gray.group_materials, ElementsAre(0));
}

std::string PlyText(const std::string& properties, const std::string& face_properties, const std::string& body, const std::string& comment = "") {
  return "ply\nformat ascii 1.0\n" + comment + "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n" + properties +
         "element face 1\nproperty list uchar int vertex_indices\n" + face_properties + "end_header\n" + body;
}

TEST(FileMesh, PlyHasWhatItsVerticesHave) {
  const std::string properties =
      "property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
      "property uchar alpha\nproperty float s\nproperty float t\n";
  const auto body = [](const std::string& alpha) {
    const std::string rest = " 0 3 0 255 0 188 " + alpha + " 0.5 0.25\n";
    return "0 0 0" + rest + "1 0 0" + rest + "1 1 0" + rest + "0 1 0 0 0 3 0 0 0 " + alpha + " 0 0\n4 0 1 2 3\n";
  };
  const FileMesh opaque = Ply(PlyText(properties, "", body("255"))), clear = Ply(PlyText(properties, "", body("51")));
  for (const FileMesh* file : {&opaque, &clear}) {
    EXPECT_THAT(Names(*file), ElementsAre("TEXCOORD_0", "NORMAL", "COLOR_0"));
    EXPECT_TRUE(CheckAttributedMesh(file->mesh).ok());
    EXPECT_THAT(At(*file, 0, 1, 1), ElementsAre(0.5f, 0.75f));
    EXPECT_THAT(At(*file, 1, 1, 1), ElementsAre(0, 1, 0));
  }
  EXPECT_THAT(At(opaque, 2, 1, 1), ElementsAre(1, 0, FloatNear(0.50289f, 1e-5f)));
  EXPECT_THAT(At(clear, 2, 1, 1), ElementsAre(1, 0, FloatNear(0.50289f, 1e-5f), FloatNear(0.2f, 1e-6f)));
}

TEST(FileMesh, PlyHasTextureCoordinatesOfFaces) {
  const std::string body = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 8 0 0 1 0 1 1 0 1 0\n";
  const FileMesh file = Ply(PlyText("", "property list uchar float texcoord\nproperty int texnumber\n", body));
  EXPECT_THAT(Names(file), ElementsAre("TEXCOORD_0"));
  EXPECT_THAT(At(file, 0, 1, 1), ElementsAre(1, 0));
  EXPECT_THAT(At(file, 0, 1, 0), ElementsAre(0, 1));
}

TEST(FileMesh, OtherFormatsSayWhatTheyLeaveAside) {
  const std::string body = "3 1 0\n0 0 0 1 0 0\n1 0 0 1 0 0\n0 1 0 1 0 0\n3 0 1 2\n";
  EXPECT_THAT(Parse("COFF\n" + body, MeshFormat::kOff).notes, ElementsAre(HasSubstr("of COFF vertices the positions alone")));
  EXPECT_THAT(Parse("OFF\n" + body, MeshFormat::kOff).notes, IsEmpty());
}

// A folder with a material library and its textures.
class FileMaterials : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* const test = ::testing::UnitTest::GetInstance()->current_test_info()->name();
    folder_ = std::filesystem::path(::testing::TempDir()) / (std::string("lacerta_file_materials_") + test);
    std::filesystem::create_directories(folder_ / "in ner");
    Write("skin.png", "\x89PNG\r\n\x1a\nskin");
    Write("in ner/glow.jpg", "\xff\xd8glow");
    Write("old.tga", "tga");
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void Write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name, std::ios::binary) << text; }
  FileMesh Read(const std::string& library, const std::string& colors = "") const {
    Write("a b.mtl", library);
    const std::string positions = "v 0 0 0" + colors + "\nv 1 0 0" + colors + "\nv 1 1 0" + colors + "\nv 0 1 0" + colors + "\n";
    return Parse("mtllib a b.mtl\nmtllib a b.mtl\n" + positions +
                     "vt 0 0\nvt 1 0\nvt 1 1\nusemtl red wine\nf 1/1 2/2 3/3\nusemtl other\nf 1 3 4\nusemtl red wine\nf 1 2 4\n",
                 MeshFormat::kObj, folder_.string());
  }

  std::filesystem::path folder_;
};

TEST_F(FileMaterials, AreThoseOfTheLibrary) {
  const FileMesh file = Read(
      "newmtl unused\nmap_Kd nowhere.png\nnewmtl red wine\r\nKd 0 0 0\nNs 98\nmap_Kd -s 1 1 1 -clamp on C:\\work\\skin.png\n"
      "map_Ke -o 0.5 in ner\\glow.jpg\nnorm old.tga\nmap_Ks ../skin.png\n\nnewmtl other\nKd 0.2 0.4 0.6\nd 0.5\nTr 1\nPr 0.3\nPm 0.7\n");
  ASSERT_EQ(file.materials.size(), 2u);
  const FileMaterial& wine = file.materials[0];
  const FileMaterial& other = file.materials[1];
  EXPECT_EQ(wine.name, "red wine");
  EXPECT_THAT(wine.base_color, ElementsAre(1, 1, 1, 1));
  EXPECT_THAT(wine.emissive, ElementsAre(1, 1, 1));
  EXPECT_NEAR(wine.roughness, std::pow(0.02, 0.25), 1e-9);
  ASSERT_EQ(file.images.size(), 2u);
  EXPECT_EQ(file.images[*wine.base_color_image].name, "skin");
  EXPECT_EQ(file.images[*wine.base_color_image].mime_type, "image/png");
  EXPECT_EQ(file.images[*wine.emissive_image].bytes, FromText("\xff\xd8glow"));
  EXPECT_EQ(file.images[*wine.emissive_image].mime_type, "image/jpeg");
  EXPECT_FALSE(wine.normal_image.has_value());
  EXPECT_THAT(file.notes, ElementsAre(HasSubstr("\"old.tga\" is left out: glTF holds PNG and JPEG"), HasSubstr("map_Ks has no counterpart")));
  EXPECT_THAT(other.base_color, ElementsAre(0.2, 0.4, 0.6, 0.5));
  EXPECT_EQ(other.roughness, 0.3);
  EXPECT_EQ(other.metallic, 0.7);
  EXPECT_THAT(file.mesh.groups, ElementsAre(0, 1, 2));  // the last face has no texture coordinates
  EXPECT_THAT(file.group_materials, ElementsAre(0, 1, 0));
}

TEST_F(FileMaterials, NothingOutsideTheFolderIsRead) {
  std::ofstream(folder_.parent_path() / "lacerta_secret.png", std::ios::binary) << "\x89PNG\r\n\x1a\nsecret";
  const FileMesh file = Read("newmtl other\nmap_Kd ../lacerta_secret.png\n");
  std::filesystem::remove(folder_.parent_path() / "lacerta_secret.png");
  EXPECT_THAT(file.images, IsEmpty());
  EXPECT_THAT(file.notes, ElementsAre(HasSubstr("\"../lacerta_secret.png\" is left out")));
}

TEST_F(FileMaterials, ColorsOfVerticesDoNotDarkenTextures) {
  const FileMesh file = Read("newmtl red wine\nmap_Kd skin.png\n", " 1 0 0");
  EXPECT_THAT(Names(file), ElementsAre("TEXCOORD_0", "COLOR_0"));
  EXPECT_EQ(file.mesh.attributes[1].corners[0][0], MeshAttribute::kNoValue);
  EXPECT_NE(file.mesh.attributes[1].corners[1][0], MeshAttribute::kNoValue);
  EXPECT_TRUE(CheckAttributedMesh(file.mesh).ok());
  EXPECT_THAT(file.notes, ElementsAre(HasSubstr("COLOR_0 is left aside where a texture is shown")));
}

TEST_F(FileMaterials, ArriveInTheAsset) {
  const FileMesh file = Read("newmtl red wine\nKd 1 1 1\nmap_Kd skin.png\nnewmtl other\nd 0.5\n");
  const StatusOr<Bytes> glb = FormatPlainGlb(file, "square");
  ASSERT_TRUE(glb.ok()) << glb.status().message();
  const GltfDocument document = ParseGltf(glb.value(), "").value();
  const Json& json = document.json;
  const Json& primitives = json["meshes"][0]["primitives"];
  ASSERT_EQ(primitives.size(), 3u);
  EXPECT_TRUE(primitives[0]["attributes"].contains("TEXCOORD_0"));
  EXPECT_FALSE(primitives[1]["attributes"].contains("TEXCOORD_0"));
  EXPECT_EQ(json["materials"][primitives[0]["material"].get<size_t>()]["pbrMetallicRoughness"]["baseColorTexture"]["index"], 0);
  EXPECT_EQ(json["materials"][primitives[1]["material"].get<size_t>()]["alphaMode"], "BLEND");
  // A texture needs coordinates.
  EXPECT_FALSE(json["materials"][primitives[2]["material"].get<size_t>()]["pbrMetallicRoughness"].contains("baseColorTexture"));
  EXPECT_EQ(json["materials"][primitives[2]["material"].get<size_t>()]["name"], "red wine");
  const Json& view = json["bufferViews"][json["images"][0]["bufferView"].get<size_t>()];
  EXPECT_EQ(view["byteLength"], file.images[0].bytes.size());
}

// As maps of a country have it: half a meter lies between neighboring floats.
TEST(FileMesh, PositionsFarFromZeroKeepTheirDigits) {
  const std::string vertices[] = {"431234.25 5412345.125 312.5", "431235.25 5412345.125 312.5", "431234.25 5412347.125 313.0625"};
  std::string obj, ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n"
                         "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  std::string off = "OFF\n3 1 0\n", stl = "solid\nfacet normal 0 0 1\nouter loop\n";
  for (const std::string& vertex : vertices) {
    obj += "v " + vertex + "\n";
    ply += vertex + "\n";
    off += vertex + "\n";
    stl += "vertex " + vertex + "\n";
  }
  const std::pair<MeshFormat, std::string> files[] = {{MeshFormat::kObj, obj + "f 1 2 3\n"},
                                                      {MeshFormat::kPly, ply + "3 0 1 2\n"},
                                                      {MeshFormat::kOff, off + "3 0 1 2\n"},
                                                      {MeshFormat::kStl, stl + "endloop\nendfacet\nendsolid\n"}};
  for (const auto& [format, text] : files) {
    const FileMesh file = Parse(text, format);
    const std::vector<Vec3f>& positions = file.mesh.surface.positions;
    ASSERT_EQ(positions.size(), 3u);
    EXPECT_EQ(Vec3Cast<double>(positions[0]) + file.origin, (Vec3d{431234.25, 5412345.125, 312.5}));
    EXPECT_EQ(Vec3Cast<double>(positions[2]) + file.origin, (Vec3d{431234.25, 5412347.125, 313.0625}));
    EXPECT_LT(Norm(Vec3Cast<double>(positions[0])), 4);
    EXPECT_EQ(ParseMesh(FromText(text), format).value().positions[1].x, 431235.25f);
    // Out and in again, in every format that there is a writer for.
    for (const char* extension : {".ply", ".obj", ".glb"}) {
      const std::string path = ::testing::TempDir() + "/lacerta_far" + std::to_string(static_cast<int>(format)) + extension;
      ASSERT_TRUE(WriteMeshFile(file.mesh.surface, path, file.origin).ok());
      EXPECT_EQ(ReadMeshFile(path, file.origin).value().positions, positions) << path;
      std::filesystem::remove(path);
    }
  }
}

TEST(FileMesh, WhatIsNearZeroHasNoOrigin) {
  const auto origin = [](float x) { return FarOrigin({{{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0}}, {{0, 1, 2}}}); };
  EXPECT_EQ(origin(0), (Vec3d{0, 0, 0}));
  EXPECT_EQ(origin(-20), (Vec3d{0, 0, 0}));
  EXPECT_EQ(origin(23), (Vec3d{24, 1, 0}));
  EXPECT_EQ(FarOrigin({}), (Vec3d{0, 0, 0}));
}

// The surface of a mesh without anything on it is stored as ever: a stream without attributes.
TEST(FileMesh, PlainSurfacesArePackedAsSuch) {
  const TriangleMesh ball = testing::WavySphere(48, 72);
  FileMesh file;
  file.mesh.surface = ball;
  file.group_materials = {FileMesh::kNoMaterial};
  file.notes = {"something was left aside"};
  PackOptions options;
  options.encode.target = {EncodeTarget::Kind::kPsnr, 55.0};
  const auto with = PackMesh(file, "ball", options), without = PackMesh(ball, "ball", options);
  ASSERT_TRUE(with.ok() && without.ok());
  EXPECT_EQ(with.value().glb, without.value().glb);
  EXPECT_EQ(with.value().report.notes[0], "something was left aside");
}

}  // namespace
}  // namespace lacerta
