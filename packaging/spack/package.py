from spack_repo.builtin.build_systems.cmake import CMakePackage

from spack.package import *


class Swiftprox(CMakePackage):
    """Certified proximity queries between convex polyhedra: verdicts are exact, and distances come with guaranteed bounds."""

    url = "@URL@"

    license("MIT OR Apache-2.0")

    version("@VERSION@", sha256="@SHA256@")

    variant("mpi", default=False, description="swiftprox-sweep, which shares poses among the ranks of MPI")

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.21:", type="build")
    depends_on("python@3:", type="build")
    depends_on("rust@1.89:", type="build")
    depends_on("mpi", when="+mpi")

    conflicts("platform=windows")
    conflicts("platform=darwin")

    def cmake_args(self):
        return [self.define("SWIFTPROX_TEST_PEERS", False), self.define("CMAKE_DISABLE_FIND_PACKAGE_MPI", "+mpi" not in self.spec)]
