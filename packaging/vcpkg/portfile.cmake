# Rust 1.89 is that of PATH, and Cargo fetches the crates of Cargo.lock.
vcpkg_check_linkage(ONLY_DYNAMIC_LIBRARY)
# The interface is that of C: programs of both configurations use one library.
set(VCPKG_BUILD_TYPE release)

vcpkg_download_distfile(ARCHIVE
  URLS "@URL@"
  FILENAME "swiftprox-${VERSION}.tar.gz"
  SHA512 @SHA512@)
vcpkg_extract_source_archive(SOURCE_PATH ARCHIVE "${ARCHIVE}")

vcpkg_cmake_configure(SOURCE_PATH "${SOURCE_PATH}"
  OPTIONS
    -DSWIFTPROX_TEST_PEERS=OFF
    -DCMAKE_DISABLE_FIND_PACKAGE_MPI=ON
    -DSWIFTPROX_INSTALL_CMAKEDIR=share/swiftprox
    -DCMAKE_INSTALL_DOCDIR=share/swiftprox/doc)
vcpkg_cmake_install()
vcpkg_fixup_pkgconfig()
vcpkg_copy_tools(TOOL_NAMES swiftprox-query swiftprox-replay swiftprox-tune AUTO_CLEAN)

file(INSTALL "${CMAKE_CURRENT_LIST_DIR}/usage" DESTINATION "${CURRENT_PACKAGES_DIR}/share/${PORT}")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE-MIT" "${SOURCE_PATH}/LICENSE-APACHE")
