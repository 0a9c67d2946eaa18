#include "formats/inputs/open_mesh_stream.h"

#include <fmt/format.h>

#include <utility>

#include "formats/bytes/bytes.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

constexpr std::size_t kProbe = 4096;

bool is_a_stream(const MeshFormat& format) { return format.is_stream(); }

}  // namespace

const MeshFormat& mesh_stream_format(InputBytes& source, const std::string& path,
                                     MeshFormats formats) {
  if (path == "-") source.check_not_empty();
  const std::string_view text = as_text(source.peek(kProbe));
  if (const MeshFormat* const told = mesh_format_of_bytes(text, formats)) {
    if (told->is_stream()) return *told;
  }
  if (const MeshFormat* const likely = stream_format_that_resembles(text, formats)) return *likely;
  if (const MeshFormat* const named = mesh_format_of_name(path, formats)) {
    if (named->is_stream()) return *named;
  }
  throw BadInput(source.name(),
                 fmt::format("this is not a mesh stream: it begins neither as {}; name its format, "
                             "or give a file of another format by name",
                             list_of_formats(is_a_stream, "nor as", formats)),
                 at_byte(0));
}

std::unique_ptr<MeshStreamReader> open_mesh_stream_reader(FileSystem& files,
                                                          const std::string& path,
                                                          const std::string& format_name,
                                                          MeshFormats formats) {
  auto source = std::make_unique<InputBytes>(files.open(path));
  const MeshFormat& format = format_name.empty() ? mesh_stream_format(*source, path, formats)
                                                 : mesh_format(path, format_name, formats);
  if (!format.is_stream()) {
    throw Failure(fmt::format("{}: {} is not a format of streams; {} are", source->name(),
                              format_name, list_of_formats(is_a_stream, "and", formats)),
                  ErrorCode::kInvalidArgument, {.file = source->name()});
  }
  return format.open_stream(std::move(source));
}

}  // namespace spillway::formats
