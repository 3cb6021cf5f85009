#!/usr/bin/env python3
"""Runs the package of Spack without Spack, by its directives as far as it uses them:  spack.py PACKAGE.PY VERSION SHA256"""
import sys
import types

SAID = []


def directive(name):
    return lambda *arguments, **options: SAID.append((name, arguments, options))


class CMakePackage:
    def __init__(self, spec):
        self.spec = spec

    @staticmethod
    def define(name, value):
        return f"-D{name}:BOOL={'ON' if value else 'OFF'}"


def main():
    path, version, checksum = sys.argv[1:]
    names = ["spack_repo", "spack_repo.builtin", "spack_repo.builtin.build_systems", "spack_repo.builtin.build_systems.cmake",
             "spack", "spack.package"]
    for name in names:
        sys.modules[name] = types.ModuleType(name)
    sys.modules[names[3]].CMakePackage = CMakePackage
    for name in ("license", "version", "variant", "depends_on", "conflicts"):
        setattr(sys.modules["spack.package"], name, directive(name))
    with open(path, encoding="utf-8") as file:
        space = {}
        exec(compile(file.read(), path, "exec"), space)
    assert ("version", (version,), {"sha256": checksum}) in SAID, SAID
    for spec, mpi in ((set(), "ON"), ({"+mpi"}, "OFF")):
        arguments = space["Swiftprox"](spec).cmake_args()
        assert f"-DCMAKE_DISABLE_FIND_PACKAGE_MPI:BOOL={mpi}" in arguments, arguments
    print(" ".join(arguments))


if __name__ == "__main__":
    main()
