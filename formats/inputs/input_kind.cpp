#include "formats/inputs/input_kind.h"

#include <string_view>
#include <utility>

#include "formats/bytes/bytes.h"
#include "formats/inputs/open_mesh.h"
#include "formats/inputs/open_points.h"

namespace spillway::formats {
namespace {

constexpr std::size_t kProbe = 4096;

}  // namespace

InputBytes& ProbedInput::source() {
  if (!source_) source_ = std::make_unique<InputBytes>(files_.open(path_));
  return *source_;
}

bool ProbedInput::is_pipe() { return path_ == "-" || (exists(path_) && !source().size()); }

void ProbedInput::release() {
  if (source_ && !is_pipe()) source_.reset();
}

std::unique_ptr<InputFile> ProbedInput::open(const std::string& path) {
  if (path == path_ && source_) return std::move(source_);
  return files_.open(path);
}

ContentKind kind_of_content(ProbedInput& input, MeshFormats formats) {
  const bool is_pipe = input.is_pipe();
  const MeshFormat* const named = mesh_format_of_name(input.path(), formats);
  const bool is_named_stream = named != nullptr && named->is_stream();
  if (!is_pipe && !input.exists(input.path()) && !is_named_stream) {
    // A mesh in several files may go by a name that no file has.
    return is_mesh(input.beneath(), input.path(), formats) ? ContentKind::kMesh
                                                           : ContentKind::kPoints;
  }
  InputBytes& source = input.source();
  const MeshFormat* const told = mesh_format_of_content(source, formats);
  if (told != nullptr && told->is_stream()) return ContentKind::kMeshStream;
  if (is_named_stream && !begins_as_points(source.peek(kProbe))) {
    return told != nullptr ? ContentKind::kMesh : ContentKind::kMeshStream;
  }
  if (!is_pipe && is_mesh(input.beneath(), input.path(), formats)) return ContentKind::kMesh;
  const bool resembles =
      stream_format_that_resembles(as_text(source.peek(kProbe)), formats) != nullptr;
  return resembles ? ContentKind::kMeshStream : ContentKind::kPoints;
}

}  // namespace spillway::formats
