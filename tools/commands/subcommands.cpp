#include "tools/commands/command.h"

// Each is defined in the file of its name. `batch` comes after those that make outputs: it takes
// over their options.
#define SPILLWAY_SUBCOMMANDS(DO) \
  DO(triangulate)                \
  DO(dem)                        \
  DO(height)                     \
  DO(volume)                     \
  DO(density)                    \
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

namespace {

constexpr bool needs_others(std::string_view name) {
  return name == "batch" || name == "completion" || name == "manual";
}

}  // namespace

std::span<const AddSubcommand> subcommands() {
#define SPILLWAY_LIST(NAME) {#NAME, add_##NAME, needs_others(#NAME)},
  static constexpr AddSubcommand kAll[] = {SPILLWAY_SUBCOMMANDS(SPILLWAY_LIST)};
  return kAll;
}

}  // namespace spillway::command
