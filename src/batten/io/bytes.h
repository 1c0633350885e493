/// \file Numbers as bytes, in the byte order of the file.
#pragma once
#include <bit>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "batten/buffer.h"
#include "batten/io/text_output.h"

namespace batten::io {

enum class ByteOrder { Little, Big };

inline constexpr ByteOrder kNativeOrder =
    __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? ByteOrder::Little : ByteOrder::Big;

template <std::size_t Bytes>
using UnsignedOf = std::conditional_t<
    Bytes == 1, std::uint8_t,
    std::conditional_t<Bytes == 2, std::uint16_t, std::conditional_t<Bytes == 4, std::uint32_t, std::uint64_t>>>;

template <typename Unsigned>
Unsigned reversed_bytes(Unsigned value) {
  if constexpr (sizeof(Unsigned) == 1) return value;
  if constexpr (sizeof(Unsigned) == 2) return static_cast<Unsigned>(__builtin_bswap16(value));
  if constexpr (sizeof(Unsigned) == 4) return static_cast<Unsigned>(__builtin_bswap32(value));
  return static_cast<Unsigned>(__builtin_bswap64(value));
}

/// Reads a number at any address.
template <typename T, ByteOrder Order>
T load(const char* at) {
  UnsignedOf<sizeof(T)> bits;
  std::memcpy(&bits, at, sizeof(T));
  if constexpr (Order != kNativeOrder) bits = reversed_bytes(bits);
  T value;
  std::memcpy(&value, &bits, sizeof(T));
  return value;
}

/// A sequence of little-endian numbers.
class ByteBuffer : public OutputBuffer {
 public:
  template <typename T>
  ByteBuffer& put(T value) {
    UnsignedOf<sizeof(T)> bits;
    std::memcpy(&bits, &value, sizeof(T));
    if constexpr (ByteOrder::Little != kNativeOrder) bits = reversed_bytes(bits);
    std::memcpy(room(sizeof(T)), &bits, sizeof(T));
    grow(sizeof(T));
    return *this;
  }
};

}  // namespace batten::io
