"""Builds and runs programs in C, in C++ and over SWIFT.h with the package that was made."""
import os

from conan import ConanFile
from conan.tools.build import can_run
from conan.tools.cmake import CMake, CMakeToolchain, cmake_layout


class SwiftproxTest(ConanFile):
    settings = "os", "arch", "compiler", "build_type"
    generators = "CMakeDeps", "VirtualRunEnv"

    def requirements(self):
        self.requires(self.tested_reference_str)

    def layout(self):
        cmake_layout(self, build_folder=os.path.join("..", "..", "build", "conan"))

    def generate(self):
        toolchain = CMakeToolchain(self)
        # Nothing is written beside the sources.
        toolchain.user_presets_path = False
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def test(self):
        if can_run(self):
            for program in ("hello", "hello_cpp", "legacy"):
                self.run(os.path.join(self.cpp.build.bindir, program), env="conanrun")
