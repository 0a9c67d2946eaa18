#pragma once
// Values as the bytes of a message between processes, and back. All processes are on one kind of
// machine.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

#include "src/rooms.h"

namespace spillway::runtime {

class Packer {
 public:
  template <typename T>
  requires std::is_trivially_copyable_v<T>
  void put(const T& value) {
    const std::size_t at = bytes_.size();
    bytes_.resize(at + sizeof(T));
    std::memcpy(bytes_.data() + at, &value, sizeof(T));
  }

  /// As they are, without their number.
  void put_bytes(std::span<const std::byte> bytes) {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }

  /// A list of values (a std::string, too) with its length.
  template <typename List>
  void put_list(const List& list) {
    const auto bytes = std::as_bytes(std::span(list.data(), list.size()));
    put(std::uint64_t{list.size()});
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }

  void clear() { bytes_.clear(); }
  [[nodiscard]] std::vector<std::byte> take() { return std::exchange(bytes_, {}); }
  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

/// Takes off what a Packer has put, in the same order. Throws std::length_error if that is not
/// there.
class Unpacker {
 public:
  explicit Unpacker(std::span<const std::byte> bytes) : left_(bytes) {}

  template <typename T>
  requires std::is_trivially_copyable_v<T> T take() {
    T value;
    std::memcpy(&value, take_bytes(sizeof(T)).data(), sizeof(T));
    return value;
  }

  template <typename List>
  List take_list() {
    using Value = typename List::value_type;
    const auto count = take<std::uint64_t>();
    if (count > left_.size() / sizeof(Value)) throw std::length_error("a message ends early");
    List list;
    list.resize(count);
    if (count > 0) {
      std::memcpy(list.data(), take_bytes(count * sizeof(Value)).data(), count * sizeof(Value));
    }
    return list;
  }

  /// So many bytes as they are.
  std::span<const std::byte> take_bytes(std::size_t count) {
    if (count > left_.size()) throw std::length_error("a message ends early");
    const auto taken = left_.first(count);
    left_ = left_.subspan(count);
    return taken;
  }

  [[nodiscard]] bool empty() const { return left_.empty(); }

 private:
  std::span<const std::byte> left_;
};

}  // namespace spillway::runtime
