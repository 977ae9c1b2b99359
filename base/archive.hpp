#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace snare::base {

/// FNV-1a of a text, 64 bits (Fowler, Noll, Vo): tells whether something has changed; no protection against
/// malice.
[[nodiscard]] std::uint64_t fingerprint(std::string_view text) noexcept;

/// Bytes of values in the order in which they are given, numbers bit by bit in this machine's order.
///
/// What a structure consists of is said once, in a function template `fields(archive, structure)` that hands
/// its members to the archive, for writing and for reading alike.
class ByteWriter {
 public:
  template <class Value>
  ByteWriter& operator()(Value& value) {
    if constexpr (std::is_arithmetic_v<Value> || std::is_enum_v<Value>) {
      append(&value, sizeof value);
    } else {
      fields(*this, value);
    }
    return *this;
  }
  ByteWriter& operator()(std::string& text) {
    size(text.size());
    append(text.data(), text.size());
    return *this;
  }
  template <class Value>
  ByteWriter& operator()(std::vector<Value>& values) {
    size(values.size());
    for (Value& v : values) (*this)(v);
    return *this;
  }
  template <int Rows, int Columns>
  ByteWriter& operator()(Eigen::Matrix<double, Rows, Columns>& m) {
    size(static_cast<std::size_t>(m.rows()));
    size(static_cast<std::size_t>(m.cols()));
    append(m.data(), sizeof(double) * static_cast<std::size_t>(m.size()));
    return *this;
  }

  /// What has been written so far, byte by byte; ByteReader takes it.
  [[nodiscard]] const std::string& bytes() const noexcept { return bytes_; }

 private:
  void size(std::size_t n) {
    const std::uint64_t count = n;
    append(&count, sizeof count);
  }
  void append(const void* from, std::size_t count) { bytes_.append(static_cast<const char*>(from), count); }

  std::string bytes_;
};

/// Reads what a ByteWriter has written. Throws std::runtime_error when the bytes end early or a size cannot
/// be.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  template <class Value>
  ByteReader& operator()(Value& value) {
    if constexpr (std::is_same_v<Value, bool>) {
      unsigned char byte = 0;
      take(&byte, 1);
      if (byte > 1) throw std::runtime_error("a yes or no that is neither");
      value = byte == 1;
    } else if constexpr (std::is_arithmetic_v<Value> || std::is_enum_v<Value>) {
      take(&value, sizeof value);
    } else {
      fields(*this, value);
    }
    return *this;
  }
  ByteReader& operator()(std::string& text) {
    text.resize(size(1));
    take(text.data(), text.size());
    return *this;
  }
  template <class Value>
  ByteReader& operator()(std::vector<Value>& values) {
    values.resize(size(1));
    for (Value& v : values) (*this)(v);
    return *this;
  }
  template <int Rows, int Columns>
  ByteReader& operator()(Eigen::Matrix<double, Rows, Columns>& m) {
    const auto rows = static_cast<Eigen::Index>(size(0));
    const auto columns = static_cast<Eigen::Index>(size(0));
    if ((Rows != Eigen::Dynamic && rows != Rows) || (Columns != Eigen::Dynamic && columns != Columns) ||
        (rows > 0 && columns > static_cast<Eigen::Index>(bytes_.size() / sizeof(double)) / rows)) {
      throw std::runtime_error("a matrix of another size than expected");
    }
    m.resize(rows, columns);
    take(m.data(), sizeof(double) * static_cast<std::size_t>(m.size()));
    return *this;
  }

  /// Whether everything has been read: what remains after the last value is a fault of the reader's or of the
  /// bytes.
  [[nodiscard]] bool at_end() const noexcept { return bytes_.empty(); }

 private:
  /// A count of things of at least `least` bytes each.
  std::size_t size(std::size_t least) {
    std::uint64_t count = 0;
    take(&count, sizeof count);
    if (least > 0 ? count > bytes_.size() / least : count > bytes_.size())
      throw std::runtime_error("the bytes end early");
    return static_cast<std::size_t>(count);
  }
  void take(void* to, std::size_t count) {
    if (count > bytes_.size()) throw std::runtime_error("the bytes end early");
    if (count > 0) std::memcpy(to, bytes_.data(), count);
    bytes_.remove_prefix(count);
  }

  std::string_view bytes_;
};

}  // namespace snare::base
