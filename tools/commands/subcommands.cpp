#include "tools/commands/command.h"

// Each is defined in the file of its name. `batch` comes after those that make outputs: it takes
// over their options.
#define SPILLWAY_SUBCOMMANDS(DO) \
  DO(triangulate)                \
  DO(dem)                        \
  DO(height)                     \
  DO(volume)                     \
  DO(contour)                    \
  DO(render)                     \
  DO(info)                       \
  DO(generate)                   \
  DO(check)                      \
  DO(convert)                    \
  DO(batch)                      \
  DO(completion)                 \
  DO(manual)

namespace spillway::command {

#define SPILLWAY_DECLARE(NAME) Subcommand add_##NAME(CommandLine& root);
SPILLWAY_SUBCOMMANDS(SPILLWAY_DECLARE)

std::span<const AddSubcommand> subcommands() {
#define SPILLWAY_LIST(NAME) add_##NAME,
  static constexpr AddSubcommand kAll[] = {SPILLWAY_SUBCOMMANDS(SPILLWAY_LIST)};
  return kAll;
}

}  // namespace spillway::command
