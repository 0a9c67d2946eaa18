#pragma once

#include <string>

#include "formats/disk/scratch_folder.h"
#include "formats/inputs/input_kind.h"
#include "tools/report/progress.h"

namespace spillway::detail {

/// A mesh that is to be written in another format.
struct MeshConversion {
  std::string input_format;  ///< a name of mesh_format_names(); empty: by content and name
  std::string output;
  std::string output_format;  ///< likewise; empty: by name
};

/// Writes the mesh of `input`, which is of that kind, and says how large it is. An spm stream goes
/// through block by block, other meshes are read as a whole. Throws Error, and UsageError if the
/// output is of no mesh format.
void convert_mesh(ProbedInput& input, InputKind kind, const MeshConversion& conversion,
                  ScratchFolder& scratch, Progress& progress);

}  // namespace spillway::detail
