/// \file The image that a surface would give, and how the surface has to move to give the one that there is.
///
/// Voxels that a surface cuts hold parts of inside and outside, and blur mixes their neighbours in. Where m is the part
/// of each voxel inside the surface, blurred as the image is, the image around the surface is f = a + c m, with an
/// outside a and a step c that change slowly (as the local means of Li, Kao, Gore and Ding 2008, key LKGD08, do). The
/// surface that makes the sum of squared differences least lies where the true one does, however wide the blur is and
/// however the surface bends; the strongest derivative along a normal does not.
#pragma once
#include "batten/mesh/mesh.h"
#include "batten/volume/volume.h"

namespace batten {

/// How places of a surface should move along their normals, one row each.
struct ModelMoves {
  Scalars moves;  ///< mm, outwards
  /// 0 to 1: the share of the image's variance around the place that the surface explains, less where the squared
  /// step is below its upper quartile.
  Scalars weights;
};

/// Differences between an image and what a surface would give. set_surface(), moves(), learn_blur(), again.
class ImageModel {
 public:
  /// The blur is taken to be a Gaussian along each index, of one voxel at first. Throws what require_volume() throws.
  explicit ImageModel(Volume image);

  /// fine: closed, outwards, in the world. Throws what inside_volume() throws. Some 30 passes over the volume.
  void set_surface(const Mesh& fine);

  /// One Gauss-Newton step for each place alone: what the difference there, seen through the blur, asks for, where the
  /// surface nearby moves as one. At most the blur's width along the normal. points, normals: N-by-3, in the world.
  ModelMoves moves(const Points& points, const Points& normals) const;

  /// The blur as the differences ask for, one Gauss-Newton step: blurring more adds half the second derivative of m.
  /// At most twice or half the variance; that of the voxels themselves at least.
  void learn_blur();

  /// The variance of the blur along each index, mm^2, with that of the voxels, a twelfth of their squared spacing.
  const Eigen::Vector3d& blur() const { return blur_; }

  /// The variance of the noise around the surface as a share of the image's variance there.
  double noise() const { return noise_; }

 private:
  struct Around;

  void set_blur(const Eigen::Vector3d& variances);
  Around sums_around(const Volume& parts, const Volume& model) const;

  Volume image_;
  Eigen::Vector3d blur_;
  Eigen::Vector3d sigmas_;  ///< of the blur without that of the voxels, in voxels
  Eigen::Vector3d wanted_;  ///< blur_ after a step
  Volume pulls_;            ///< c times the difference, blurred
  Volume steps_;            ///< c
  Volume trust_;            ///< the share of the variance that the model explains
  double noise_ = 0.0;
};

}  // namespace batten
