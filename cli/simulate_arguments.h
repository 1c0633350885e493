/// \file The options of simulate.
#pragma once
#include <optional>
#include <string>

#include "cli/arguments.h"

namespace batten::cli {

struct SimulateArguments {
  CommonArguments common;  ///< input: the scene
  PictureArguments picture;
  int levels = -1;  ///< -1: as the scene says, or else the control mesh, or for GLB at most 3
  std::optional<double> seconds;
  std::optional<double> step;
  bool equilibrium = false;    ///< the static solution instead of a motion
  std::optional<int> moments;  ///< panels of the picture
  std::string plot;            ///< energies against time
  std::string state;           ///< where the run may go on
  std::string resume;          ///< where an earlier run ended
};

int run_simulate(const SimulateArguments& arguments);

}  // namespace batten::cli
