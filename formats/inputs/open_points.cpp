#include "formats/inputs/open_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include "formats/bytes/bytes.h"
#include "formats/bytes/input_source.h"
#include "formats/bytes/line_reader.h"
#include "formats/compression/decompress.h"
#include "formats/disk/extension.h"
#include "formats/meshes/common/mesh_checks.h"
#include "formats/meshes/glb/glb_format.h"
#include "formats/meshes/npy/npy_mesh.h"
#include "formats/meshes/ply/ply_header.h"
#include "formats/meshes/sma/sma_reader.h"
#include "formats/meshes/spm/spm_format.h"
#include "formats/points/npy/npy_header.h"
#include "formats/points/npy/npy_reader.h"
#include "formats/points/open_las.h"
#include "formats/points/point_format.h"
#include "formats/points/spp/spp_format.h"
#include "formats/points/spp/spp_reader.h"
#include "formats/points/text/text_reader.h"
#include "src/error.h"

namespace spillway::detail {
namespace {

constexpr std::size_t kProbe = 512;

[[noreturn]] void fail_for_mesh(const InputSource& source, std::string_view name) {
  throw Error(fmt::format(
      "{}: this is a mesh ({}), not points; give the points it was made of, as LAS, text, npy or "
      "spp{}",
      source.name(), name,
      source.size() ? "" : "; of meshes only spm and sma are read from a pipe"));
}

/// A PLY file is a mesh, or a cloud of points.
[[noreturn]] void fail_for_ply(InputSource& source) {
  if (read_ply_header(source).simplices() == nullptr) fail_for_point_cloud(source.name(), "PLY");
  fail_for_mesh(source, "PLY");
}

/// Throws Error if the source begins as a mesh of a format that is known by its first bytes, or as
/// something else that is text, but no text of points.
void refuse_what_is_no_points(InputSource& source) {
  struct Known {
    std::string_view begin;
    std::string_view name;
  };
  constexpr std::array kMeshes = {Known{"OFF\n", "OFF"},    Known{kSpmMagic, "spm"},
                                  Known{kSmaNote, "sma"},   Known{glb::kMagic, "glTF"},
                                  Known{"<VTKFile", "VTU"}, Known{"<LandXML", "LandXML"},
                                  Known{"solid ", "STL"},   Known{"# spillway dimension", "OBJ"}};
  const std::string_view text = as_text(source.peek(kProbe));
  if (text.starts_with("ply\n") || text.starts_with("ply\r")) fail_for_ply(source);
  for (const Known& known : kMeshes) {
    if (text.starts_with(known.begin)) fail_for_mesh(source, known.name);
  }
  if (text.starts_with("<?xml")) {
    if (text.find("<VTKFile") != text.npos) fail_for_mesh(source, "VTU");
    if (text.find("<LandXML") != text.npos) fail_for_mesh(source, "LandXML");
    throw Error(fmt::format(
        "{}: this is XML, from which points are not read; save them as LAS, text, npy or spp",
        source.name()));
  }
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) {
    throw Error(fmt::format("{}: this is text in UTF-16; save it in UTF-8", source.name()));
  }
}

/// The format of points that begins with these bytes and nothing else does.
std::optional<PointFormat> format_of_magic(std::string_view text) {
  if (text.starts_with("LASF")) return PointFormat::kLas;
  if (text.starts_with(kNpyMagic)) return PointFormat::kNpy;
  if (text.starts_with(kSppMagic)) return PointFormat::kSpp;
  return std::nullopt;
}

/// By the first bytes, then the name; what neither knows is text if it looks like it.
PointFormat format_of(InputSource& source, const std::string& path) {
  const std::span<const std::byte> first_bytes = source.peek(kProbe);
  if (const auto format = format_of_magic(as_text(first_bytes))) return *format;
  if (compression_of_content(first_bytes) != Compression::kNone) return PointFormat::kText;
  refuse_what_is_no_points(source);
  if (const auto format = point_format_of_path(path)) return *format;
  if (looks_like_text(as_text(first_bytes))) return PointFormat::kText;
  throw Error(
      fmt::format("{}: unknown format: the file begins neither as LAS nor as npy nor as "
                  "spp nor as text; convert it or name its format",
                  source.name()));
}

[[noreturn]] void fail_for_compressed(const InputSource& source) {
  throw Error(
      fmt::format("{}: only text is read compressed; decompress the file first", source.name()));
}

/// How the text is compressed, by its first bytes. Throws Error if the name promises what the file
/// is not.
Compression compression_of(InputSource& source, const std::string& path) {
  const std::span<const std::byte> first_bytes = source.peek(kProbe);
  const Compression found = compression_of_content(first_bytes);
  if (compression_of_name(path) == Compression::kNone) return found;
  const std::string inner = extension_of(std::filesystem::path(path).stem().string());
  if (inner == "las" || inner == "laz" || inner == "npy" || inner == "spp") {
    fail_for_compressed(source);
  }
  const bool is_text = !first_bytes.empty() && looks_like_text(as_text(first_bytes));
  if (found == Compression::kNone && !is_text) {
    throw Error(
        fmt::format("{}: the file does not begin as its extension says; it is corrupt or "
                    "has the wrong name",
                    source.name()));
  }
  return found;
}

/// Throws Error unless the source begins as text, or is empty.
void check_text(InputSource& source) {
  if (looks_like_text(as_text(source.peek(kProbe)))) return;
  throw Error(
      fmt::format("{}: this is no text, and begins neither as LAS nor as npy nor as spp; see what "
                  "it is, or name its format",
                  source.name()));
}

/// What is in the compressed source, which must be text of points.
std::unique_ptr<InputFile> text_in(InputSource& source, Compression compression) {
  auto content = std::make_unique<InputSource>(decompressed(source, compression));
  const std::span<const std::byte> first_bytes = content->peek(kProbe);
  if (format_of_magic(as_text(first_bytes)) ||
      compression_of_content(first_bytes) != Compression::kNone) {
    fail_for_compressed(source);
  }
  refuse_what_is_no_points(*content);
  check_text(*content);
  return content;
}

}  // namespace

bool begins_as_points(std::span<const std::byte> first_bytes) {
  return format_of_magic(as_text(first_bytes)).has_value() ||
         compression_of_content(first_bytes) != Compression::kNone;
}

std::unique_ptr<PointReader> open_point_reader(FileSystem& files, const std::string& path,
                                               const PointReaderOptions& options) {
  std::optional<PointFormat> format;
  if (!options.format.empty()) format = point_format_by_name(options.format);
  auto source = std::make_unique<InputSource>(files.open(path));
  if (path == "-") source->check_not_empty();
  if (format == PointFormat::kText) refuse_what_is_no_points(*source);
  if (!format) format = format_of(*source, path);
  switch (*format) {
    case PointFormat::kLas:
      return open_las(std::move(source), path, options);
    case PointFormat::kNpy:
      if (path.ends_with(kNpySimplices) && is_part_of_npy_mesh(files, path)) {
        throw Error(fmt::format(
            "{}: these are the simplices of an npy mesh, not points; its vertices are in a file "
            "beside it",
            path));
      }
      return open_npy_reader(std::move(source), path);
    case PointFormat::kSpp:
      return open_spp_reader(std::move(source), path);
    case PointFormat::kText:
      break;
  }
  const Compression compression = compression_of(*source, path);
  std::unique_ptr<InputFile> content;
  if (compression != Compression::kNone) {
    content = text_in(*source, compression);
  } else {
    check_text(*source);
  }
  return open_text_reader(std::move(source), path, std::move(content));
}

}  // namespace spillway::detail
