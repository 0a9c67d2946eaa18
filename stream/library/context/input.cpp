#include <spillway/input.h>

#include <algorithm>
#include <memory>

#include "formats/inputs/input_kind.h"
#include "formats/inputs/input_list.h"
#include "src/error.h"
#include "stream/library/context/context_state.h"

namespace spillway {

InputKind kind_of_input(const std::string& path, const Context& context) {
  const std::shared_ptr<formats::ProbedInput> input = context.state().input(path);
  const formats::ContentKind kind = formats::kind_of_content(*input);
  input->release();
  return kind == formats::ContentKind::kPoints ? InputKind::kPoints : InputKind::kMesh;
}

bool stands_for_several(const std::string& path) { return formats::names_several(path); }

std::vector<std::string> expand_inputs(const std::vector<std::string>& paths,
                                       const Context& context) {
  std::vector<std::string> files = formats::expand_paths(paths, context.options().warning);
  if (std::ranges::count(files, "-") > 1) {
    throw runtime::InvalidArgument("standard input can be read only once: give - once");
  }
  return files;
}

}  // namespace spillway
