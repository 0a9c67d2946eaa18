#pragma once

#include <string>
#include <vector>

namespace spillway::test {

/// The content by gzip, bzip2, zstd and LZ4.
std::vector<std::string> compressed_in_all_ways(const std::string& content);

}  // namespace spillway::test
