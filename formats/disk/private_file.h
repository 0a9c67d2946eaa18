#pragma once

#include <memory>
#include <string>

#include "formats/disk/file_system.h"

namespace spillway::formats {

/// Creates `path`, which lies in a folder that is private to the run (unfinished_files.h) and has
/// its own name there from the start: who has the folder moves the file to its place, or removes
/// it. `name` is what messages call it. Throws Failure with the system's reason.
std::unique_ptr<OutputFile> create_private_file(const std::string& path, const std::string& name);

}  // namespace spillway::formats
