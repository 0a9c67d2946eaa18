#include <spillway/version.h>

namespace spillway {

std::string_view version() noexcept { return SPILLWAY_VERSION_TEXT; }

}  // namespace spillway
