#pragma once

#include <memory>

#include "formats/disk/file_system.h"
#include "formats/disk/scratch_folder.h"

namespace spillway::formats {

/// An output whose first write() can be written again, wherever `file` leads: all others wait in a
/// scratch file until commit(), which writes everything to `file`. `scratch` must outlive it.
std::unique_ptr<OutputFile> spool_output(std::unique_ptr<OutputFile> file, ScratchFolder& scratch);

}  // namespace spillway::formats
