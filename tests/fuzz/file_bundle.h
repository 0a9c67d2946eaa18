#pragma once
// Several files as one text of bytes, as a fuzzer makes them: of each a line with its name and its
// size, then its bytes.

#include <map>
#include <string>
#include <string_view>

namespace spillway::test {

std::string bundled(const std::map<std::string, std::string>& files);

/// What can be made of any bytes: a size that is too large means all that is left.
std::map<std::string, std::string> unbundled(std::string_view bytes);

}  // namespace spillway::test
