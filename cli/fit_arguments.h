/// \file The options of the verb fit.
#pragma once
#include <optional>
#include <string>

#include "batten/fit/fit_surface.h"
#include "cli/arguments.h"
#include "cli/evolution.h"

namespace batten::cli {

/// The words of --init that name no file.
inline constexpr const char* kInitAuto = "auto";
inline constexpr const char* kInitSphere = "sphere";

struct FitArguments {
  CommonArguments common;  ///< input: the points
  PictureArguments picture;
  EvolutionArguments evolution;
  FitMethod method = FitMethod::SquaredDistance;
  std::string init = kInitAuto;  ///< or kInitSphere, or a mesh file
  std::optional<Index> vertices;
  std::optional<int> rounds;
  std::optional<Length> tolerance;
  std::optional<Index> genus;
  std::optional<Length> bridge;
  std::optional<FitCreases> creases;
  std::string residuals;  ///< the points with their distances
};

int run_fit(const FitArguments& arguments);

}  // namespace batten::cli
