# Half of the time of a whole build is spent on reading Eigen and the standard library for each source. With
# BATTEN_PRECOMPILE they are read once for each target. The preset that clang-tidy reads does not use it: so a source that
# lacks an include is found.
function(batten_precompile target)
  if(BATTEN_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE <algorithm> <array> <cmath> <functional> <limits> <memory> <numeric>
                              <optional> <span> <string> <unordered_map> <utility> <vector> <Eigen/Geometry> ${ARGN})
  endif()
endfunction()

# All programs of a folder, which have the same flags, share what was read for the first of them.
function(batten_precompile_once folder)
  get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  list(POP_FRONT targets first)
  batten_precompile(${first} <Eigen/SparseCore>)
  if(BATTEN_PRECOMPILE)
    foreach(target IN LISTS targets)
      target_precompile_headers(${target} REUSE_FROM ${first})
    endforeach()
  endif()
endfunction()
