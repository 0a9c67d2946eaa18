#include "formats/mesh_reader.h"

#include <fmt/format.h>

#include <cctype>
#include <optional>
#include <string_view>

#include "formats/bytes.h"
#include "formats/input_source.h"
#include "formats/mesh_writer.h"
#include "formats/npy_header.h"
#include "formats/npy_mesh.h"
#include "formats/obj_reader.h"
#include "formats/off_reader.h"
#include "formats/ply_header.h"
#include "formats/ply_reader.h"
#include "formats/point_format.h"
#include "formats/vtu_reader.h"
#include "src/error.h"

namespace spillway {
namespace {

constexpr std::size_t kProbe = 1024;

/// Whether the text begins with `word`, and with nothing that makes it longer.
bool begins_with_word(std::string_view text, std::string_view word) {
  return text.starts_with(word) &&
         (text.size() == word.size() ||
          std::isspace(static_cast<unsigned char>(text[word.size()])) != 0);
}

/// OBJ has no magic number: only Spillway's own is recognised.
std::optional<MeshFormat> format_of_content(InputSource& source) {
  const std::string_view text = as_text(source.peek(kProbe));
  if (begins_with_word(text, "ply")) return MeshFormat::kPly;
  if (begins_with_word(text, "OFF")) return MeshFormat::kOff;
  if (begins_with_word(text, "# spillway dimension")) return MeshFormat::kObj;
  if (text.starts_with('<') && text.find("<VTKFile") != text.npos) return MeshFormat::kVtu;
  return std::nullopt;
}

/// The format that a name alone tells; npy is not among them, as points have it too.
std::optional<MeshFormat> format_of_name(const std::string& path) {
  const std::string extension = extension_of(path);
  if (extension == "ply") return MeshFormat::kPly;
  if (extension == "obj") return MeshFormat::kObj;
  if (extension == "off") return MeshFormat::kOff;
  if (extension == "vtu") return MeshFormat::kVtu;
  return std::nullopt;
}

/// Whether a PLY file has simplices. What is wrong with its header is left to read_mesh() to say.
bool is_ply_mesh(InputSource& source) {
  try {
    return read_ply_header(source).simplices() != nullptr;
  } catch (const Error&) {
    return true;
  }
}

[[noreturn]] void fail_for_unknown(InputSource& source, const std::string& path) {
  if (as_text(source.peek(kProbe)).starts_with(kNpyMagic)) {
    const NpyMeshNames names = npy_mesh_names(path);
    throw Error(
        fmt::format("{}: this is one npy array, but a mesh is two, such as {} and {}; name "
                    "one of these",
                    source.name(), names.vertices, names.simplices));
  }
  throw Error(
      fmt::format("{}: this is no mesh that is known: it begins neither as PLY nor as OFF nor "
                  "as VTU, and has not the name of OBJ or npy; convert it or name its "
                  "format",
                  source.name()));
}

/// Whether `path` names an npy mesh and nothing else: one of its files, or no file at all.
bool is_npy_mesh(const FileSystem& files, const std::string& path) {
  const std::optional<NpyMeshNames> names = find_npy_mesh(files, path);
  return names && (path == names->vertices || path == names->simplices || !files.exists(path));
}

Mesh read_npy(FileSystem& files, const std::string& path) {
  if (const std::optional<NpyMeshNames> names = find_npy_mesh(files, path)) {
    return read_npy_mesh(files, *names);
  }
  const NpyMeshNames names = npy_mesh_names(path);
  throw Error(
      fmt::format("{}: an npy mesh is two files, such as {} and {}, which are not both there", path,
                  names.vertices, names.simplices));
}

}  // namespace

bool is_mesh(FileSystem& files, const std::string& path) {
  if (path == "-") return false;
  if (is_npy_mesh(files, path)) return true;
  InputSource source(files.open(path));
  std::optional<MeshFormat> format = format_of_content(source);
  if (!format) format = format_of_name(path);
  return format == MeshFormat::kPly ? is_ply_mesh(source) : format.has_value();
}

Mesh read_mesh(FileSystem& files, const std::string& path, const std::string& format_name) {
  std::optional<MeshFormat> format;
  if (!format_name.empty()) format = mesh_format(path, format_name);
  if (format == MeshFormat::kNpy || (!format && is_npy_mesh(files, path))) {
    return read_npy(files, path);
  }
  InputSource source(files.open(path));
  if (!format) format = format_of_content(source);
  if (!format) format = format_of_name(path);
  if (!format) fail_for_unknown(source, path);
  switch (*format) {
    case MeshFormat::kObj:
      return read_obj(source);
    case MeshFormat::kOff:
      return read_off(source);
    case MeshFormat::kVtu:
      return read_vtu(source);
    default:
      return read_ply(source);
  }
}

}  // namespace spillway
