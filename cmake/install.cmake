# What `cmake --install` puts where, by the folders of GNUInstallDirs; each may be absolute. Nothing installed names the folder it
# was built in or installed to: the tree can be moved.

include(GNUInstallDirs)
# That of swiftprox itself: GNUInstallDirs asks only the first project that includes it.
set(doc_dir "${CMAKE_INSTALL_DATAROOTDIR}/doc/swiftprox")
if(PROJECT_IS_TOP_LEVEL)
  set(doc_dir "${CMAKE_INSTALL_DOCDIR}")
endif()
if(NOT DEFINED SWIFTPROX_INSTALL_CMAKEDIR)
  set(SWIFTPROX_INSTALL_CMAKEDIR "${CMAKE_INSTALL_LIBDIR}/cmake/swiftprox")
endif()
set(pkgconfig_dir "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
set(install_tree "${PROJECT_BINARY_DIR}/install_tree")

# --- The package files ---------------------------------------------------------------------------------------------------------

get_filename_component(from_config "${SWIFTPROX_INSTALL_CMAKEDIR}" ABSOLUTE BASE_DIR "${CMAKE_INSTALL_PREFIX}")
file(RELATIVE_PATH config_include_dir "${from_config}" "${CMAKE_INSTALL_FULL_INCLUDEDIR}")
file(RELATIVE_PATH config_library_dir "${from_config}" "${CMAKE_INSTALL_FULL_LIBDIR}")
string(PREPEND config_include_dir "\${_swiftprox_here}/")
set(config_legacy_dir "${config_include_dir}/swiftprox/legacy")
string(PREPEND config_library_dir "\${_swiftprox_here}/")
configure_file(cmake/swiftproxConfig.cmake.in "${install_tree}/swiftproxConfig.cmake" @ONLY)

# pkg-config replaces ${pcfiledir} by the folder of the file.
file(RELATIVE_PATH pc_prefix "${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig" "${CMAKE_INSTALL_PREFIX}")
string(REGEX REPLACE "/$" "" pc_prefix "${pc_prefix}")
file(RELATIVE_PATH pc_include_dir "${CMAKE_INSTALL_PREFIX}" "${CMAKE_INSTALL_FULL_INCLUDEDIR}")
file(RELATIVE_PATH pc_library_dir "${CMAKE_INSTALL_PREFIX}" "${CMAKE_INSTALL_FULL_LIBDIR}")
list(JOIN SWIFTPROX_STATIC_NEEDS " " pc_static_needs)
configure_file(cmake/swiftprox.pc.in "${install_tree}/swiftprox.pc" @ONLY)
configure_file(cmake/swiftprox-legacy.pc.in "${install_tree}/swiftprox-legacy.pc" @ONLY)

# --- The files -----------------------------------------------------------------------------------------------------------------

install(FILES "${SWIFTPROX_SHARED}" "${SWIFTPROX_LIBRARY_DIR}/${SWIFTPROX_SONAME}"
  DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT swiftprox_runtime)
install(FILES LICENSE-APACHE LICENSE-MIT DESTINATION "${doc_dir}" COMPONENT swiftprox_runtime)

install(FILES "${SWIFTPROX_LIBRARY_DIR}/libswiftprox.so" "${SWIFTPROX_STATIC}"
  DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT swiftprox_development)
install(FILES "${SWIFTPROX_INCLUDE_DIR}/swiftprox.h" "${SWIFTPROX_INCLUDE_DIR}/swiftprox.hpp"
  DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT swiftprox_development)
install(DIRECTORY "${SWIFTPROX_INCLUDE_DIR}/swiftprox" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT swiftprox_development)
install(DIRECTORY "${SWIFTPROX_INCLUDE_DIR}/legacy" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/swiftprox"
  COMPONENT swiftprox_development)
install(FILES "${install_tree}/swiftproxConfig.cmake" "${PROJECT_BINARY_DIR}/swiftproxConfigVersion.cmake"
  DESTINATION "${SWIFTPROX_INSTALL_CMAKEDIR}" COMPONENT swiftprox_development)
install(FILES "${install_tree}/swiftprox.pc" "${install_tree}/swiftprox-legacy.pc" DESTINATION "${pkgconfig_dir}" COMPONENT swiftprox_development)
install(DIRECTORY docs/ DESTINATION "${doc_dir}" COMPONENT swiftprox_development
  FILES_MATCHING PATTERN "*.svg" PATTERN "*.png" PATTERN reference EXCLUDE PATTERN site EXCLUDE)

# The pages, without links to what is not installed: those that lead out of docs/ keep their words.
set(out_of_docs "../")
foreach(folder IN ITEMS docs docs/research)
  file(GLOB pages CONFIGURE_DEPENDS "${folder}/*.md")
  foreach(page IN LISTS pages)
    file(READ "${page}" text)
    string(REGEX REPLACE "\\[([^]\n]*)\\]\\(${out_of_docs}[^)\n]*\\)" "\\1" text "${text}")
    file(RELATIVE_PATH name "${PROJECT_SOURCE_DIR}/docs" "${page}")
    file(WRITE "${install_tree}/docs/${name}" "${text}")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${page}")
  endforeach()
  string(PREPEND out_of_docs "../")
endforeach()
install(DIRECTORY "${install_tree}/docs/" DESTINATION "${doc_dir}" COMPONENT swiftprox_development)

# --- Without debug information -------------------------------------------------------------------------------------------------

# Cargo's release profile has line numbers, for valgrind and profilers: two thirds of the archive's size, five sixths of the shared
# library's. Build types for packagers and debuggers install them, so that they can be split off, but not with --strip.
function(strip_installed library component)
  set(folder "${CMAKE_INSTALL_LIBDIR}")
  if(NOT IS_ABSOLUTE "${folder}")
    string(PREPEND folder "\${CMAKE_INSTALL_PREFIX}/")
  endif()
  install(CODE "
    if(CMAKE_INSTALL_DO_STRIP OR CMAKE_INSTALL_CONFIG_NAME MATCHES \"^(Release|MinSizeRel)$\")
      execute_process(COMMAND \"${CMAKE_STRIP}\" -S \"\$ENV{DESTDIR}${folder}/${library}\" COMMAND_ERROR_IS_FATAL ANY)
    endif()" COMPONENT ${component})
endfunction()

if(CMAKE_STRIP)
  strip_installed("${SWIFTPROX_SHARED_NAME}" swiftprox_runtime)
  strip_installed(libswiftprox.a swiftprox_development)
endif()
