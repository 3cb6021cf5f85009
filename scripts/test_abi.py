#!/usr/bin/env python3
"""Tests abi.py: of changes to the interface as it is, those that break programs are found, and no others."""
import re
import unittest

import abi

HEADER, LAYOUT = "include/swiftprox.h", abi.LAYOUT


def changed(path, old, new):
    """Reads files as they are, but for one place of one, found by a pattern."""
    def read(name):
        text = abi.read_here(name)
        if name == path:
            text, count = re.subn(old, lambda _: new, text, count=1)
            assert count == 1, old
        return text
    return read


class Abi(unittest.TestCase):
    def found(self, path, old, new):
        return abi.breaks(abi.read_here, changed(path, old, new))

    def test_nothing_has_changed(self):
        self.assertEqual(abi.breaks(abi.read_here, abi.read_here), [])

    def test_what_breaks_programs_is_found(self):
        for path, old, new, name in (
                (HEADER, r"swiftprox_library_version\(void\);", "swiftprox_library_get_version(void);",
                 "swiftprox_library_version"),
                (HEADER, r"swiftprox_library_check_version\(int32_t major,", "swiftprox_library_check_version(int64_t major,",
                 "swiftprox_library_check_version"),
                (HEADER, r"\(\*swiftprox_progress_callback\)\(void \*user,", "(*swiftprox_progress_callback)(const void *user,",
                 "swiftprox_progress_callback"),
                (HEADER, r"SWIFTPROX_ERROR_BUSY = \d+", "SWIFTPROX_ERROR_BUSY = 1000", "swiftprox_status.SWIFTPROX_ERROR_BUSY"),
                (HEADER, "SWIFTPROX_NO_FACE UINT32_MAX", "SWIFTPROX_NO_FACE 0", "SWIFTPROX_NO_FACE"),
                (LAYOUT, r"STRUCT\(swiftprox_pair_answer, \d+", "STRUCT(swiftprox_pair_answer, 1000", "swiftprox_pair_answer"),
                (LAYOUT, r"MEMBER\(swiftprox_pair_config, step_budget, \d+", "MEMBER(swiftprox_pair_config, step_budget, 1000",
                 "swiftprox_pair_config.step_budget")):
            found = self.found(path, old, new)
            self.assertEqual([line.partition(":")[0] for line in found], [name])

    def test_what_breaks_none_is_not(self):
        for path, old, new in (
                (HEADER, r"const char \*swiftprox_library_version\(void\);",
                 "const char *swiftprox_library_version(void);\n\nint32_t swiftprox_library_year(void);"),
                (HEADER, r"swiftprox_library_check_version\(int32_t major,", "swiftprox_library_check_version(int32_t first,"),
                (HEADER, "SWIFTPROX_ERROR_BUSY = 16", "SWIFTPROX_ERROR_BUSY = 16,\n  SWIFTPROX_ERROR_TIDE = 17"),
                # A struct that knows its size grows at its end.
                (LAYOUT, r"STRUCT\(swiftprox_pair_config, \d+", "STRUCT(swiftprox_pair_config, 1000"),
                # Experimental.
                ("include/swiftprox/ground.h", r"swiftprox_pair_half_space_distance\(", "swiftprox_pair_half_space_gap(")):
            self.assertEqual(self.found(path, old, new), [], old)

    def test_the_version_is_in_the_name_of_the_library(self):
        for version, name in (("0.2.7", "0.2"), ("1.4.0", "1"), ("12.0.1", "12")):
            self.assertEqual(abi.interface_version(lambda _: f'[package]\nversion = "{version}"\n'), name)


if __name__ == "__main__":
    unittest.main()
