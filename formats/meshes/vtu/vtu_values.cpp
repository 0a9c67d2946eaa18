#include "formats/meshes/vtu/vtu_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "formats/bytes/bytes.h"
#include "formats/bytes/fields.h"
#include "formats/bytes/line_reader.h"
#include "formats/compression/expansion.h"
#include "formats/points/attributes/record_conversion.h"

namespace spillway::formats {
namespace {

constexpr std::size_t kBuffer = std::size_t{1} << 16;  // a multiple of every number's size
constexpr std::size_t kStep = std::size_t{1} << 20;
constexpr std::size_t kLongestWord = 400;
constexpr std::string_view kWordEnd = " \t\r\n<";

/// One of the numbers that precede an array.
std::uint64_t read_length(VtuBytes& bytes, const VtuCoding& coding) {
  std::array<std::byte, sizeof(std::uint64_t)> room;
  bytes.read(std::span(room).first(size_of(coding.length_type)));
  return *load_index(coding.length_type, room.data(), coding.swaps);
}

/// Throws Failure for bytes that the file cannot hold any more.
void check_room(const VtuBytes& bytes, std::uint64_t wanted, std::string_view what) {
  const std::optional<std::uint64_t> left = bytes.most_left();
  if (!left || wanted <= *left) return;
  fail_in_vtu(bytes.input(),
              fmt::format("{} has {} bytes, but the file ends at byte {}; get a complete copy",
                          what, wanted, *bytes.input().size()));
}

/// The number of its bytes, and these.
class PlainContent final : public VtuContent {
 public:
  PlainContent(VtuBytes& bytes, const VtuCoding& coding)
      : bytes_(bytes), size_(read_length(bytes, coding)), left_(size_) {
    check_room(bytes, size_, "an array");
  }

  std::size_t read(std::span<std::byte> room) override {
    room = room.first(std::min<std::uint64_t>(room.size(), left_));
    bytes_.read(room);
    left_ -= room.size();
    return room.size();
  }

  [[nodiscard]] std::optional<std::uint64_t> size() const override {
    return bytes_.most_left() ? std::optional(size_) : std::nullopt;
  }

 private:
  VtuBytes& bytes_;
  std::uint64_t size_;
  std::uint64_t left_;
};

/// The number of blocks, bytes of a block and of the last one (0: as the others), the compressed
/// bytes of each, and then the blocks.
class BlockContent final : public VtuContent {
 public:
  BlockContent(VtuBytes& bytes, const VtuCoding& coding)
      : bytes_(bytes), compression_(*coding.compression), max_expansion_(coding.max_expansion) {
    const std::uint64_t blocks = read_length(bytes, coding);
    size_of_block_ = read_length(bytes, coding);
    size_of_last_ = read_length(bytes, coding);
    if (size_of_last_ == 0) size_of_last_ = size_of_block_;
    const std::uint64_t each = size_of(coding.length_type);
    check_room(bytes, std::min(blocks, ~std::uint64_t{0} / each) * each, "a list of blocks");
    while (compressed_sizes_.size() < blocks)
      compressed_sizes_.push_back(read_length(bytes, coding));
    bytes.begin_next();
  }

  std::size_t read(std::span<std::byte> room) override {
    std::size_t done = 0;
    while (done < room.size() && (at_ < content_.size() || next_block())) {
      const std::size_t count = std::min(room.size() - done, content_.size() - at_);
      std::copy_n(content_.begin() + static_cast<std::ptrdiff_t>(at_), count,
                  room.begin() + static_cast<std::ptrdiff_t>(done));
      at_ += count;
      done += count;
    }
    return done;
  }

 private:
  /// False after the last block.
  bool next_block() {
    if (block_ == compressed_sizes_.size()) return false;
    const std::uint64_t size = compressed_sizes_[block_];
    const bool is_last = block_ + 1 == compressed_sizes_.size();
    const std::uint64_t wanted = is_last ? size_of_last_ : size_of_block_;
    check_room(bytes_, size, "a block");
    if (expands_too_far(size, wanted, max_expansion_)) {
      fail_in_vtu(bytes_.input(),
                  fmt::format("block {} of an array is said to hold {} bytes in {}, more than {} "
                              "times as many; the file may be corrupt",
                              block_, wanted, size, max_expansion_),
                  Remedy::kExpansion);
    }
    compressed_.clear();
    while (compressed_.size() < size) {
      const std::size_t had = compressed_.size();
      compressed_.resize(had + std::min<std::uint64_t>(kStep, size - had));
      bytes_.read(std::span(compressed_).subspan(had));
    }
    if (!decompress_block(compression_, compressed_, wanted, content_)) {
      fail_in_vtu(bytes_.input(),
                  fmt::format("block {} of an array is corrupt: it does not decompress to {} bytes",
                              block_, wanted));
    }
    ++block_;
    at_ = 0;
    return true;
  }

