#include "mesh_file/file_materials.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "document/image_size.h"
#include "document/uri.h"
#include "lacerta/file_io.h"
#include "mesh_file/text_scanner.h"

namespace lacerta {
namespace {

// Of a path that Windows may have written.
std::filesystem::path PathOf(std::string path) {
  std::replace(path.begin(), path.end(), '\\', '/');
  return std::filesystem::path(path).lexically_normal();
}

// A file in the folder, by its path or by its name alone.
StatusOr<Bytes> ReadInFolder(const std::string& path, const std::string& folder) {
  const std::filesystem::path relative = PathOf(path);
  if (path.find('\0') != std::string::npos || !relative.has_filename()) return NotFound("\"" + path + "\" names no file");
  if (!LeavesFolder(relative) && path.find(':') == std::string::npos) {
    StatusOr<Bytes> bytes = ReadFile((std::filesystem::path(folder) / relative).string());
    if (bytes.ok()) return bytes;
  }
  return ReadFile((std::filesystem::path(folder) / relative.filename()).string());
}

// Empty where it is neither a PNG nor a JPEG, the images of core glTF.
std::string MimeTypeOf(const Bytes& image) {
  const std::string type = ImageMimeType(image);
  return type == "image/png" || type == "image/jpeg" ? type : "";
}

class Loader {
 public:
  Loader(const std::string& folder, FileSurface* surface) : folder_(folder), surface_(*surface) {}

  FileMaterials Load() {
    if (!surface_.textures.empty()) {
      for (const std::string& texture : surface_.textures) {
        FileMaterial material;
        material.name = PathOf(texture).stem().string();
        material.base_color_image = ImageOf(texture);
        result_.materials.push_back(std::move(material));
      }
      return std::move(result_);
    }
    for (const std::string& name : surface_.material_names) {
      materials_.emplace(name, result_.materials.size());
      result_.materials.emplace_back().name = name;
    }
    bool is_told = false;
    const std::set<std::string> libraries(surface_.material_libraries.begin(), surface_.material_libraries.end());
    for (const std::string& library : libraries) is_told = ReadLibrary(library) || is_told;
    if (!is_told) {
      surface_.triangle_materials.clear();
      result_.materials.clear();
    }
    return std::move(result_);
  }

 private:
  // Whether it tells of a material that faces have.
  bool ReadLibrary(const std::string& path) {
    const StatusOr<Bytes> bytes = ReadInFolder(path, folder_);
    if (!bytes.ok()) {
      surface_.notes.push_back("the material library \"" + path + "\" cannot be read: " + bytes.status().message());
      return false;
    }
    TextScanner scanner({reinterpret_cast<const char*>(bytes.value().data()), bytes.value().size()});
    bool is_told = false;
    FileMaterial* material = nullptr;
    std::string_view line;
    while (scanner.NextLine(&line)) {
      const std::string_view keyword = TakeWord(&line);
      if (keyword == "newmtl") {
        const auto found = materials_.find(RestOfLine(line));
        material = found == materials_.end() ? nullptr : &result_.materials[found->second];
        is_told = is_told || material != nullptr;
      } else if (material != nullptr) {
        ReadProperty(keyword, line, material);
      }
    }
    return is_told;
  }

  void ReadProperty(std::string_view keyword, std::string_view words, FileMaterial* material) {
    if (keyword == "map_Kd") {
      material->base_color_image = ImageOf(FileIn(words));
      // Texture and color are multiplied in glTF; many writers leave black or gray beside a texture that is to be seen as it is.
      if (material->base_color_image) std::fill_n(material->base_color.begin(), 3, 1.0);
    } else if (keyword == "map_Ke") {
      material->emissive_image = ImageOf(FileIn(words));
      if (material->emissive_image) material->emissive = {1, 1, 1};
    } else if (keyword == "norm") {
      material->normal_image = ImageOf(FileIn(words));
    } else if (keyword == "Kd" && !material->base_color_image) {
      ReadNumbers(words, 3, material->base_color.data());
    } else if (keyword == "Ke" && !material->emissive_image) {
      ReadNumbers(words, 3, material->emissive.data());
    } else if (keyword == "d") {
      ReadNumbers(words, 1, &material->base_color[3]);
    } else if (keyword == "Tr") {
      double transparency = 0;
      ReadNumbers(words, 1, &transparency);
      if (transparency < 1) material->base_color[3] = 1 - transparency;  // some write 1 for what is opaque
    } else if (keyword == "Ns") {
      double exponent = 0;  // of Blinn and Phong, as a roughness by the width of its highlight (Walter et al. 2007)
      if (ReadNumbers(words, 1, &exponent, 1e6)) material->roughness = std::pow(2 / (exponent + 2), 0.25);
    } else if (keyword == "Pr") {
      ReadNumbers(words, 1, &material->roughness);
    } else if (keyword == "Pm") {
      ReadNumbers(words, 1, &material->metallic);
    } else if (keyword.substr(0, 4) == "map_" || keyword == "bump" || keyword == "disp") {
      surface_.notes.push_back("material \"" + material->name + "\": " + std::string(keyword.substr(0, 40)) + " has no counterpart in glTF and is left aside");
    }
  }

  // All of them as numbers from 0 to `most`, or nothing changes.
  static bool ReadNumbers(std::string_view words, int count, double* numbers, double most = 1) {
    double read[3] = {};
    for (int i = 0; i < count; ++i) {
      if (!ParseDouble(TakeWord(&words), &read[i]) || std::isnan(read[i])) return false;
    }
    std::transform(read, read + count, numbers, [&](double x) { return std::clamp(x, 0.0, most); });
    return true;
  }

  // The name after options (-s 1 1 1, -clamp on, ...), which may have blanks within.
  static std::string FileIn(std::string_view words) {
    for (;;) {
      std::string_view rest = words;
      const std::string_view option = TakeWord(&rest);
      if (option.empty() || option[0] != '-') return RestOfLine(words);
      const bool is_vector = option == "-o" || option == "-s" || option == "-t";  // of one to three numbers
      for (int arguments = is_vector ? 3 : option == "-mm" ? 2 : 1; arguments > 0; --arguments) {
        std::string_view after = rest;
        double number = 0;
        if (!ParseDouble(TakeWord(&after), &number) && is_vector) break;
        rest = after;
      }
      words = rest;
    }
  }

  // An index of result_.images; nothing, and a note, where there is none.
  std::optional<size_t> ImageOf(const std::string& path) {
    const auto [known, is_new] = images_.emplace(path, std::nullopt);
    if (!is_new) return known->second;
    StatusOr<Bytes> bytes = ReadInFolder(path, folder_);
    const std::string mime_type = bytes.ok() ? MimeTypeOf(bytes.value()) : "";
    if (mime_type.empty()) {
      surface_.notes.push_back("the texture \"" + path + "\" is left out: " +
                               (bytes.ok() ? "glTF holds PNG and JPEG, convert it to one of these" : bytes.status().message()));
      return std::nullopt;
    }
    known->second = result_.images.size();
    result_.images.push_back({PathOf(path).stem().string(), mime_type, std::move(bytes).value()});
    return known->second;
  }

  const std::string& folder_;
  FileSurface& surface_;
  FileMaterials result_;
  std::map<std::string, size_t> materials_;                  // by name
  std::map<std::string, std::optional<size_t>> images_;  // by path
};

}  // namespace

FileMaterials LoadMaterials(const std::string& folder, FileSurface* surface) { return Loader(folder, surface).Load(); }

}  // namespace lacerta
