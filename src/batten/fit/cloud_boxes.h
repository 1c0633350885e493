/// \file Large clouds made smaller: the mean of the points in each small box.
#pragma once
#include "batten/fit/cloud_samples.h"

namespace batten {

/// Replaces the points and normals of a cloud by means over boxes of a size that leaves about `wanted`. Boxes around
/// which there are far fewer points than usual hold outliers and are left out. Sets `outliers`. O(N log N).
void thin_cloud(CloudSamples& samples, Index wanted, const Progress& progress = {});

}  // namespace batten
