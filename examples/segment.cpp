#include <cstdio>
#include <cstdlib>

#include "batten/batten.h"
#include "batten/volume/volume_file.h"

/// Makes a small control mesh of one label of a volume, in the world's millimetres.
int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const batten::Volume labels = batten::read_volume(argv[1]);
  const batten::Volume mask = batten::label_mask(labels, {std::atof(argv[2])});
  const batten::Segmentation found = batten::segment_mask(mask);
  const auto measures = batten::measure_surface(found.topology, found.scheme, found.mesh);
  const auto agreement = batten::compare_with_mask(measures.fine, mask);
  std::printf("%d control points, %.1f mm^3, Dice %.3f\n", found.topology.vertex_count(), measures.volume,
              agreement.dice);
  batten::write_mesh(argv[3], found.mesh);
}
