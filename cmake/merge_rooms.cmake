# With BATTEN_MERGE_ROOMS the sources of a room, or the tests of one, are compiled as one, which takes a third of the time; for
# builds that are made once and thrown away. Within a room no two sources may therefore give one name to two things. Sources with compile options of their own stay alone.
function(batten_merge_rooms target)
  if(NOT BATTEN_MERGE_ROOMS)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    cmake_path(GET source PARENT_PATH room)
    cmake_path(GET room FILENAME room)
    if(room STREQUAL "")
      set(room ${target})
    endif()
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${room})
  endforeach()
  # Each source's own names are still its own; these two take a merged source for a header.
  target_compile_options(${target} PRIVATE -Wno-shadow $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()
