#include <fmt/format.h>

#include <utility>

#include "formats/bytes/bytes.h"
#include "formats/bytes/input_source.h"
#include "formats/disk/extension.h"
#include "formats/meshes/common/mesh_stream.h"
#include "formats/meshes/common/mesh_writer.h"
#include "formats/meshes/mesh_format.h"
#include "formats/meshes/sma/sma_reader.h"
#include "formats/meshes/spm/spm_format.h"
#include "formats/meshes/spm/spm_reader.h"
#include "formats/points/point_format.h"
#include "src/error.h"

namespace spillway::detail {
namespace {

constexpr std::size_t kProbe = 4096;

MeshFormat stream_format(InputSource& source, const std::string& path) {
  if (path == "-") source.check_not_empty();
  const std::string_view text = as_text(source.peek(kProbe));
  if (text.starts_with(kSpmMagic)) return MeshFormat::kSpm;
  if (extension_of(path) == "sma" || looks_like_sma(text)) return MeshFormat::kSma;
  if (extension_of(path) == "spm") return MeshFormat::kSpm;
  throw Error(
      fmt::format("{}: this is no mesh stream: it begins neither as spm nor as sma; name its "
                  "format, or give a file of another format by name",
                  source.name()));
}

}  // namespace

std::unique_ptr<MeshStreamReader> open_mesh_stream_reader(FileSystem& files,
                                                          const std::string& path,
                                                          const std::string& format_name) {
  auto source = std::make_unique<InputSource>(files.open(path));
  const MeshFormat format =
      format_name.empty() ? stream_format(*source, path) : mesh_format(path, format_name);
  switch (format) {
    case MeshFormat::kSpm:
      return open_spm_reader(std::move(source));
    case MeshFormat::kSma:
      return open_sma_reader(std::move(source));
    default:
      throw Error(fmt::format("{}: {} is no format of streams; spm and sma are", source->name(),
                              format_name));
  }
}

}  // namespace spillway::detail
