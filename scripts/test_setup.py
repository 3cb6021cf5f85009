#!/usr/bin/env python3
"""What require.sh, apt.sh, rust.sh and CMake do on machines that lack something. Whatever else they call is a stand-in.

usage: test_setup.py [unittest arguments]

Each test has a project and a PATH of its own. There are what every Debian has, and stand-ins, which write down how they are called.
"""
import os
import shutil
import subprocess
import tempfile
import unittest

SCRIPTS = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(SCRIPTS)
EVERYWHERE = ("sh", "cat", "chmod", "cp", "cut", "dirname", "env", "grep", "head", "ln", "mkdir", "mktemp", "rm", "sed", "sort",
              "tail")
WRITE_DOWN = '#!/bin/sh\necho "${0##*/} $*" >>"$CALLS"\n'
CARGO = 'if [ "$1" = --version ]; then echo "cargo VERSION (30a34c682 2025-05-25)"; fi\n'
# Packages are folders of commands.
APT_GET = """
[ "$1" = install ] || exit 0
for package in "$@"; do
    case $package in install | -*) continue ;; esac
    [ -d "$PACKAGES/$package" ] || { echo "W: a warning"; echo "E: Unable to locate package $package"; exit 100; } >&2
    cp "$PACKAGES/$package"/* "$BIN"
done
"""
# What rustup does, and its installer.
TOOLCHAIN = """
bin=$RUSTUP_HOME/toolchains/1.95.0-x86_64-unknown-linux-gnu/bin
mkdir -p "$bin"
for command in cargo rustc cargo-fmt cargo-clippy; do cp "$BUILT" "$bin/$command"; done
"""
RUSTUP_FAILS = "{ echo 'info: downloading'; echo 'error: no file at static.rust-lang.org'; echo '  0: a trace'; } >&2; exit 1\n"
CURL = 'while [ "$1" != -sSfo ]; do shift; done; cp "$INSTALLER" "$2"\n'


class Machine(unittest.TestCase):
    """One on which all is installed but Rust, and the user is root."""

    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        self.project = self.path("project")
        shutil.copytree(SCRIPTS, os.path.join(self.project, "scripts"), ignore=shutil.ignore_patterns("*.py", "__pycache__"))
        os.symlink(os.path.join(ROOT, "cmake"), os.path.join(self.project, "cmake"))
        self.rust_wanted("1.89")
        os.mkdir(self.path("bin"))
        for name in EVERYWHERE:
            os.symlink(shutil.which(name), self.path("bin", name))
        self.write(WRITE_DOWN + CARGO.replace("VERSION", "1.95.0"), "built")
        self.write(WRITE_DOWN + TOOLCHAIN, "installer")
        self.command("id", "echo 0\n")
        self.command("apt-get", APT_GET)
        self.command("curl", CURL)

    def path(self, *parts):
        return os.path.join(self.folder, *parts)

    def write(self, text, *parts):
        os.makedirs(os.path.dirname(self.path(*parts)), exist_ok=True)
        with open(self.path(*parts), "w") as file:
            file.write(text)
        os.chmod(self.path(*parts), 0o755)

    def rust_wanted(self, version):
        self.write(f'[package]\nrust-version = "{version}"\n', "project", "Cargo.toml")

    def command(self, name, body=""):
        self.write(WRITE_DOWN + body, "bin", name)

    def cargo(self, version):
        self.command("cargo", CARGO.replace("VERSION", version))

    def package(self, name, command, body=""):
        self.write(WRITE_DOWN + body, "packages", name, command)

    def lacks(self, command):
        os.remove(self.path("bin", command))

    def run_script(self, name, *arguments):
        """Its result, with `calls`: the stand-ins' since the last time."""
        self.write("", "calls")
        environment = {"PATH": self.path("bin"), "HOME": self.path("home"), "BIN": self.path("bin"), "CALLS": self.path("calls"),
                       "PACKAGES": self.path("packages"), "BUILT": self.path("built"), "INSTALLER": self.path("installer")}
        result = subprocess.run(["scripts/" + name, *arguments], cwd=self.project, env=environment, capture_output=True, text=True)
        with open(self.path("calls")) as file:
            result.calls = file.read()
        return result

    def assert_done(self, result):
        self.assertEqual((result.returncode, result.stderr), (0, ""))

    def assert_one_line(self, result, *parts):
        """It failed, and in one line said all of this."""
        self.assertNotEqual(result.returncode, 0)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        for part in parts:
            self.assertIn(part, result.stderr)

    def assert_installed(self):
        link = os.path.join(self.project, ".rust", "bin")
        self.assertTrue(os.access(os.path.join(link, "cargo"), os.X_OK))
        self.assertFalse(os.path.isabs(os.readlink(link)), "a link that breaks when the project is moved")