  VtuBytes& bytes_;
  BlockCompression compression_;
  std::uint64_t max_expansion_;
  std::uint64_t size_of_block_;
  std::uint64_t size_of_last_;
  std::vector<std::uint64_t> compressed_sizes_;
  std::size_t block_ = 0;  // the next one
  std::vector<std::byte> compressed_;
  std::vector<std::byte> content_;  // of the block before it
  std::size_t at_ = 0;              // what has been given out of that
};

/// What numbers in text are kept as.
NumberType kept_type(NumberType type) {
  if (!is_integer(type)) return NumberType::kFloat64;
  const bool is_signed = type == NumberType::kInt8 || type == NumberType::kInt16 ||
                         type == NumberType::kInt32 || type == NumberType::kInt64;
  return is_signed ? NumberType::kInt64 : NumberType::kUint64;
}

/// Numbers in text, each as eight bytes.
class TextContent final : public VtuContent {
 public:
  TextContent(BufferedInput& input, NumberType type) : input_(input), type_(type) {}

  std::size_t read(std::span<std::byte> room) override {
    std::size_t done = 0;
    for (; done + sizeof(double) <= room.size() && next_word(); done += sizeof(double)) {
      put_number(room.data() + done);
    }
    return done;
  }

 private:
  /// False before a tag and at the end of the file.
  bool next_word() {
    word_.clear();
    pass_over_blanks(input_);
    while (!input_.ahead().empty()) {
      const char c = static_cast<char>(input_.ahead().front());
      if (kWordEnd.find(c) != kWordEnd.npos) break;
      word_ += c;
      if (word_.size() > kLongestWord) fail();
      input_.take(1);
    }
    return !word_.empty();
  }

  void put_number(std::byte* at) const {
    Fields field(word_);
    if (!is_integer(type_)) {
      const std::optional<double> number = field.number();
      if (!number) fail();
      // What was computed with was the float, not the decimals that stand for it.
      store(at, type_ == NumberType::kFloat32 ? static_cast<float>(*number) : *number);
    } else if (kept_type(type_) == NumberType::kInt64) {
      const std::optional<std::int64_t> number = field.integer();
      if (!number) fail();
      store(at, *number);
    } else {
      const std::optional<std::uint64_t> number = field.count();
      if (!number) fail();
      store(at, *number);
    }
  }

  [[noreturn]] void fail() const {
    fail_in_vtu(input_, fmt::format("the array holds {}, which is not a number of its type",
                                    quoted(word_)));
  }

  BufferedInput& input_;
  NumberType type_;
  std::string word_;
};

}  // namespace

VtuValues::VtuValues(std::unique_ptr<VtuContent> content, BufferedInput& input, NumberType type,
                     bool swaps)
    : content_(std::move(content)),
      input_(input),
      type_(type),
      swaps_(swaps),
      size_of_one_(size_of(type)),
      buffer_(kBuffer) {}

VtuValues VtuValues::of_binary(VtuBytes& bytes, const VtuCoding& coding, const VtuArray& array) {
  std::unique_ptr<VtuContent> content;
  if (coding.compression) {
    content = std::make_unique<BlockContent>(bytes, coding);
  } else {
    content = std::make_unique<PlainContent>(bytes, coding);
  }
  return {std::move(content), bytes.input(), array.type, coding.swaps};
}

VtuValues VtuValues::of_text(BufferedInput& input, const VtuArray& array) {
  return {std::make_unique<TextContent>(input, array.type), input, kept_type(array.type), false};
}

bool VtuValues::put(NumberType type, std::byte* at) const {
  std::array<std::byte, sizeof(std::uint64_t)> number;
  const std::span<std::byte> bytes = std::span(number).first(size_of_one_);
  std::copy_n(buffer_.begin() + static_cast<std::ptrdiff_t>(at_), size_of_one_, bytes.begin());
  if (swaps_) std::ranges::reverse(bytes);
  if (type == type_) {
    std::ranges::copy(bytes, at);
    return true;
  }
  if (!is_integer(type)) return store_number(type, at, load_number(type_, number.data()));
  return NumberConversion{.from = type_, .to = type}.convert(number.data(), at);
}

std::optional<std::uint64_t> VtuValues::count() const {
  const std::optional<std::uint64_t> size = content_->size();
  return size ? std::optional(*size / size_of_one_) : size;
}

bool VtuValues::refill() {
  at_ = 0;
  end_ = content_->read(buffer_);
  if (end_ % size_of_one_ != 0) {
    fail_in_vtu(input_, fmt::format("an array ends within a number of {} bytes", size_of_one_));
  }
  return end_ > 0;
}

}  // namespace spillway::formats
