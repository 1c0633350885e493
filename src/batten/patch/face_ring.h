/// \file A face with its one-ring, cut out and described so that equal surroundings are recognised.
#pragma once
#include <cstring>
#include <string>

#include "batten/mesh/topology.h"
#include "batten/patch/poles.h"
#include "batten/scheme/scheme.h"

namespace batten {

/// Numbers things that are not negative by the order in which they come. A list that is searched through, and a hash
/// table once it is long.
class Numbering {
 public:
  void clear();
  /// The number of a thing; a new one gets the next.
  Index number(Index thing);
  const Buffer<Index>& things() const { return things_; }

 private:
  static constexpr std::size_t kMostSearched = 48;

  std::size_t slot_of(Index thing) const;
  void grow();

  Buffer<Index> things_;
  Buffer<Index> slots_;  ///< numbers, -1 where there is none; as many as a power of two, or none
};

/// Appends a number to a key.
template <typename Number>
void append_bytes(std::string& key, Number number) {
  char bytes[sizeof(Number)];
  std::memcpy(bytes, &number, sizeof(Number));
  key.append(bytes, sizeof(Number));
}

/// Lists the one-ring of a face, from one of its half-edges on, in an order that depends on the surroundings alone.
/// Under Chaikin's rule also the faces around the far ends of semi-sharp edges that leave the face. O(ring).
class FaceRing {
 public:
  static constexpr std::size_t kAnyNumber = static_cast<std::size_t>(-1);

  /// False where the ring has more than `most` vertices.
  bool gather(const Topology& topology, const Scheme& scheme, Index half_edge, std::size_t most = kAnyNumber);
  /// The same, but that the ring has no more faces at a pole (patch/poles.h) than `width` to either side of its own.
  /// The topology need not have others. The ring of a narrower width begins with the same points.
  void gather(const Topology& topology, const Scheme& scheme, Index half_edge, const Poles& poles, int width);

  /// The face's own first, from the half-edge's origin on.
  const Buffer<Index>& vertices() const { return vertices_.things(); }
  /// Rows of values: those of the face's own vertices, of the means of its pole, if it has one, and of other vertices.
  const Buffer<Index>& points() const { return pole_corner_ < 0 ? vertices() : points_; }
  /// One a face, the given one first: where its list starts.
  const Buffer<Index>& half_edges() const { return starts_; }
  /// Equal for two faces exactly when refinement does the same to both for any number of levels: connectivity and the
  /// sharpness of all edges at the face's vertices.
  const std::string& key() const { return key_; }

  /// The corner that is a pole, or -1, and the number of the pole's faces.
  Index pole_corner() const { return pole_corner_; }
  Index pole_faces() const { return pole_faces_; }
  int width() const { return width_; }
  /// The key without the width.
  std::string family() const { return key_.substr(0, family_size_); }

 private:
  void start(const Topology& topology, Index half_edge);
  void add_face(const Topology& topology, Index half_edge);
  bool add_fan(const Topology& topology, Index half_edge, std::size_t most);
  bool add_far_fans(const Topology& topology, const Scheme& scheme, Index size, std::size_t most);
  void add_pole(const Topology& topology, Index half_edge, const Poles& poles);

  Numbering vertices_;
  Buffer<Index> starts_;
  Numbering faces_;
  Buffer<Index> far_ends_;  ///< half-edges that leave the far ends of semi-sharp edges
  std::string key_;
  Buffer<Index> points_;  ///< of a ring at a pole
  Index pole_corner_ = -1;
  Index pole_faces_ = 0;
  int width_ = 0;
  std::size_t family_size_ = 0;
};

/// A part of a topology. Where it was cut, its rules are not the surface's.
struct Cutting {
  Topology topology;
  Buffer<Index> rows;  ///< the vertex that each of its vertices was
};

/// The faces of the given half-edges, in this order, each from its half-edge on. O(what is
/// cut), or O(size of `from`) where that is no more than 64 times as much.
Cutting cut_out(const Topology& from, const Buffer<Index>& half_edges);

}  // namespace batten