class Packages(Machine):
    def setUp(self):
        super().setUp()
        self.cargo("1.95.0")

    def test_nothing_is_installed_where_nothing_is_missing(self):
        self.command("cmake")
        result = self.run_script("require.sh", "cmake=cmake", self.path("built") + "=libsome-dev")
        self.assert_done(result)
        self.assertEqual(result.stdout, "")
        self.assertNotIn("apt-get", result.calls)

    def test_a_folder_of_the_name_is_not_the_command(self):
        self.package("cmake", "cmake")
        self.assert_done(self.run_script("require.sh", "cmake=cmake"))
        self.assertTrue(os.path.exists(self.path("bin", "cmake")))

    def test_a_command_of_the_name_is_not_the_file(self):
        self.command("some.h")
        self.package("libsome-dev", "some-config")
        self.assert_done(self.run_script("require.sh", "/usr/include/no/some.h=libsome-dev"))
        self.assertTrue(os.path.exists(self.path("bin", "some-config")))

    def test_a_module_that_python_has_not_is_installed(self):
        self.command("python3", '[ "$*" = "-c import some" ]\n')
        self.package("python3-other", "other")
        self.assert_done(self.run_script("require.sh", "python3:some=python3-some"))
        self.assert_done(self.run_script("require.sh", self.path("bin", "python3") + ":some=python3-some"))
        self.assert_done(self.run_script("require.sh", "python3:some=python3-some", "python3:other=python3-other"))
        self.assertTrue(os.path.exists(self.path("bin", "other")))

    def test_a_module_of_a_python_that_is_missing_is_installed(self):
        self.package("python3-some", "python3")
        self.assert_done(self.run_script("require.sh", "python3:some=python3-some"))
        self.assertTrue(os.path.exists(self.path("bin", "python3")))

    def test_all_that_is_missing_is_installed_at_once(self):
        for name in ("gcc", "valgrind"):
            self.package(name, name)
        result = self.run_script("require.sh", "gcc=gcc", "id=nothing", "valgrind=valgrind")
        self.assert_done(result)
        self.assertIn("apt-get install -y --no-install-recommends gcc valgrind -qq\n", result.calls)

    def test_a_package_that_cannot_be_had_ends_in_one_line(self):
        result = self.run_script("require.sh", "cmake=cmake")
        self.assert_one_line(result, "Unable to locate package cmake", "apt-get install")

    def test_without_the_right_to_install_one_line_says_what_is_missing(self):
        self.command("id", "echo 1000\n")
        self.assert_one_line(self.run_script("require.sh", "cmake=cmake"), "missing: cmake; sudo apt-get install")

    def test_elsewhere_than_on_debian_one_line_says_what_is_missing(self):
        self.lacks("apt-get")
        self.assert_one_line(self.run_script("require.sh", "cmake=cmake", "c++=g++"), "missing: cmake g++")

    def test_sudo_installs_where_it_does_not_ask(self):
        self.command("id", "echo 1000\n")
        self.command("sudo", 'case $1 in -n) ;; *) exec "$@" ;; esac\n')
        self.package("cmake", "cmake")
        self.assert_done(self.run_script("require.sh", "cmake=cmake"))
        self.assertTrue(os.path.exists(self.path("bin", "cmake")))

    def test_crates_that_cannot_be_fetched_end_in_one_line(self):
        self.command("cargo", CARGO.replace("VERSION", "1.95.0") + '[ "$1" != fetch ] || { printf "%s\\n" "error: no crate" "" '
                     '"Caused by:" "  no network" >&2; exit 101; }\n')
        self.assert_one_line(self.run_script("require.sh"), "no crate", "no network")


