"""The package for Conan 2: `conan create .` builds, packs and tries it (scripts/conan.sh). Rust is that of PATH."""
import os
import re

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeToolchain, cmake_layout
from conan.tools.files import copy, load, rmdir


class Swiftprox(ConanFile):
    name = "swiftprox"
    license = "MIT OR Apache-2.0"
    description = "Certified proximity queries between convex polyhedra"
    topics = ("collision", "distance", "convex", "polyhedron", "proximity")
    package_type = "library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"shared": [True, False]}
    default_options = {"shared": False}
    # With what Cargo.toml names: benches, and the members of the workspace.
    exports_sources = (".cargo/*", "CMakeLists.txt", "Cargo.lock", "Cargo.toml", "LICENSE-*", "benches/*.rs", "build.rs", "adapters/*",
                       "cmake/*", "docs/*", "examples/*", "include/*", "src/*", "proofs/*", "testkit/*", "tools/*",
                       "fuzz/Cargo.toml", "fuzz/src/*", "fuzz/fuzz_targets/*")
    test_package_folder = "packaging/conan_test"

    def set_version(self):
        manifest = load(self, os.path.join(self.recipe_folder, "Cargo.toml"))
        self.version = re.search(r'^version = "(.*)"', manifest, re.MULTILINE).group(1)

    def configure(self):
        # The interface is that of C.
        self.settings.rm_safe("compiler.libcxx")
        self.settings.rm_safe("compiler.cppstd")

    def layout(self):
        cmake_layout(self)

    def generate(self):
        CMakeToolchain(self).generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        copy(self, "LICENSE-*", self.source_folder, os.path.join(self.package_folder, "licenses"))
        CMake(self).install()
        # Conan writes these for its own places.
        rmdir(self, os.path.join(self.package_folder, "lib", "cmake"))
        rmdir(self, os.path.join(self.package_folder, "lib", "pkgconfig"))
        for library in os.listdir(os.path.join(self.package_folder, "lib")):
            if library.endswith(".a") == bool(self.options.shared):
                os.remove(os.path.join(self.package_folder, "lib", library))

    def package_info(self):
        core = self.cpp_info.components["swiftprox"]
        core.libs = ["swiftprox"]
        core.set_property("cmake_target_name", "swiftprox::swiftprox")
        core.set_property("pkg_config_name", "swiftprox")
        if not self.options.shared:
            # As SWIFTPROX_STATIC_NEEDS in CMakeLists.txt.
            core.exelinkflags = ["-Wl,--gc-sections"]
            core.system_libs = ["util", "rt", "pthread", "m", "dl"]
        # Headers over those of engines and planners, which a program brings.
        adapters = self.cpp_info.components["adapters"]
        adapters.libdirs = []
        adapters.requires = ["swiftprox"]
        adapters.set_property("cmake_target_name", "swiftprox::adapters")
        # SWIFT.h.
        legacy = self.cpp_info.components["legacy"]
        legacy.libdirs = []
        legacy.includedirs = [os.path.join("include", "swiftprox", "legacy")]
        legacy.requires = ["swiftprox"]
        legacy.set_property("cmake_target_name", "swiftprox::legacy")
        legacy.set_property("pkg_config_name", "swiftprox-legacy")
