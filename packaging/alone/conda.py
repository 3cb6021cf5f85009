#!/usr/bin/env python3
"""Reads the recipe for conda-forge by rattler-build, and prints what its packages need; nothing is built:  conda.py RECIPE.YAML"""
import sys

from rattler_build import PlatformConfig, RenderConfig, Stage0Recipe, VariantConfig

recipe = Stage0Recipe.from_file(sys.argv[1])
variants = VariantConfig({"c_compiler": ["gcc"], "cxx_compiler": ["gxx"], "rust_compiler": ["rust"], "c_stdlib": ["sysroot"],
                          "c_stdlib_version": ["2.28"], "python": ["3.12.* *_cp312"]})
names = set()
for variant in recipe.render(variants, RenderConfig(PlatformConfig(target_platform="linux-64"))):
    package = variant.recipe.package
    names.add(package.name)
    print(package.name, package.version)
assert names == {"libswiftprox", "swiftprox"}, names
