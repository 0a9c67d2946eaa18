#pragma once

#include <spillway/context.h>
#include <spillway/export.h>

#include <string>
#include <vector>

namespace spillway {

enum class InputKind { kPoints, kMesh };

/// What an input holds, by its first bytes and its name; points if neither tells of a mesh. "-" is
/// standard input. What the look reads of a pipe is not lost: whoever opens the input with the same
/// context gets it. Throws Error (kInputOutput) if the input cannot be opened.
SPILLWAY_API InputKind kind_of_input(const std::string& path, const Context& context);

/// Whether a path stands for several files: a folder, a pattern or a list (open_points()).
SPILLWAY_API bool stands_for_several(const std::string& path);

/// The files that paths stand for, in their order. Throws Error for what is not there, and
/// kInvalidArgument if standard input is there twice. What is worth a warning goes to the context.
SPILLWAY_API std::vector<std::string> expand_inputs(const std::vector<std::string>& paths,
                                                    const Context& context);

}  // namespace spillway
