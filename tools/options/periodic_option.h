#pragma once

#include <spillway/periodic.h>

#include <optional>
#include <string>
#include <string_view>

#include "tools/options/command_line.h"

namespace spillway::command {

/// --periodic.
void add_periodic(CommandLine& app, std::string& box);

/// The box of --periodic for so many dimensions; nothing if it is not given. Throws UsageError for
/// one of other dimensions.
std::optional<PeriodicBox> periodic_box(const std::string& box, int dimension);

}  // namespace spillway::command
