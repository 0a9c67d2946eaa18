// What formats of several kinds are made of, and the states of runs that go on.

#include <array>
#include <cstring>
#include <memory>
#include <optional>
#include <span>

#include "formats/blocks/block.h"
#include "formats/blocks/columns.h"
#include "formats/bytes/bytes.h"
#include "formats/compression/block_decompress.h"
#include "formats/points/las/geotiff_keys.h"
#include "formats/state/state_reader.h"
#include "formats/state/state_writer.h"
#include "tests/faulty_file_system.h"
#include "tests/fuzz/block_repair.h"
#include "tests/fuzz/compressed_seeds.h"
#include "tests/fuzz/target.h"

namespace spillway::test {
namespace {

std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void read_block(std::string_view bytes) {
  const std::string repaired = with_right_checksums(bytes, 0);
  const std::span<const std::byte> block = std::as_bytes(std::span(repaired));
  if (block.size() < kBlockHeadSize) return;
  const BlockHead head = decode_block_head(block.first<kBlockHeadSize>(), {"a"});
  std::vector<std::byte> content;
  const std::size_t stored = std::min<std::size_t>(head.stored_size, block.size() - kBlockHeadSize);
  decode_block(head, block.subspan(kBlockHeadSize, stored), content, {"a"});
  expect_kept(content.size() == head.content_size, "a block has the size that its head tells");
}

std::vector<std::string> block_seeds() {
  std::vector<std::byte> packed;
  std::vector<std::byte> plain;
  append_block(packed, 1, std::vector<std::byte>(200));
  append_block(plain, 2, as_bytes_of("abc"));
  return {text_of(packed), text_of(plain)};
}

/// The first byte tells the kind of column, the next one how many values.
void read_columns(std::string_view bytes) {
  if (bytes.size() < 2) return;
  const auto kind = static_cast<unsigned char>(bytes[0]) % 4;
  const std::size_t count = 1 + static_cast<unsigned char>(bytes[1]) * 4;
  ColumnReader reader(std::as_bytes(std::span(bytes.substr(2))), {"a"});
  std::vector<double> doubles;
  std::vector<std::uint64_t> wide;
  std::vector<std::uint32_t> narrow;
  std::vector<std::byte> planes;
  if (kind == 0) reader.read(count, doubles);
  if (kind == 1) reader.read(count, wide);
  if (kind == 2) reader.read(count, narrow);
  if (kind == 3) reader.read_byte_planes(count, planes);
  const std::size_t read = doubles.size() + wide.size() + narrow.size() + planes.size();
  expect_kept(read == (kind == 3 ? planes.size() : count),
              "a column has as many values as asked for");
  reader.expect_end();
}

std::vector<std::string> column_seeds() {
  const std::vector<std::uint64_t> numbers = {1, 5, 70'000, 3, 1ULL << 60U};
  const std::vector<double> doubles = {1.5, -0.0, 3e300, 7, 8};
  const std::vector<double> whole = {1, 2, 3, 500, -70'000};
  std::vector<std::string> seeds;
  const auto add = [&](char kind, std::span<const std::byte> bytes) {
    seeds.push_back(std::string{kind, '\1'} + text_of(bytes));
  };
  std::vector<std::byte> out;
  append_column(out, numbers);
  add('\1', out);
  out.clear();
  append_column(out, doubles);
  add('\0', out);
  out.clear();
  append_column(out, whole);
  add('\0', out);
  add('\3', std::vector<std::byte>(15));
  return seeds;
}

/// What a state may be made of.
struct StatePart {
  int number = 0;
  std::string text;
  template <typename State>
  void state(State& state) {
    state(number, text);
  }
};

struct SomeState {
  std::uint64_t count = 7;
  std::vector<double> numbers = {1, 2, 3};
  std::vector<bool> flags = {true, false};
  std::vector<std::vector<StatePart>> parts = {{{1, "one"}, {2, ""}}, {}};
  std::optional<double> maybe;
  std::shared_ptr<const StatePart> shared;
  template <typename State>
  void state(State& state) {
    state.section("whole");
    state(count, numbers, flags, parts, maybe, shared);
  }
};

/// An output in memory that may be brought to a disk.
class StateBytes : public OutputFile {
 public:
  explicit StateBytes(std::string& bytes) : bytes_(bytes) {}
  void write(std::span<const std::byte> bytes) override { bytes_ += text_of(bytes); }
  bool rewrite(std::uint64_t /*offset*/, std::span<const std::byte> /*bytes*/) override {
    return false;
  }
  std::uint64_t sync() override { return bytes_.size(); }
  void commit() override {}
  [[nodiscard]] const std::string& name() const override { return name_; }

 private:
  std::string& bytes_;
  std::string name_ = "state";
};

void read_state(std::string_view bytes) {
  FaultyFileSystem files;
  files.files["state"] = with_right_checksums(bytes, 0);
  StateReader reader(files.open("state"), "the folder");
  SomeState state;
  reader(state);
  reader.finish();
}

std::vector<std::string> state_seeds() {
  std::string bytes;
  StateWriter writer(std::make_unique<StateBytes>(bytes));
  SomeState state;
  state.maybe = 0.5;
  state.shared = std::make_shared<StatePart>();
  writer(state);
  writer.finish();
  return {bytes, with_plain_blocks(bytes, 0)};
}

/// The first byte tells the compression, the next two the size.
void read_compressed(std::string_view bytes) {
  if (bytes.size() < 3) return;
  const auto kind = static_cast<BlockCompression>(static_cast<unsigned char>(bytes[0]) % 3);
  std::uint16_t size = 0;
  std::memcpy(&size, bytes.data() + 1, sizeof(size));
  std::vector<std::byte> content;
  const bool whole =
      decompress_block(kind, std::as_bytes(std::span(bytes.substr(3))), size, content);
  expect_kept(!whole || content.size() == size, "a block has the size that was asked for");
}

std::vector<std::string> compressed_block_seeds() {
  const std::string size("\x20\0", 2);
  const std::string content = "0123012301230123" + std::string(16, '\0');
  return {std::string(1, '\0') + size + zlib_compressed(content),
          std::string(1, '\1') + size + lz4_compressed_block(content),
          std::string(1, '\2') + size + xz_compressed(content)};
}

/// Keys, then doubles, then text: a fuzzer finds out how long each is.
void read_keys(std::string_view bytes) {
  if (bytes.empty()) return;
  GeotiffKeys keys;
  const std::size_t parts = std::min<std::size_t>(
      bytes.size() - 1, std::size_t{8} * static_cast<unsigned char>(bytes[0]));
  const auto some = [&](std::size_t begin, std::size_t size) {
    const std::string_view part = bytes.substr(begin, size);
    const auto all = std::as_bytes(std::span(part));
    return std::vector<std::byte>(all.begin(), all.end());
  };
  keys.directory = some(1, parts);
  const std::string_view rest = bytes.substr(1 + parts);
  keys.numbers = some(1 + parts, rest.size() / 2);
  keys.text = rest.substr(rest.size() / 2);
  read_geotiff_keys(keys);
}

std::vector<std::string> key_seeds() {
  const std::vector<std::byte> keys = geotiff_keys_of(25832, CrsKind::kProjected);
  return {std::string(1, static_cast<char>((keys.size() + 7) / 8)) + text_of(keys)};
}

}  // namespace

std::vector<FuzzTarget> block_targets() {
  return {{"block", read_block, block_seeds},
          {"columns", read_columns, column_seeds},
          {"compressed-block", read_compressed, compressed_block_seeds},
          {"state", read_state, state_seeds},
          {"geotiff-keys", read_keys, key_seeds}};
}

}  // namespace spillway::test
