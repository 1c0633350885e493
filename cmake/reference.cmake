# The target `reference`: the public headers as pages, with docs/architecture.md in front. It fails on any warning and on
# any type or free function without a description. Members may have none.
find_package(Doxygen 1.9 QUIET)
if(NOT DOXYGEN_FOUND)
  return()
endif()
set(folder ${PROJECT_BINARY_DIR}/reference)
set(DOXYGEN_PROJECT_NAME Batten)
set(DOXYGEN_PROJECT_NUMBER ${PROJECT_VERSION})
set(DOXYGEN_OUTPUT_DIRECTORY ${folder})
set(DOXYGEN_STRIP_FROM_PATH ${PROJECT_SOURCE_DIR}/src)
set(DOXYGEN_STRIP_FROM_INC_PATH ${PROJECT_SOURCE_DIR}/src)
# The "\file" of these headers is followed by the file's purpose, Doxygen's by a name.
set(DOXYGEN_FILTER_PATTERNS "*.h=\"sed -e '1s|^/// .file |/// \\\\file\\n/// |'\"")
set(DOXYGEN_VERBATIM_VARS DOXYGEN_FILTER_PATTERNS)
set(DOXYGEN_USE_MDFILE_AS_MAINPAGE docs/architecture.md)
set(DOXYGEN_JAVADOC_AUTOBRIEF YES)
set(DOXYGEN_SHOW_INCLUDE_FILES NO)
set(DOXYGEN_SORT_MEMBER_DOCS NO)
set(DOXYGEN_GENERATE_TREEVIEW YES)
set(DOXYGEN_HAVE_DOT NO)
set(DOXYGEN_QUIET YES)
set(DOXYGEN_WARN_LOGFILE ${folder}/warnings.txt)
doxygen_add_docs(reference_pages docs/architecture.md ${BATTEN_HEADERS} ${BATTEN_RENDER_HEADERS} ${BATTEN_VOLUMES_HEADERS}
                 WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
add_custom_target(reference COMMAND ${CMAKE_COMMAND} -DWARNINGS=${folder}/warnings.txt
                                    -P ${PROJECT_SOURCE_DIR}/cmake/reference_warnings.cmake)
add_dependencies(reference reference_pages)
