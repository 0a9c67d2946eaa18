#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "formats/bytes/bytes.h"
#include "formats/points/laz/encoding/integer_encoder.h"
#include "tests/formats/points/laz/laz_encoder/chunk_encoder.h"
#include "tests/formats/points/laz/laz_encoder/laz_file.h"

// The encoder against streams that a reference encoder made of the same values.

namespace spillway::test {
namespace {

std::string from_hex(std::string_view hex) {
  std::string bytes;
  for (std::size_t i = 0; i < hex.size(); i += 2) {
    bytes += static_cast<char>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16));
  }
  return bytes;
}

std::string to_hex(std::string_view bytes) {
  std::string hex;
  for (const char c : bytes) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    hex += {kDigits[static_cast<unsigned char>(c) >> 4], kDigits[c & 15]};
  }
  return hex;
}

std::string finished(laz::ArithmeticEncoder& encoder) {
  std::vector<std::byte> bytes;
  encoder.finish(bytes);
  return std::string(as_text(bytes));
}

TEST(LazEncoder, WritesTheReferenceStreamOfEachKindOfSymbol) {
  laz::ArithmeticEncoder encoder;
  laz::SymbolModel<4> four(4);
  laz::SymbolModel<100> hundred(100);
  laz::BitModel bit;
  for (const unsigned s : {2, 2, 0, 3, 3, 1, 2, 2, 2, 0}) encoder.symbol(s, four);
  for (const unsigned s : {57, 99, 0}) encoder.symbol(s, hundred);
  for (const unsigned b : {1, 0, 0, 1, 1, 1}) encoder.bit(b == 1, bit);
  encoder.raw(19, 5);
  encoder.raw(0xbeef, 16);
  encoder.raw(0xabcdef, 24);
  encoder.raw(0xdeadbeef, 32);
  encoder.symbol(1, four);
  EXPECT_EQ(to_hex(finished(encoder)), "a3d0df38921a486504d3dc9cba72e43c000000");
}

struct Coded {
  std::int32_t prediction;
  std::size_t context;
  std::int32_t value;
  unsigned width;
};

template <unsigned Bits>
std::string encode(laz::IntegerEncoder<Bits>& values, std::span<const Coded> all) {
  laz::ArithmeticEncoder encoder;
  for (const Coded& coded : all) {
    values.encode(encoder, static_cast<std::uint32_t>(coded.prediction),
                  static_cast<std::uint32_t>(coded.value), coded.context);
    EXPECT_EQ(values.width(), coded.width) << coded.prediction << " -> " << coded.value;
  }
  return to_hex(finished(encoder));
}

TEST(LazEncoder, WritesTheReferenceStreamOfIntegers) {
  laz::IntegerEncoder<32> values(2);
  const std::array<Coded, 11> coded = {{{0, 0, 0, 0},
                                        {0, 0, 1, 0},
                                        {0, 1, -1, 1},
                                        {0, 1, 2, 1},
                                        {100, 0, 97, 2},
                                        {1000, 0, 1256, 8},
                                        {-5, 1, 70000, 17},
                                        {-2000000000, 0, 2000000000, 29},
                                        {0, 0, -2147483647 - 1, 32},
                                        {0, 1, 2147483647, 31},
                                        {12345, 1, 12345, 0}}};
  EXPECT_EQ(encode(values, coded), "000f79128c49ea0c864498f2fe7cf8e3b6983f000000");
}

TEST(LazEncoder, WritesTheReferenceStreamOfShortIntegers) {
  laz::IntegerEncoder<16> values(1);
  const std::array<Coded, 6> coded = {{{0, 0, 65535, 1},
                                       {65535, 0, 0, 0},
                                       {1000, 0, 40000, 15},
                                       {40000, 0, 1000, 15},
                                       {500, 0, 500, 0},
                                       {0, 0, 32768, 16}}};
  EXPECT_EQ(encode(values, coded), "0f7948eec07568348468000000");
}

