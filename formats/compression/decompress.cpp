#include "formats/compression/decompress.h"

#include <fmt/format.h>
#include <zstd.h>
#include <zstd_errors.h>

#include <boost/iostreams/categories.hpp>
#include <boost/iostreams/filter/bzip2.hpp>
#include <boost/iostreams/filter/gzip.hpp>
#include <boost/iostreams/filtering_streambuf.hpp>
#include <ios>
#include <new>
#include <string_view>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/compression/expansion.h"
#include "formats/compression/lz4_filter.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

constexpr std::size_t kCompressedBuffer = std::size_t{128} << 10;

// The largest window that zstd writes (--long=31), and that its library can read.
constexpr int kZstdWindowLog = 31;

[[noreturn]] void fail(const InputBytes& source, std::string_view format) {
  throw BadInput(
      source.name(),
      fmt::format("the {} data is corrupt or ends early, before byte {}; get a fresh copy", format,
                  source.position()),
      at_byte(source.position()));
}

/// Gives an InputBytes to Boost.Iostreams.
class SourceDevice {
 public:
  using char_type = char;
  using category = boost::iostreams::source_tag;

  explicit SourceDevice(InputBytes& source) : source_(&source) {}

  std::streamsize read(char* buffer, std::streamsize count) {
    const std::span bytes(reinterpret_cast<std::byte*>(buffer), static_cast<std::size_t>(count));
    const std::size_t got = source_->read(bytes);
    return got == 0 ? -1 : static_cast<std::streamsize>(got);
  }

 private:
  InputBytes* source_;
};

/// Gzip, bzip2 and LZ4, through Boost.Iostreams.
class BoostInput : public InputFile {
 public:
  BoostInput(InputBytes& source, Compression compression)
      : source_(source), format_(name_of(compression)) {
    if (compression == Compression::kGzip) {
      stream_.push(boost::iostreams::gzip_decompressor(), kCompressedBuffer);
    } else if (compression == Compression::kBzip2) {
      stream_.push(boost::iostreams::bzip2_decompressor(), kCompressedBuffer);
    } else {
      stream_.push(Lz4Decompressor(), kCompressedBuffer);
    }
    stream_.push(SourceDevice(source), kCompressedBuffer);
  }

  std::size_t read(std::span<std::byte> buffer) override {
    try {
      const auto got = stream_.sgetn(reinterpret_cast<char*>(buffer.data()),
                                     static_cast<std::streamsize>(buffer.size()));
      return static_cast<std::size_t>(got);
    } catch (const std::ios_base::failure&) {
      fail(source_, format_);
    }
  }

  [[nodiscard]] std::optional<std::uint64_t> size() const override { return std::nullopt; }
  [[nodiscard]] const std::string& name() const override { return source_.name(); }

 private:
  InputBytes& source_;
  std::string_view format_;
  boost::iostreams::filtering_streambuf<boost::iostreams::input> stream_;
};

/// Zstandard, through its own library: Boost's filter takes truncated data for complete.
class ZstdInput : public InputFile {
 public:
  explicit ZstdInput(InputBytes& source)
      : source_(source), context_(ZSTD_createDCtx()), compressed_(kCompressedBuffer) {
    if (!context_) throw std::bad_alloc();
    ZSTD_DCtx_setParameter(context_.get(), ZSTD_d_windowLogMax, kZstdWindowLog);
  }

  std::size_t read(std::span<std::byte> buffer) override {
    ZSTD_outBuffer out{buffer.data(), buffer.size(), 0};
    while (out.pos < out.size) {
      if (in_.pos == in_.size && !output_pending_ && !refill()) break;
      const std::size_t full = out.pos;
      frame_left_ = ZSTD_decompressStream(context_.get(), &out, &in_);
      if (ZSTD_isError(frame_left_) != 0) fail_for(ZSTD_getErrorCode(frame_left_));
      output_pending_ = frame_left_ != 0 && out.pos == out.size && out.pos > full;
    }
    return out.pos;
  }

  [[nodiscard]] std::optional<std::uint64_t> size() const override { return std::nullopt; }
  [[nodiscard]] const std::string& name() const override { return source_.name(); }

