// GCC 12 sees an overlap that cannot be in the strings that Boost's gzip_compressor builds.
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wrestrict"
#endif

#include "tests/fuzz/compressed_seeds.h"

#include <lz4.h>
#include <lz4frame.h>

#include <boost/iostreams/filter/bzip2.hpp>
#include <boost/iostreams/filter/gzip.hpp>
#include <boost/iostreams/filter/lzma.hpp>
#include <boost/iostreams/filter/zlib.hpp>
#include <boost/iostreams/filter/zstd.hpp>
#include <boost/iostreams/filtering_stream.hpp>
#include <sstream>

namespace spillway::test {
namespace {

template <typename Compressor>
std::string compressed_by(const Compressor& compressor, const std::string& content) {
  std::ostringstream result;
  boost::iostreams::filtering_ostream stream;
  stream.push(compressor);
  stream.push(result);
  stream << content;
  stream.reset();
  return result.str();
}

std::string lz4_frame(const std::string& content) {
  std::string result(LZ4F_compressFrameBound(content.size(), nullptr), '\0');
  result.resize(
      LZ4F_compressFrame(result.data(), result.size(), content.data(), content.size(), nullptr));
  return result;
}

}  // namespace

std::vector<std::string> compressed_in_all_ways(const std::string& content) {
  namespace io = boost::iostreams;
  return {compressed_by(io::gzip_compressor(), content),
          compressed_by(io::bzip2_compressor(), content),
          compressed_by(io::zstd_compressor(), content), lz4_frame(content)};
}

std::string zlib_compressed(const std::string& content) {
  return compressed_by(boost::iostreams::zlib_compressor(), content);
}

std::string lz4_compressed_block(const std::string& content) {
  std::string result(static_cast<std::size_t>(LZ4_compressBound(int(content.size()))), '\0');
  result.resize(static_cast<std::size_t>(LZ4_compress_default(
      content.data(), result.data(), int(content.size()), int(result.size()))));
  return result;
}

std::string xz_compressed(const std::string& content) {
  return compressed_by(boost::iostreams::lzma_compressor(), content);
}

}  // namespace spillway::test
