# With BATTEN_COMPILED, the folder of another build of these sources, a target is linked from the objects that lie there instead
# of compiling them again: so packages are tried where everything has just been compiled for other reasons.
function(batten_take_compiled target)
  if(NOT BATTEN_COMPILED)
    return()
  endif()
  file(RELATIVE_PATH folder ${PROJECT_BINARY_DIR} ${CMAKE_CURRENT_BINARY_DIR})
  cmake_path(APPEND BATTEN_COMPILED ${folder} CMakeFiles ${target}.dir OUTPUT_VARIABLE there)
  file(GLOB_RECURSE objects ${there}/*.o)
  if(NOT objects)
    message(FATAL_ERROR "there are no objects of ${target} in ${there}: build it there first")
  endif()
  set_source_files_properties(${objects} PROPERTIES EXTERNAL_OBJECT ON)
  set_target_properties(${target} PROPERTIES SOURCES "${objects}" LINKER_LANGUAGE CXX UNITY_BUILD OFF
                                             PRECOMPILE_HEADERS "")
endfunction()