 private:
  struct Free {
    void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
  };

  [[noreturn]] void fail_for(ZSTD_ErrorCode code) const {
    if (code == ZSTD_error_memory_allocation || code == ZSTD_error_frameParameter_windowTooLarge) {
      throw BadInput(source_.name(),
                     "there is not enough memory for the window of this zstd data, which may take "
                     "up to 2 GiB (--long=31); decompress it first, or compress it again without "
                     "--long");
    }
    fail(source_, "zstd");
  }

  /// False at the end of the data, which must be the end of a frame.
  bool refill() {
    const std::size_t got = source_.read(compressed_);
    if (got == 0 && frame_left_ != 0) fail(source_, "zstd");
    in_ = {compressed_.data(), got, 0};
    return got > 0;
  }

  InputBytes& source_;
  std::unique_ptr<ZSTD_DCtx, Free> context_;
  std::vector<std::byte> compressed_;
  ZSTD_inBuffer in_{nullptr, 0, 0};
  std::size_t frame_left_ = 1;   // 0 once a frame is complete; a file without any frame is corrupt
  bool output_pending_ = false;  // the last call filled the buffer and may have had more to give
};

/// What another input holds, which must not become much more than its source has given.
class LimitedExpansion : public InputFile {
 public:
  LimitedExpansion(std::unique_ptr<InputFile> content, const InputBytes& source,
                   Compression compression, std::uint64_t max_expansion)
      : content_(std::move(content)),
        source_(source),
        compression_(compression),
        max_expansion_(max_expansion) {}

  std::size_t read(std::span<std::byte> buffer) override {
    const std::size_t got = content_->read(buffer);
    given_ += got;
    if (expands_too_far(source_.position(), given_, max_expansion_)) {
      throw BadInput(
          source_.name(),
          fmt::format("the {} data expands to more than {} times its size, before byte {}",
                      name_of(compression_), max_expansion_, source_.position()),
          at_byte(source_.position()), Remedy::kExpansion);
    }
    return got;
  }

  [[nodiscard]] std::optional<std::uint64_t> size() const override { return std::nullopt; }
  [[nodiscard]] const std::string& name() const override { return source_.name(); }

 private:
  std::unique_ptr<InputFile> content_;
  const InputBytes& source_;
  Compression compression_;
  std::uint64_t max_expansion_;
  std::uint64_t given_ = 0;
};

std::unique_ptr<InputFile> unlimited(InputBytes& source, Compression compression) {
  if (compression == Compression::kZstd) return std::make_unique<ZstdInput>(source);
  return std::make_unique<BoostInput>(source, compression);
}

}  // namespace

Compression compression_of_name(const std::string& path) {
  if (path.ends_with(".gz")) return Compression::kGzip;
  if (path.ends_with(".bz2")) return Compression::kBzip2;
  if (path.ends_with(".zst")) return Compression::kZstd;
  if (path.ends_with(".lz4")) return Compression::kLz4;
  return Compression::kNone;
}

std::string_view name_of(Compression compression) {
  switch (compression) {
    case Compression::kGzip:
      return "gzip";
    case Compression::kBzip2:
      return "bzip2";
    case Compression::kZstd:
      return "zstd";
    case Compression::kLz4:
      return "LZ4";
    case Compression::kNone:
      break;
  }
  return "nothing";
}

Compression compression_of_content(std::span<const std::byte> first_bytes) {
  const std::string_view text = as_text(first_bytes);
  if (text.starts_with("\x1f\x8b")) return Compression::kGzip;
  if (text.starts_with("BZh")) return Compression::kBzip2;
  if (text.starts_with("\x28\xb5\x2f\xfd")) return Compression::kZstd;
  if (text.starts_with("\x04\x22\x4d\x18")) return Compression::kLz4;
  return Compression::kNone;
}

std::unique_ptr<InputFile> decompressed(InputBytes& source, Compression compression,
                                        std::uint64_t max_expansion) {
  return std::make_unique<LimitedExpansion>(unlimited(source, compression), source, compression,
                                            max_expansion);
}

}  // namespace spillway::formats
