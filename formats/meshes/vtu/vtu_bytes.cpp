#include "formats/meshes/vtu/vtu_bytes.h"

#include <fmt/format.h>

#include <algorithm>

#include "formats/bytes/bytes.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

constexpr std::uint64_t kMostBlanks = std::uint64_t{16} << 20;

bool is_blank(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

std::optional<std::uint64_t> bytes_left(const BufferedInput& input) {
  if (!input.size()) return std::nullopt;
  return *input.size() - std::min(*input.size(), input.position());
}

class RawBytes final : public VtuBytes {
 public:
  using VtuBytes::VtuBytes;

  void begin_next() override {}

  [[nodiscard]] std::optional<std::uint64_t> most_left() const override {
    return bytes_left(input());
  }

 private:
  std::size_t read_some(std::span<std::byte> room) override {
    const std::span<const std::byte> ahead = input().ahead();
    const std::size_t count = std::min(ahead.size(), room.size());
    std::copy_n(ahead.begin(), count, room.begin());
    input().skip(count);
    return count;
  }
};

/// The six bits that a character of base64 stands for; kNoDigit for any other one.
constexpr std::uint8_t kNoDigit = 64;
constexpr std::array<std::uint8_t, 256> kDigits = [] {
  std::array<std::uint8_t, 256> digits{};
  digits.fill(kNoDigit);
  constexpr std::string_view kAlphabet =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < kAlphabet.size(); ++i) {
    digits[static_cast<unsigned char>(kAlphabet[i])] = static_cast<std::uint8_t>(i);
  }
  return digits;
}();

class Base64Bytes final : public VtuBytes {
 public:
  using VtuBytes::VtuBytes;

  void begin_next() override {
    if (next_ < end_) fail_in_vtu(input(), "base64 goes on where it should end");
    is_padded_ = false;
  }

  [[nodiscard]] std::optional<std::uint64_t> most_left() const override {
    const std::optional<std::uint64_t> left = bytes_left(input());
    return left ? std::optional(*left / 4 * 3 + 3) : left;
  }

 private:
  std::size_t read_some(std::span<std::byte> room) override {
    std::size_t done = 0;
    while (done < room.size() && (next_ < end_ || decode_group())) {
      room[done++] = static_cast<std::byte>(bits_ >> (16 - 8 * next_++) & 0xff);
    }
    return done;
  }

  /// Decodes the next four characters; false if there are none.
  bool decode_group() {
    if (is_padded_) return false;
    bits_ = 0;
    int digits = 0;
    int padding = 0;
    while (digits + padding < 4) {
      const std::span<const std::byte> ahead = input().ahead();
      const char c = ahead.empty() ? '<' : static_cast<char>(ahead.front());
      if (c == '<' && digits == 0) return false;
      if (ahead.empty()) fail_at_end_of_vtu(input());
      const std::uint8_t digit = kDigits[static_cast<unsigned char>(c)];
      if (digit != kNoDigit && padding == 0) {
        bits_ = bits_ << 6 | digit;
        ++digits;
      } else if (c == '=' && digits >= 2) {
        ++padding;
      } else if (is_blank(c)) {
        pass_over_blanks(input());
        continue;
      } else {
        fail_in_vtu(input(), "base64 is expected here; the file is corrupt");
      }
      input().take(1);
    }
    bits_ <<= 6 * padding;
    is_padded_ = padding > 0;
    next_ = 0;
    end_ = 3 - padding;
    return true;
  }

  std::uint32_t bits_ = 0;  // three bytes, of which [next_, end_) are not yet given out
  int next_ = 0;
  int end_ = 0;
  bool is_padded_ = false;
};

}  // namespace

void fail_in_vtu(const BufferedInput& input, const std::string& what, Remedy remedy) {
  throw BadInput(input.name(), fmt::format("before byte {}: {}", input.position(), what),
                 at_byte(input.position()), remedy);
}

void fail_at_end_of_vtu(const BufferedInput& input) {
  throw BadInput(
      input.name(),
      fmt::format("the file ends at byte {}, in the midst of its data; get a complete copy",
                  input.position()),
      at_byte(input.position()));
}

void pass_over_blanks(BufferedInput& input) {
  const std::uint64_t begin = input.position();
  while (true) {
    const std::string_view ahead = as_text(input.ahead());
    const auto* const end = std::ranges::find_if_not(ahead, is_blank);
    input.skip(static_cast<std::uint64_t>(end - ahead.begin()));
    if (end != ahead.end() || ahead.empty()) return;
    if (input.position() - begin > kMostBlanks) {
      fail_in_vtu(input,
                  fmt::format("there are more than {} blanks; the file is corrupt", kMostBlanks));
    }
  }
}

void VtuBytes::read(std::span<std::byte> room) {
  while (!room.empty()) {
    const std::size_t got = read_some(room);
    if (got == 0) {
      if (input_.ahead().empty()) fail_at_end_of_vtu(input_);
      fail_in_vtu(input_, "the array ends here, before all that its length says");
    }
    room = room.subspan(got);
  }
}

std::unique_ptr<VtuBytes> raw_vtu_bytes(BufferedInput& input) {
  return std::make_unique<RawBytes>(input);
}

std::unique_ptr<VtuBytes> base64_vtu_bytes(BufferedInput& input) {
  return std::make_unique<Base64Bytes>(input);
}

}  // namespace spillway::formats
