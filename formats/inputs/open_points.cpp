#include "formats/inputs/open_points.h"

#include <fmt/format.h>

#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/bytes/input_bytes.h"
#include "formats/bytes/line_reader.h"
#include "formats/compression/decompress.h"
#include "formats/inputs/unread_points.h"
#include "formats/meshes/mesh_formats.h"
#include "formats/points/open_las.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

constexpr std::size_t kProbe = 512;

[[noreturn]] void fail_for_mesh(const InputBytes& source, std::string_view name) {
  const auto is_stream = [](const MeshFormat& format) { return format.is_stream(); };
  throw BadInput(
      source.name(),
      fmt::format("this is a mesh ({}), not points; give the points it was made of, as {}{}", name,
                  list_of_points(is_written, "or"),
                  source.size() ? ""
                                : fmt::format("; of meshes only {} are read from a pipe",
                                              list_of_formats(is_stream, "and"))),
      at_byte(0));
}

/// Throws Failure if the source begins as a mesh of a format that is known by its first bytes. A
/// table may have shapes of any kind.
void refuse_meshes(InputBytes& source) {
  const MeshFormat* const format = mesh_format_of_bytes(as_text(source.peek(kProbe)));
  if (format == nullptr || format->is_table()) return;
  if (const PointFormat* const points = point_format_of_header(source)) {
    throw BadInput(source.name(),
                   fmt::format("this is {}, not text; do not name a format", points->title),
                   at_byte(0));
  }
  fail_for_mesh(source, format->title);
}

/// Throws Failure if the source begins as a mesh, or as something else that is text, but no text of
/// points.
void refuse_what_is_no_points(InputBytes& source) {
  refuse_meshes(source);
  const std::string_view text = as_text(source.peek(kProbe));
  if (const std::string_view what = unread_points(text); !what.empty()) {
    throw BadInput(source.name(),
                   fmt::format("this is {}, which is not read; convert it to {}", what,
                               list_of_points(is_written, "or")),
                   at_byte(0));
  }
  if (text.starts_with("<?xml")) {
    throw BadInput(source.name(),
                   fmt::format("this is XML, from which points are not read; save them as {}",
                               list_of_points(is_written, "or")),
                   at_byte(0));
  }
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) {
    throw BadInput(source.name(), "this is text in UTF-16; save it in UTF-8", at_byte(0));
  }
}

/// What binary formats begin as, for messages: "as LAS nor as npy nor as spp".
std::string beginnings(PointFormats formats) {
  std::vector<std::string> titles;
  for (const PointFormat* const format : formats) {
    if (format->recognises != nullptr) titles.emplace_back(format->title);
  }
  return fmt::format("as {}", fmt::join(titles, " nor as "));
}

const PointFormat* text_format(PointFormats formats) {
  for (const PointFormat* const format : formats) {
    if (format->is_text) return format;
  }
  return nullptr;
}

/// By the first bytes, then the name; what neither knows is text if it looks like it.
const PointFormat& format_of(InputBytes& source, const std::string& path, PointFormats formats) {
  const std::string first_bytes(as_text(source.peek(kProbe)));  // what follows may peek further
  const PointFormat* const text = text_format(formats);
  const PointFormat* const told = point_format_of_bytes(first_bytes, formats);
  if (told != nullptr) return *told;
  if (const PointFormat* const format = point_format_of_header(source, formats)) return *format;
  const Compression compression = compression_of_content(std::as_bytes(std::span(first_bytes)));
  if (text != nullptr && compression != Compression::kNone) return *text;
  refuse_what_is_no_points(source);
  if (const PointFormat* const format = point_format_of_path(path, formats)) return *format;
  if (text != nullptr && looks_like_text(first_bytes)) return *text;
  throw BadInput(
      source.name(),
      fmt::format("unknown format: the file begins neither {} nor as text; convert it or "
                  "name its format",
                  beginnings(formats)),
      at_byte(0));
}

[[noreturn]] void fail_for_compressed(const InputBytes& source) {
  throw BadInput(source.name(), "only text is read compressed; decompress the file first",
                 at_byte(0));
}

/// How the text is compressed, by its first bytes. Throws Failure if the name promises what the file
/// is not.
Compression compression_of(InputBytes& source, const std::string& path, PointFormats formats) {
  const std::span<const std::byte> first_bytes = source.peek(kProbe);
  const Compression found = compression_of_content(first_bytes);
  if (compression_of_name(path) == Compression::kNone) return found;
  const PointFormat* const inner =
      point_format_of_path(std::filesystem::path(path).stem().string(), formats);
  if (inner != nullptr && !inner->is_text) fail_for_compressed(source);
  const bool is_text = !first_bytes.empty() && looks_like_text(as_text(first_bytes));
  if (found == Compression::kNone && !is_text) {
    throw BadInput(source.name(),
                   "the file does not begin as its extension says; it is corrupt or has the wrong "
                   "name",
                   at_byte(0));
  }
  return found;
}

/// Throws Failure unless the source begins as text, or is empty.
void check_text(InputBytes& source, PointFormats formats) {
  if (looks_like_text(as_text(source.peek(kProbe)))) return;
  throw BadInput(
      source.name(),
      fmt::format("this is not text, and begins neither {}; see what it is, or name its format",
                  beginnings(formats)),
      at_byte(0));
}

/// What is in the source if it is compressed, else null. Throws Failure unless that is text of
/// points.
std::unique_ptr<InputFile> text_in(InputBytes& source, const std::string& path,
                                   std::uint64_t max_expansion, PointFormats formats) {
  const Compression compression = compression_of(source, path, formats);
  if (compression == Compression::kNone) {
    check_text(source, formats);
    return nullptr;
  }
  auto content = std::make_unique<InputBytes>(decompressed(source, compression, max_expansion));
  if (begins_as_points(content->peek(kProbe), formats) ||
      point_format_of_header(*content, formats) != nullptr) {
    fail_for_compressed(source);
  }
  refuse_what_is_no_points(*content);
  check_text(*content, formats);
  return content;
}

}  // namespace

bool begins_as_points(std::span<const std::byte> first_bytes, PointFormats formats) {
  return point_format_of_bytes(as_text(first_bytes), formats) != nullptr ||
         compression_of_content(first_bytes) != Compression::kNone;
}

std::unique_ptr<PointReader> open_point_reader(FileSystem& files, const std::string& path,
                                               const PointReaderOptions& options,
                                               PointFormats formats) {
  const PointFormat* format =
      options.format.empty() ? nullptr : &point_format_by_name(options.format, formats);
  PointInput input{std::make_unique<InputBytes>(files.open(path)), path, nullptr};
  if (path == "-") input.source->check_not_empty();
  if (format != nullptr && format->is_text) refuse_what_is_no_points(*input.source);
  if (format == nullptr) format = &format_of(*input.source, path, formats);
  if (format->las_variant != nullptr) return open_las(std::move(input), options, formats);
  for (const MeshFormat* const mesh : mesh_formats()) {
    if (mesh->file_set != nullptr) mesh->file_set->check_is_points(files, path);
  }
  if (format->is_text) {
    input.content = text_in(*input.source, path, options.max_expansion, formats);
  }
  return format->open_reader(std::move(input), options);
}

}  // namespace spillway::formats
