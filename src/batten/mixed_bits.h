/// \file Bits mixed so that similar numbers become different ones.
#pragma once
#include <cstdint>

namespace batten {

/// The finalizer of SplitMix64 (Steele, Lea and Flood 2014): a bijection in which each bit depends on all.
inline std::uint64_t mixed_bits(std::uint64_t bits) {
  bits = (bits ^ (bits >> 30U)) * 0xbf58476d1ce4e5b9U;
  bits = (bits ^ (bits >> 27U)) * 0x94d049bb133111ebU;
  return bits ^ (bits >> 31U);
}

}  // namespace batten
