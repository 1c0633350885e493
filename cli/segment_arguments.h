/// \file The options of the verb segment.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "batten/volume/segment_volume.h"
#include "cli/arguments.h"
#include "cli/evolution.h"
#include "cli/job.h"

namespace batten::cli {

struct SegmentArguments {
  CommonArguments common;  ///< input: the volume
  PictureArguments picture;
  EvolutionArguments evolution;
  std::string mask;                 ///< a volume of labels; empty: the input
  std::vector<double> labels;       ///< empty: all but 0
  bool together = false;            ///< each label a surface of its own
  std::vector<std::string> points;  ///< on the surface, files of them; empty: none
  std::optional<Index> slices;      ///< points are the labels' borders in every n-th slice
  std::vector<double> seed;         ///< x, y, z in the part; empty: none
  std::vector<double> numbers;      ///< least and greatest number of the part around the seed; empty: found
  std::string start;                ///< a mesh to start from; empty: none
  bool edges = false;               ///< draw the surface of the labels to the image's edges
  std::optional<Index> vertices;
  std::optional<Index> genus;
  double smoothing = 0.15;  ///< in voxels
  int levels = -1;          ///< -1: write the control mesh, or for GLB at most 3
  WorldSpace space = WorldSpace::Ras;
  std::string overlay;  ///< picture of slices
  std::string inside;   ///< volume of the inside
  bool parts = false;   ///< of each voxel, instead of centres
};

int run_segment(const SegmentArguments& arguments);
/// Of several labels, each a surface of its own.
int run_segment_together(const SegmentArguments& arguments, const Volume& image, const SegmentRequest& request,
                         Job& job);

}  // namespace batten::cli
