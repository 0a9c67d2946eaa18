#include "formats/compression/lz4.h"

#include <lz4.h>
#include <lz4frame.h>

#include <new>

namespace spillway::formats {

std::size_t lz4_compress(std::span<const std::byte> content, std::span<std::byte> room) {
  return static_cast<std::size_t>(LZ4_compress_default(
      reinterpret_cast<const char*>(content.data()), reinterpret_cast<char*>(room.data()),
      static_cast<int>(content.size()), static_cast<int>(room.size())));
}

bool lz4_decompress(std::span<const std::byte> compressed, std::span<std::byte> content) {
  const int size = LZ4_decompress_safe(
      reinterpret_cast<const char*>(compressed.data()), reinterpret_cast<char*>(content.data()),
      static_cast<int>(compressed.size()), static_cast<int>(content.size()));
  return size >= 0 && static_cast<std::size_t>(size) == content.size();
}

struct Lz4FrameDecoder::Context {
  Context() {
    if (LZ4F_isError(LZ4F_createDecompressionContext(&frames, LZ4F_VERSION)) != 0) {
      throw std::bad_alloc();
    }
  }
  ~Context() { LZ4F_freeDecompressionContext(frames); }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  LZ4F_dctx* frames = nullptr;
};

Lz4FrameDecoder::Lz4FrameDecoder() : context_(std::make_unique<Context>()) {}

Lz4FrameDecoder::~Lz4FrameDecoder() = default;

Lz4FrameDecoder::Progress Lz4FrameDecoder::decode(std::span<const char> compressed,
                                                  std::span<char> content) {
  // Between frames the library would count on a header, which need not come.
  if (compressed.empty() && complete()) return {};
  Progress progress{compressed.size(), content.size()};
  wanted_ = LZ4F_decompress(context_->frames, content.data(), &progress.produced, compressed.data(),
                            &progress.consumed, nullptr);
  if (LZ4F_isError(wanted_) != 0) throw std::ios_base::failure(LZ4F_getErrorName(wanted_));
  return progress;
}

}  // namespace spillway::formats
