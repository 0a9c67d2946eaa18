#pragma once

#include <string>
#include <vector>

namespace spillway::test {

/// The content by gzip, bzip2, zstd and LZ4.
std::vector<std::string> compressed_in_all_ways(const std::string& content);

/// By zlib and LZ4 alone, and as a stream of xz: what compresses blocks of arrays.
std::string zlib_compressed(const std::string& content);
std::string lz4_compressed_block(const std::string& content);
std::string xz_compressed(const std::string& content);

}  // namespace spillway::test
