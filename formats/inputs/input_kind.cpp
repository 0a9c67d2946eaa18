#include "formats/inputs/input_kind.h"

#include <string_view>
#include <utility>

#include "formats/bytes/bytes.h"
#include "formats/disk/extension.h"
#include "formats/inputs/open_mesh.h"
#include "formats/inputs/open_points.h"
#include "formats/meshes/sma/sma_reader.h"
#include "formats/meshes/spm/spm_format.h"
#include "formats/points/common/point_reader.h"
#include "formats/points/point_format.h"

namespace spillway::detail {
namespace {

constexpr std::size_t kProbe = 4096;

}  // namespace

InputSource& ProbedInput::source() {
  if (!source_) source_ = std::make_unique<InputSource>(files_.open(path_));
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

InputKind kind_of_input(ProbedInput& input) {
  const bool is_pipe = input.is_pipe();
  const std::string extension = extension_of(input.path());
  const bool is_named_stream = extension == "spm" || extension == "sma";
  if (!is_pipe && !input.exists(input.path()) && !is_named_stream) {
    // An npy mesh may go by a name that no file has.
    return is_mesh(input.beneath(), input.path()) ? InputKind::kMesh : InputKind::kPoints;
  }
  InputSource& source = input.source();
  const std::string_view text = as_text(source.peek(kProbe));
  if (text.starts_with(kSpmMagic) || text.starts_with(kSmaNote)) return InputKind::kMeshStream;
  if (is_named_stream && !begins_as_points(source.peek(kProbe))) {
    return mesh_format_of_content(source) ? InputKind::kMesh : InputKind::kMeshStream;
  }
  if (!is_pipe && is_mesh(input.beneath(), input.path())) return InputKind::kMesh;
  return looks_like_sma(text) ? InputKind::kMeshStream : InputKind::kPoints;
}

}  // namespace spillway::detail
