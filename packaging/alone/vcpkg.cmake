# Runs the port without vcpkg, by the functions of vcpkg as far as it uses them:
#
#   cmake -D PORT_DIR=DIR -D VERSION=VERSION -D PLACE=DIR [-D PROFILE=PROFILE] -P vcpkg.cmake
#
# The package lies in PLACE/packages; PROFILE is Cargo's.
cmake_minimum_required(VERSION 3.21)
set(PORT swiftprox)
if(NOT PROFILE)
  set(PROFILE release)
endif()
set(CURRENT_PACKAGES_DIR "${PLACE}/packages")

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

macro(vcpkg_check_linkage)
endmacro()

function(vcpkg_download_distfile variable)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "URLS;FILENAME;SHA512" "")
  file(DOWNLOAD "${arg_URLS}" "${PLACE}/${arg_FILENAME}" EXPECTED_HASH "SHA512=${arg_SHA512}")
  set(${variable} "${PLACE}/${arg_FILENAME}" PARENT_SCOPE)
endfunction()

# What the archive has is one folder.
function(vcpkg_extract_source_archive variable)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "ARCHIVE" "")
  file(ARCHIVE_EXTRACT INPUT "${arg_ARCHIVE}" DESTINATION "${PLACE}/source")
  file(GLOB folder "${PLACE}/source/*")
  set(${variable} "${folder}" PARENT_SCOPE)
endfunction()

function(vcpkg_cmake_configure)
  cmake_parse_arguments(PARSE_ARGV 0 arg "" "SOURCE_PATH" "OPTIONS")
  run("${CMAKE_COMMAND}" -S "${arg_SOURCE_PATH}" -B "${PLACE}/build" "-DCMAKE_INSTALL_PREFIX=${CURRENT_PACKAGES_DIR}"
    -DCMAKE_BUILD_TYPE=Release "-DSWIFTPROX_CARGO_PROFILE=${PROFILE}" ${arg_OPTIONS})
endfunction()

function(vcpkg_cmake_install)
  run("${CMAKE_COMMAND}" --build "${PLACE}/build")
  run("${CMAKE_COMMAND}" --install "${PLACE}/build")
endfunction()

# They find their folders from their own place.
function(vcpkg_fixup_pkgconfig)
  foreach(name IN ITEMS swiftprox swiftprox-legacy)
    file(READ "${CURRENT_PACKAGES_DIR}/lib/pkgconfig/${name}.pc" text)
    if(text MATCHES "${PLACE}")
      message(FATAL_ERROR "${name}.pc names ${PLACE}")
    endif()
  endforeach()
endfunction()

function(vcpkg_copy_tools)
  cmake_parse_arguments(PARSE_ARGV 0 arg "AUTO_CLEAN" "" "TOOL_NAMES")
  foreach(tool IN LISTS arg_TOOL_NAMES)
    file(INSTALL "${CURRENT_PACKAGES_DIR}/bin/${tool}" DESTINATION "${CURRENT_PACKAGES_DIR}/tools/${PORT}" USE_SOURCE_PERMISSIONS)
    file(REMOVE "${CURRENT_PACKAGES_DIR}/bin/${tool}")
  endforeach()
  file(GLOB rest "${CURRENT_PACKAGES_DIR}/bin/*")
  if(rest)
    message(FATAL_ERROR "tools that the port does not name: ${rest}")
  endif()
endfunction()

function(vcpkg_install_copyright)
  cmake_parse_arguments(PARSE_ARGV 0 arg "" "" "FILE_LIST")
  foreach(file IN LISTS arg_FILE_LIST)
    file(READ "${file}" text)
    file(APPEND "${CURRENT_PACKAGES_DIR}/share/${PORT}/copyright" "${text}")
  endforeach()
endfunction()

include("${PORT_DIR}/portfile.cmake")
