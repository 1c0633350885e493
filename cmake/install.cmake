# What `cmake --install` installs and where: the tool, the libraries with their public headers, the files for find_package and
# pkg-config, the documentation. No installed file contains a path of this machine, so the folder can be moved.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(BATTEN_CONFIG_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/batten)

# target export component: installs a library and exports it for find_package
function(batten_install_library target export component)
  install(TARGETS ${target} EXPORT ${export}
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${component} NAMELINK_COMPONENT development
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
          FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
  install(EXPORT ${export} NAMESPACE batten:: DESTINATION ${BATTEN_CONFIG_DIR} COMPONENT development)
endfunction()

# Users of a static library must link what it uses; a shared library is already linked with it.
function(batten_install_pkg_config name description requires static_requires libraries static_libraries)
  set(BATTEN_PC_NAME ${name})
  set(BATTEN_PC_DESCRIPTION ${description})
  set(BATTEN_PC_REQUIRES "${requires}")
  set(BATTEN_PC_LIBRARIES "${libraries}")
  if(NOT BUILD_SHARED_LIBS)
    string(STRIP "${requires} ${static_requires}" BATTEN_PC_REQUIRES)
    string(STRIP "${libraries} ${static_libraries}" BATTEN_PC_LIBRARIES)
  endif()
  file(RELATIVE_PATH BATTEN_PC_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
  string(REGEX REPLACE "/$" "" BATTEN_PC_PREFIX "${BATTEN_PC_PREFIX}")
  configure_file(cmake/library.pc.in ${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
endfunction()

batten_install_library(batten batten-targets library)
set(packages "")
if(BATTEN_WITH_TBB)
  string(APPEND packages "tbb ")
endif()
if(BATTEN_WITH_GLTF)
  string(APPEND packages "tinygltf ")
endif()
if(BATTEN_WITH_ZLIB)
  string(APPEND packages "zlib ")
endif()
batten_install_pkg_config(batten "Subdivision surfaces through data" eigen3 "${packages}" -lbatten -pthread)
if(BATTEN_WITH_RENDER)
  batten_install_library(batten_render batten-render-targets pictures)
  batten_install_pkg_config(batten-render "Pictures of subdivision surfaces" "batten = ${PROJECT_VERSION}" "libpng cairo cairo-svg"
                            -lbatten_render -lembree3)
endif()

if(BATTEN_WITH_VOLUMES)
  set(itk_flags "")
  foreach(library IN LISTS ITK_LIBRARIES)  # targets, whose files carry ITK's version
    if(TARGET ${library})
      get_target_property(file ${library} LOCATION)
      if(file MATCHES "/lib([^/]*)[.](so|a)")
        list(APPEND itk_flags -l${CMAKE_MATCH_1})
      endif()
    endif()
  endforeach()
  list(REMOVE_DUPLICATES itk_flags)
  list(JOIN itk_flags " " itk_flags)
  batten_install_library(batten_volumes batten-volumes-targets volumes)
  batten_install_pkg_config(batten-volumes "Files of volumes for subdivision surfaces" "batten = ${PROJECT_VERSION}" zlib
                            -lbatten_volumes "${itk_flags}")
endif()

configure_package_config_file(cmake/batten-config.cmake.in batten-config.cmake INSTALL_DESTINATION ${BATTEN_CONFIG_DIR})
write_basic_package_version_file(batten-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/batten-config.cmake ${PROJECT_BINARY_DIR}/batten-config-version.cmake
        DESTINATION ${BATTEN_CONFIG_DIR} COMPONENT development)

if(BATTEN_BUILD_CLI)
  if(BUILD_SHARED_LIBS)
    file(RELATIVE_PATH up /${CMAKE_INSTALL_BINDIR} /${CMAKE_INSTALL_LIBDIR})
    set_target_properties(batten_tool PROPERTIES INSTALL_RPATH "$ORIGIN/${up}")
  endif()
  install(TARGETS batten_tool RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT tool)
  find_program(HELP2MAN help2man)
  if(HELP2MAN)
    add_custom_command(OUTPUT batten.1.gz DEPENDS batten_tool
                       COMMAND ${HELP2MAN} --no-info --help-option=--help-all --output=batten.1
                               "--name=smooth surfaces through the points of a mesh" $<TARGET_FILE:batten_tool>
                       COMMAND gzip -9nf batten.1)
    add_custom_target(manual ALL DEPENDS batten.1.gz)
    install(FILES ${PROJECT_BINARY_DIR}/batten.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT tool)
  endif()
endif()
install(FILES README.md CHANGELOG.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT tool)
install(DIRECTORY docs models DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT tool
        FILES_MATCHING PATTERN "*.md" PATTERN "*.bib" PATTERN "*.png" PATTERN "*.obj" PATTERN "*.json")
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT development)
