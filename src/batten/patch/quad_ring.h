/// \file The one-rings of quads in one walk: their vertices, and four numbers that tell equal surroundings from others.
#pragma once
#include <array>

#include "batten/mesh/topology.h"
#include "batten/scheme/scheme.h"

namespace batten {

/// Sharpness as small numbers: 0 is smooth, 1 infinite, others are the values that occur in a topology.
class SharpnessCodes {
 public:
  static constexpr std::size_t kMost = 64;

  /// O(V + E) where there are tags.
  explicit SharpnessCodes(const Topology& topology);

  /// False where there are too many values.
  bool complete() const { return complete_; }
  std::uint8_t of_edge(Index edge) const { return edges_.empty() ? std::uint8_t{0} : edges_[edge]; }
  std::uint8_t of(float sharpness) const;

 private:
  std::uint8_t intern(float sharpness);

  Buffer<float> values_;        ///< of the codes from 2 on
  Buffer<std::uint8_t> edges_;  ///< E, or empty where no edge is tagged
  bool complete_ = true;
};

/// What FaceRing finds for most quads, in a fraction of its time. A one-ring whose vertices are all different is what
/// its four fans are: how many edges each has, where it is open, how sharp they are.
class QuadRing {
 public:
  /// One number a corner. Equal for two faces of a topology exactly when their one-rings are.
  using Code = std::array<std::uint64_t, 4>;

  /// All faces of the topology are quads; it and the codes must outlive the ring.
  QuadRing(const Topology& topology, const Scheme& scheme, const SharpnessCodes& codes);

  /// The ring of a half-edge's face, from it on. False where FaceRing must be asked: a vertex stands twice in the ring,
  /// a corner has two faces or more than eight edges, there are too many values of sharpness, or Chaikin's rule looks
  /// beyond the ring.
  bool gather(Index half_edge);

  const Code& code() const { return code_; }
  /// The face's own first; the order of the others depends on the code alone.
  const Index* begin() const { return vertices_.data(); }
  const Index* end() const { return vertices_.data() + count_; }

 private:
  static constexpr int kMostEdges = 8;
  static constexpr int kMostVertices = 64;  ///< a corner of eight edges adds 11, one that turns out to have more 13
  static constexpr int kAtOnce = 16;

  struct Fan {
    std::uint64_t sharpness = 0;
    int edges = 0;
  };
  Index turn_left(Index half_edge, Fan& fan);
  bool turn_right(Index half_edge, Fan& fan);
  static Index next(Index h) { return (h & ~3) | ((h + 1) & 3); }
  static Index previous(Index h) { return (h & ~3) | ((h + 3) & 3); }
  bool gather_fan(Index half_edge, std::uint64_t& code);
  void add_edge(Index half_edge, Fan& fan) const;
  void add(Index half_edge) { vertices_[count_++] = topology_.origin(half_edge); }
  bool all_different();

  const Topology& topology_;
  const Scheme& scheme_;
  const SharpnessCodes& codes_;
  bool possible_;
  Code code_{};
  int count_ = 0;
  alignas(64) std::array<Index, kMostVertices> vertices_{};
};

}  // namespace batten