class Rust(Machine):
    def test_one_that_is_new_enough_is_left_alone(self):
        for version in ("1.89.0", "1.100.1", "2.0.0"):
            self.cargo(version)
            result = self.run_script("rust.sh")
            self.assert_done(result)
            self.assertEqual((result.stdout, result.calls), ("", "cargo --version\n"))
            self.assertFalse(os.path.exists(os.path.join(self.project, ".rust")))

    def test_a_missing_one_is_installed(self):
        result = self.run_script("rust.sh")
        self.assert_done(result)
        self.assertIn("Rust 1.89 or newer is needed, found none", result.stdout)
        self.assertIn("--no-modify-path --profile minimal --default-toolchain 1.95.0 -c rustfmt -c clippy", result.calls)
        self.assert_installed()
        self.assertFalse(os.path.exists(self.path("home")))

    def test_one_that_is_too_old_is_not_used(self):
        self.cargo("1.63.0")
        result = self.run_script("rust.sh")
        self.assert_done(result)
        self.assertIn("found 1.63.0", result.stdout)
        self.assert_installed()

    def test_what_is_installed_is_used_again(self):
        self.assert_done(self.run_script("rust.sh"))
        self.lacks("curl")
        again = self.run_script("require.sh")
        self.assert_done(again)
        self.assertEqual((again.stdout, again.calls), ("", "cargo --version\ncargo fetch --locked --quiet\n"))

    def test_what_was_installed_gives_way_to_what_is_wanted_now(self):
        old = CARGO.replace("VERSION", "1.80.0")
        self.write(WRITE_DOWN + old, "project", ".rust", "rustup", "toolchains", "1.80.0-x", "bin", "cargo")
        os.symlink("rustup/toolchains/1.80.0-x/bin", self.path("project", ".rust", "bin"))
        result = self.run_script("rust.sh")
        self.assert_done(result)
        self.assertIn("found 1.80.0", result.stdout)
        self.assertIn("1.95.0", os.readlink(self.path("project", ".rust", "bin")))

    def test_one_without_a_command_that_is_needed_is_not_used(self):
        self.cargo("1.95.0")
        self.command("cargo-clippy")
        self.command("cargo-fmt", "exit 1\n")
        self.assert_done(self.run_script("rust.sh"))
        self.assertFalse(os.path.exists(os.path.join(self.project, ".rust")))
        result = self.run_script("rust.sh", "cargo-clippy", "cargo-fmt")
        self.assert_done(result)
        self.assertIn("cargo-fmt", result.stdout)
        self.assert_installed()

    def test_rustup_is_used_where_it_is(self):
        self.command("rustup", TOOLCHAIN)
        result = self.run_script("rust.sh")
        self.assert_done(result)
        self.assertIn("rustup toolchain install 1.95.0", result.calls)
        self.assertNotIn("curl", result.calls)
        self.assert_installed()

    def test_rustup_is_installed_where_it_is_a_package(self):
        self.package("rustup", "rustup", TOOLCHAIN)
        result = self.run_script("rust.sh")
        self.assert_done(result)
        self.assertNotIn("curl", result.calls)
        self.assert_installed()

    def test_without_the_right_to_install_packages_the_installer_is_used(self):
        self.command("id", "echo 1000\n")
        self.package("rustup", "rustup", TOOLCHAIN)
        result = self.run_script("rust.sh")
        self.assert_done(result)
        self.assertIn("curl", result.calls)
        self.assert_installed()

    def test_curl_is_installed_where_it_is_missing(self):
        self.lacks("curl")
        self.package("curl", "curl", CURL)
        self.package("ca-certificates", "update-ca-certificates")
        self.assert_done(self.run_script("rust.sh"))
        self.assert_installed()

    def assert_refused(self, reason):
        for _ in range(2):
            result = self.run_script("require.sh")
            self.assert_one_line(result, "Rust 1.89 or newer is needed, found none", reason, "try again", "https://rustup.rs")
            self.assertFalse(os.path.lexists(os.path.join(self.project, ".rust", "bin")))

    def test_an_installer_that_cannot_be_downloaded_ends_in_one_line(self):
        self.command("curl", 'echo "curl: (6) Could not resolve host: static.rust-lang.org" >&2; exit 6\n')
        self.assert_refused("Could not resolve host")

    def test_an_installer_that_fails_ends_in_one_line(self):
        self.write(WRITE_DOWN + RUSTUP_FAILS, "installer")
        self.assert_refused("no file at static.rust-lang.org")

    def test_a_rustup_that_fails_ends_in_one_line(self):
        self.package("rustup", "rustup", RUSTUP_FAILS)
        self.assert_refused("no file at static.rust-lang.org")

    def test_a_curl_that_cannot_be_had_ends_in_one_line(self):
        self.lacks("curl")
        self.assert_refused("Unable to locate package curl")

    def test_an_installer_that_installs_nothing_is_found_out(self):
        self.write(WRITE_DOWN, "installer")
        result = self.run_script("rust.sh")
        self.assert_one_line(result, "Rust 1.89 or newer is needed, found none")


class CMake(Machine):
    """Without make, and so without what it installs."""

    def configure(self):
        for name in os.listdir(ROOT):
            if name not in (".git", ".rust", "build", "scripts", "target") and not os.path.lexists(self.path("project", name)):
                os.symlink(os.path.join(ROOT, name), self.path("project", name))
        environment = dict(os.environ, PATH=self.path("bin") + os.pathsep + os.environ["PATH"], HOME=self.path("home"),
                           CALLS=self.path("calls"))
        return subprocess.run(["cmake", "-S", self.project, "-B", self.path("build"), "-DBUILD_TESTING=OFF"], env=environment,
                              capture_output=True, text=True)

    def test_names_the_script_that_installs_rust_and_then_finds_it(self):
        shutil.copy(os.path.join(ROOT, "Cargo.toml"), self.project)
        self.cargo("1.63.0")
        result = self.configure()
        self.assertNotEqual(result.returncode, 0)
        self.assertIn('found "1.63.0"', result.stderr)
        self.assertIn(os.path.join(self.project, "scripts", "rust.sh"), "".join(result.stderr.split()))
        self.write(WRITE_DOWN + CARGO.replace("VERSION", "1.95.0"), "project", ".rust", "bin", "cargo")
        result = self.configure()
        self.assertEqual(result.returncode, 0, result.stderr)


if __name__ == "__main__":
    unittest.main()
