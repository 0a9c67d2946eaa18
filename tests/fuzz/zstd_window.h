#pragma once

#include <string_view>

namespace spillway::test {

/// Whether what looks like a frame of zstd (RFC 8878, 3.1.1.1) announces a window of more than
/// 128 MiB. Its decoder asks for as much at once, up to 2 GiB, as
/// formats/compression/decompress.h says; so this is no finding.
bool has_large_zstd_window(std::string_view bytes);

}  // namespace spillway::test
