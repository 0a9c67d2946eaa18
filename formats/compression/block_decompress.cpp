#include "formats/compression/block_decompress.h"

#include <algorithm>
#include <boost/iostreams/device/array.hpp>
#include <boost/iostreams/filter/lzma.hpp>
#include <boost/iostreams/filter/zlib.hpp>
#include <boost/iostreams/filtering_streambuf.hpp>
#include <ios>

#include "formats/compression/lz4.h"

namespace spillway::formats {
namespace {

constexpr std::size_t kStep = std::size_t{1} << 16;

/// A byte of LZ4 stands for at most so many.
constexpr std::uint64_t kMostOfLz4 = 255;

bool decompress_lz4(std::span<const std::byte> compressed, std::uint64_t size,
                    std::vector<std::byte>& content) {
  constexpr std::uint64_t kMost = 0x7fffffff;
  if (compressed.size() > kMost || size > std::min(kMost, compressed.size() * kMostOfLz4)) {
    return false;
  }
  content.resize(size);
  return lz4_decompress(compressed, content);
}

/// A filter of Boost.Iostreams, which is asked for one byte more than there should be.
template <typename Filter>
bool decompress_by(const Filter& filter, std::span<const std::byte> compressed, std::uint64_t size,
                   std::vector<std::byte>& content) {
  const boost::iostreams::array_source source(reinterpret_cast<const char*>(compressed.data()),
                                              compressed.size());
  boost::iostreams::filtering_streambuf<boost::iostreams::input> stream;
  stream.push(filter, kStep);
  stream.push(source);
  content.clear();
  try {
    while (content.size() <= size) {
      const std::size_t had = content.size();
      content.resize(had + std::min<std::uint64_t>(kStep, size + 1 - had));
      const auto got = stream.sgetn(reinterpret_cast<char*>(content.data() + had),
                                    static_cast<std::streamsize>(content.size() - had));
      content.resize(had + static_cast<std::size_t>(got));
      if (got == 0) break;
    }
  } catch (const std::ios_base::failure&) {
    return false;
  }
  return content.size() == size;
}

}  // namespace

bool decompress_block(BlockCompression compression, std::span<const std::byte> compressed,
                      std::uint64_t size, std::vector<std::byte>& content) {
  switch (compression) {
    case BlockCompression::kZlib:
      return decompress_by(boost::iostreams::zlib_decompressor(), compressed, size, content);
    case BlockCompression::kXz:
      return decompress_by(boost::iostreams::lzma_decompressor(), compressed, size, content);
    case BlockCompression::kLz4:
      return decompress_lz4(compressed, size, content);
  }
  return false;
}

}  // namespace spillway::formats
