/// \file What an elastic surface is made of.
#pragma once
#include <vector>

namespace batten {

/// Coefficients are finite and not negative: one for all faces, or one a face of the control mesh. The units are those
/// of ElasticMeasure::Lengths with metres, seconds and kilograms; any other consistent ones do.
struct ElasticMaterial {
  std::vector<double> density{1.0};    ///< mass per area, kg/m^2
  std::vector<double> damping{1.0};    ///< force against the velocity, per area and speed: kg/(m^2 s)
  std::vector<double> tension{100.0};  ///< resists stretching (membrane): N/m
  std::vector<double> rigidity{1.0};   ///< resists bending (thin plate): N m

  /// Like cloth: it bends easily, and stretches ten times as easily as the default.
  static ElasticMaterial soft() { return {{1.0}, {1.0}, {10.0}, {0.01}}; }
  /// Like sheet metal: ten times the default's tension, a hundred times its rigidity.
  static ElasticMaterial stiff() { return {{1.0}, {1.0}, {1000.0}, {100.0}}; }
};

}  // namespace batten
