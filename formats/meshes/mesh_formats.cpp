#include "formats/meshes/mesh_formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <system_error>

#include "formats/bytes/input_bytes.h"
#include "formats/bytes/word_list.h"
#include "formats/disk/extension.h"
#include "formats/disk/file_system.h"
#include "formats/meshes/common/colour.h"
#include "formats/meshes/glb/glb_format.h"
#include "formats/meshes/landxml/landxml_format.h"
#include "formats/meshes/npy/npy_format.h"
#include "formats/meshes/obj/obj_format.h"
#include "formats/meshes/off/off_format.h"
#include "formats/meshes/ply/ply_format.h"
#include "formats/meshes/sma/sma_format.h"
#include "formats/meshes/spm/spm_format.h"
#include "formats/meshes/stl/stl_format.h"
#include "formats/meshes/vector/vector_format.h"
#include "formats/meshes/vtu/vtu_format.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

// clang-format off
constexpr const MeshFormat* kFormats[] = {
    &kPlyMesh,
    &kPlyAsciiMesh,
    &kObjMesh,
    &kOffMesh,
    &kVtuMesh,
    &kNpyMesh,
    &kSpmMesh,
    &kSmaMesh,
    &kGlbMesh,
    &kStlMesh,
    &kLandXmlMesh,
    &kGpkgMesh,
    &kShpMesh,
};
// clang-format on

const MeshFormat* find(MeshFormats formats, const auto& is_wanted) {
  const auto found =
      std::ranges::find_if(formats, [&](const MeshFormat* f) { return is_wanted(*f); });
  return found == formats.end() ? nullptr : *found;
}

bool has_extension(const MeshFormat& format, std::string_view extension) {
  return std::ranges::find(format.extensions, extension) != format.extensions.end();
}

}  // namespace

MeshFormats mesh_formats() { return kFormats; }

const MeshFormat& own_mesh_stream() { return kSpmMesh; }

std::vector<std::string> mesh_format_names(MeshFormats formats) {
  std::vector<std::string> names;
  names.reserve(formats.size());
  for (const MeshFormat* const format : formats) names.emplace_back(format->name);
  return names;
}

const MeshFormat* mesh_format_of_extension(const std::string& path, MeshFormats formats) {
  const std::string extension = extension_of(path);
  return find(formats, [&](const MeshFormat& format) { return has_extension(format, extension); });
}

const MeshFormat& mesh_format(const std::string& path, const std::string& format_name,
                              MeshFormats formats) {
  if (path == "-" && format_name.empty()) return own_mesh_stream();
  const MeshFormat* const found =
      format_name.empty()
          ? mesh_format_of_extension(path, formats)
          : find(formats, [&](const MeshFormat& format) { return format.name == format_name; });
  if (found != nullptr) return *found;
  const std::string what = !format_name.empty()
                               ? fmt::format("there is no mesh format \"{}\"", format_name)
                               : fmt::format("cannot tell the mesh format from the name {}", path);
  throw InvalidArgument(
      fmt::format("{}; choose one of {}", what, fmt::join(mesh_format_names(formats), ", ")),
      {.file = path});
}

const MeshFormat* mesh_format_of_bytes(std::string_view first_bytes, MeshFormats formats) {
  return find(formats, [&](const MeshFormat& format) {
    return format.recognises != nullptr && format.recognises(first_bytes);
  });
}

const MeshFormat* stream_format_that_resembles(std::string_view first_bytes, MeshFormats formats) {
  return find(formats, [&](const MeshFormat& format) {
    return format.resembles != nullptr && format.resembles(first_bytes);
  });
}

const MeshFormat* mesh_format_of_name(const std::string& path, MeshFormats formats) {
  const std::string extension = extension_of(path);
  return find(formats, [&](const MeshFormat& format) {
    return format.name_tells && has_extension(format, extension);
  });
}

const MeshFormat* mesh_format_of_part(const FileSystem& files, const std::string& path,
                                      MeshFormats formats) {
  return find(formats, [&](const MeshFormat& format) {
    return format.file_set != nullptr && format.file_set->has_part(files, path);
  });
}

std::vector<std::string> names_of_formats(bool (*chosen)(const MeshFormat&), MeshFormats formats) {
  std::vector<std::string> names;
  for (const MeshFormat* const format : formats) {
    if (format->is_variant || !chosen(*format)) continue;
    const bool own = format == &own_mesh_stream();
    names.emplace(own ? names.begin() : names.end(), format->name);
  }
  return names;
}

std::string list_of_formats(bool (*chosen)(const MeshFormat&), std::string_view last,
                            MeshFormats formats) {
  return word_list(names_of_formats(chosen, formats), last);
}

std::vector<std::string> lost_attributes(const MeshFormat& format, const AttributeLayout& layout) {
  std::vector<std::string> lost;
  if (format.held_attributes == HeldAttributes::kAll) return lost;
  const std::optional<ColourFields> colour = colour_fields(layout);
  const bool holds_colour = format.held_attributes == HeldAttributes::kColour && colour;
  for (const AttributeField& field : layout.fields()) {
    const auto is_same = [&](const AttributeField& other) { return other.at == field.at; };
    if (holds_colour && std::ranges::any_of(*colour, is_same)) continue;
    lost.push_back(field.attribute.name);
  }
  return lost;
}

std::string rounding_note(const MeshFormat& format, const std::string& path) {
  if (!format.rounds_coordinates) return "";
  std::string note = fmt::format(
      "{} has 32-bit floats: coordinates are rounded, so info and check find another hash there",
      format.title);
  std::error_code ignored;
  if (format.unknown_origin != nullptr && std::filesystem::is_regular_file(path, ignored)) {
    InputBytes source(disk().open(path));
    const std::optional<WorldPoint> origin = format.unknown_origin(source);
    constexpr WorldPoint kNone{};
    if (origin && *origin != kNone) {
      note += fmt::format(
          "; other programs find them without {}, {}, {}, the origin that {} names in "
          "its first bytes",
          (*origin)[0], (*origin)[1], (*origin)[2], path);
    }
  }
  return note;
}

}  // namespace spillway::formats
