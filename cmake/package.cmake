# Debian packages: the preset `package`, then cpack -G DEB in its folder (docs/library.md).
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME batten)
set(CPACK_PACKAGE_CONTACT "The Batten authors <batten@users.noreply.github.com>")
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_COMPONENTS_ALL tool library pictures development)
if(BATTEN_WITH_VOLUMES)
  list(APPEND CPACK_COMPONENTS_ALL volumes)
endif()
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
    WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR})
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)

# batten_deb(COMPONENT PACKAGE SECTION SUMMARY DESCRIPTION): describes a package, with its copyright and changelog.
macro(batten_deb component package section summary description)
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${package})
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section})
  set(CPACK_COMPONENT_${upper}_DESCRIPTION "${summary}\n${description}")
  install(FILES ${PROJECT_BINARY_DIR}/changelog.Debian.gz DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package}
          COMPONENT ${component} EXCLUDE_FROM_ALL)
  install(FILES ${PROJECT_BINARY_DIR}/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package}
          COMPONENT ${component} EXCLUDE_FROM_ALL)
endmacro()

set(about "Finds the control mesh whose Catmull-Clark or Loop subdivision surface
passes through the vertices of a mesh, and says how exactly.")
batten_deb(tool batten graphics "smooth surfaces through the points of a mesh" "${about}")
batten_deb(library libbatten${BATTEN_SOVERSION} libs "subdivision surfaces through data (library)" "${about}")
batten_deb(pictures libbatten-render${BATTEN_SOVERSION} libs "pictures of subdivision surfaces (library)"
           "Draws meshes and plots for libbatten${BATTEN_SOVERSION}.")
batten_deb(development libbatten-dev libdevel "subdivision surfaces through data (development files)" "${about}")
set(CPACK_COMPONENT_TOOL_DEPENDS library pictures)
set(CPACK_COMPONENT_PICTURES_DEPENDS library)
set(CPACK_COMPONENT_DEVELOPMENT_DEPENDS library pictures)
if(BATTEN_WITH_VOLUMES)
  batten_deb(volumes libbatten-volumes${BATTEN_SOVERSION} libs "volumes for subdivision surfaces (library)"
             "Reads and writes NIfTI, NRRD, MetaImage and DICOM for libbatten${BATTEN_SOVERSION}.")
  list(APPEND CPACK_COMPONENT_TOOL_DEPENDS volumes)
  list(APPEND CPACK_COMPONENT_DEVELOPMENT_DEPENDS volumes)
  set(CPACK_COMPONENT_VOLUMES_DEPENDS library)
  set(CPACK_DEBIAN_VOLUMES_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/triggers)
endif()
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/triggers)
set(CPACK_DEBIAN_PICTURES_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/triggers)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS libeigen3-dev)
set(CPACK_DEBIAN_TOOL_PACKAGE_RECOMMENDS fonts-dejavu-core)

file(WRITE ${PROJECT_BINARY_DIR}/triggers "activate-noawait ldconfig\n")
file(WRITE ${PROJECT_BINARY_DIR}/copyright "Copyright: 2026 The Batten authors
License: Apache-2.0, as in /usr/share/common-licenses/Apache-2.0 on Debian systems
")
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE ${PROJECT_BINARY_DIR}/changelog.Debian
  "batten (${PROJECT_VERSION}-1) unstable; urgency=medium\n\n  * CHANGELOG.md tells.\n\n -- ${CPACK_PACKAGE_CONTACT}  ${date}\n")
execute_process(COMMAND gzip -9nf ${PROJECT_BINARY_DIR}/changelog.Debian COMMAND_ERROR_IS_FATAL ANY)
include(CPack)
