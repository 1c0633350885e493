/// \file Parts of base faces as control points of their own, halved repeatedly.
#pragma once
#include <memory>
#include <vector>

#include "batten/patch/level_values.h"
#include "batten/patch/surface_patches.h"

namespace batten {

/// A square or triangular part of a base face: the face after `level` halvings towards it.
struct CellNet {
  enum class Kind : std::uint8_t {
    Patch,   ///< points: 16 (12) of a regular patch, complete
    Ring,    ///< points: the one-ring, with the cell's own corners first
    Several  ///< no points: a cell of several pieces
  };
  Kind kind = Kind::Several;
  bool turned = false;
  Index face = 0;
  Index ring = 0;  ///< ring type
  int level = 0;
  double u = 0.0;  ///< of corner 0, in the base face
  double v = 0.0;
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> points;
};

/// Computes the nets of base faces and of their parts. Const and safe to share between threads.
class CellNets {
 public:
  /// control: V-by-3. O(H).
  CellNets(const SurfacePatches& patches, ConstValuesRef control);

  const Topology& base() const { return patches_.base(); }
  bool quads() const { return patches_.quads(); }
  void root(Index face, CellNet& net) const;
  /// The four children in the forest's order (adaptive/cell_forest.h).
  void children(const CellNet& net, std::array<CellNet, 4>& children) const;
  /// The limit position at a corner of a patch.
  Eigen::Vector3d patch_corner(const CellNet& net, int corner) const;

 private:
  void find(CellNet& net) const;
  void halve_patch(const CellNet& net, std::array<CellNet, 4>& children) const;
  void halve_ring(const CellNet& net, std::array<CellNet, 4>& children) const;

  SurfacePatches patches_;
  Values base_values_;
  LevelValues values_;
};

}  // namespace batten