TEST(LazEncoder, WritesTheReferenceChunkTable) {
  LazFile file;
  file.chunk_size = LazFile::kVariable;
  file.table = {{100, 1234}, {50, 999}, {70, 70000}};
  const std::string bytes = file.bytes();
  EXPECT_EQ(to_hex(bytes.substr(file.offset_to_table())),
            "0000000003000000"
            "3c5101e596e466a62cefee000000");
}

TEST(LazEncoder, WritesTheReferencePointwiseChunks) {
  const std::vector<std::string> records = {
      from_hex("2fbb05008bd9090067ebffff517d110200000100f51d1600c0bfd4406d006400640001"),
      from_hex("5abb050096d9090066ebffff831421020000010018451600c0bfd4407f006400720001"),
      from_hex("07bb0500cfd909006eebffff791422020000010018451600c0bfd4407f0064007d0003"),
      from_hex("baba0500c5d909007eebffff791423030000010018451600c0bfd4407b0064007d0003")};
  EXPECT_EQ(to_hex(encode_laz_chunk(laz_items(3, 1, 2), records)),
            "2fbb05008bd9090067ebffff517d110200000100f51d1600c0bfd4406d006400640001c086c4be23a3df"
            "c4461d481bb243721d3c790e14054a332015a3dfb1f6ec4d4fea72b21d54acc80681be75000000");
  EXPECT_EQ(to_hex(encode_laz_chunk(laz_items(3, 1, 1), records)),
            "2fbb05008bd9090067ebffff517d110200000100f51d1600c0bfd4406d00640064000133a53e3c1764af"
            "6d6a90827042ebcfbe0c3cf7c0968200ae21ad81967e71ec1cdab60000");
}

TEST(LazEncoder, WritesTheReferenceLayeredChunks) {
  const std::vector<std::string> records = {
      from_hex("4ce70c008c45f9ff56040000e6084110000000000100142700006085ee4076006400a3076d"),
      from_hex("6bf9f3ff0bc10c00b8eeffffa8a642200200000001000000000060b1ef406400640064006d"),
      from_hex("36e70c00cb45f9ff5b040000e6084310050000000100142700006085ee40760076006aec6d"),
      from_hex("55e70c00ec45f9ff66040000e5084410050000000100142700006085ee40760076005fec6d"),
      from_hex("bef9f3ff14c10c00aeeeffffa8a62120050000000100f02b3b0060b1ef406400640064006b"),
      from_hex("ccf9f3ff22c10c009eeeffffa8a6222005f200000100f02b3b0060b1ef406e006e006e0069"),
      from_hex("6af9f3ff37c10c009aeeffffaaa6212005f20000010005533b0060b1ef406e007a006e0069")};
  EXPECT_EQ(to_hex(encode_laz_chunk(laz_items(7, 1, 3), records)),
            "4ce70c008c45f9ff56040000e6084110000000000100142700006085ee4076006400a3076d070000001e"
            "0000000e0000000a000000000000000d000000000000000a0000000000000012000000160000000a0000"
            "00a26d50d422e7bcff4387abb4b8f10774fccdb32986c82d590c2386000000675bcebd19480f1908d41c"
            "0000000205040282827e000000e55fc7824e2fa71a0d1900000000000000f2f1870000004e7aab308000"
            "001b92dd4a530bd97900000063dd2bd2f1d2beb3ad79c3940f05657d329db1000000000000fefc7e8200"
            "0000");
  EXPECT_EQ(to_hex(encode_laz_chunk(laz_items(7, 1, 4), records)),
            "4ce70c008c45f9ff56040000e6084110000000000100142700006085ee4076006400a3076d070000001e"
            "0000000e0000000a000000000000000d000000000000000a0000000000000012000000100000000a0000"
            "00a26d50d422e7bcff4387abb4b8f10774fccdb32986c82d590c2386000000675bcebd19480f1908d41c"
            "0000000205040282827e000000e55fc7824e2fa71a0d1900000000000000f2f1870000004e7aab308000"
            "001b92dd4a530bd97900000063dd27d6e8d7a20618a0a8aec0000000000000fefd8082000000");
}

}  // namespace
}  // namespace spillway::test
