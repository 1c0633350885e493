# Half the time of a whole build goes into reading Eigen, oneTBB and the standard library once a source. With
# BATTEN_PRECOMPILE they are read once a target. The presets for programs do so; the one for clang does not, and so
# finds a source that leans on an include it does not have.
function(batten_precompile target)
  if(BATTEN_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE <algorithm> <array> <cmath> <functional> <limits> <memory> <numeric>
                              <optional> <span> <string> <unordered_map> <utility> <vector> <Eigen/Geometry> ${ARGN})
  endif()
endfunction()
