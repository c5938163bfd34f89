#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What is built holds no path of the folder it was built in, looks for no library in the working directory, and bench/reproducible.py
finds where two builds differ.

Usage: reproducible_test.py BUILD REPRODUCIBLE.py
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

BUILD, SCRIPT = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
del sys.argv[1:3]
CODE = 'const char* where() { return __FILE__; }\nint main() { return where()[0] == 0; }\n'


def run(*words, **more):
    return subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False, **more)


def small_build(root, name, *options):
    """A build folder with one program."""
    folder = root / name
    (folder / "bin").mkdir(parents=True)
    (folder / "source.cpp").write_text(CODE)
    (folder / "CMakeCache.txt").write_text(f"CMAKE_HOME_DIRECTORY:INTERNAL={folder}\n")
    done = run("c++", "-O1", *options, folder / "source.cpp", "-o", folder / "bin" / "roomgraph")
    assert done.returncode == 0, done.stderr
    return folder


class WhatIsBuilt(unittest.TestCase):
    def test_names_no_folder_of_the_build(self):
        done = run(SCRIPT, "--paths", BUILD)
        self.assertEqual((done.returncode, done.stdout.count("\n")), (0, 1), done.stdout + done.stderr)

    def test_the_loader_does_not_look_in_the_working_directory(self):
        with tempfile.TemporaryDirectory() as empty:
            done = run(BUILD / "bin" / "roomgraph", "--version", cwd=empty, env=os.environ | {"LD_DEBUG": "libs"})
        tried = [line.split("trying file=")[1] for line in done.stderr.splitlines() if "trying file=" in line]
        self.assertGreater(len(tried), 100)
        self.assertEqual([file for file in tried if not file.startswith("/")], [])

    def test_the_build_folder_finds_the_shipped_files_beside_the_program(self):
        for name in "config.ini", "objects.ini", "objects_home.ini", "networks.json", "models/room_detector/room_detector.onnx":
            self.assertTrue((BUILD / "bin" / ".." / "share" / "roomgraph" / name).is_file(), name)


class Comparison(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.root = pathlib.Path(self.scratch.name).resolve()

    def test_the_same_bytes_are_the_same(self):
        first = small_build(self.root, "one")
        second = self.root / "two"
        shutil.copytree(first, second)
        done = run(SCRIPT, "--compare", first, second)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("1 files, ", done.stdout)
        self.assertIn(": 0 differ.", done.stdout)

    def test_a_path_in_the_program_is_found_and_where(self):
        first, second = small_build(self.root, "one"), small_build(self.root, "two")
        done = run(SCRIPT, "--compare", first, second)
        self.assertEqual(done.returncode, 1)
        self.assertIn("1 differ.", done.stdout)
        self.assertIn(", .rodata: ", done.stdout)  # not the build id, which differs too and stands before it
        told = run(SCRIPT, "--paths", first)
        self.assertEqual(told.returncode, 1)
        self.assertIn(f"bin/roomgraph: .rodata: {first}/source.cpp", told.stdout)

    def test_paths_that_are_mapped_make_no_difference(self):
        builds = [small_build(self.root, name, f"-fmacro-prefix-map={self.root / name}/=") for name in ("one", "two")]
        self.assertEqual(run(SCRIPT, "--compare", *builds).returncode, 0)
        self.assertEqual(run(SCRIPT, "--paths", builds[0]).returncode, 0)

    def test_one_byte_is_found_with_its_section(self):
        first = small_build(self.root, "one")
        second = self.root / "two"
        shutil.copytree(first, second)
        program = second / "bin" / "roomgraph"
        data = bytearray(program.read_bytes())
        at = data.index(b"source.cpp")
        data[at] ^= 1
        program.write_bytes(data)
        done = run(SCRIPT, "--compare", first, second)
        self.assertIn(f"byte {at}, .rodata: ", done.stdout)
        self.assertEqual(done.returncode, 1)

    def test_another_build_id_alone_is_told(self):
        first = small_build(self.root, "one", "-Wl,--build-id=sha1")
        second = self.root / "two"
        shutil.copytree(first, second)
        program = second / "bin" / "roomgraph"
        told = run("readelf", "-n", program).stdout
        number = bytes.fromhex(told.split("Build ID: ")[1].split()[0])
        program.write_bytes(program.read_bytes().replace(number, bytes(len(number))))
        self.assertIn("the build id alone", run(SCRIPT, "--compare", first, second).stdout)

    def test_an_empty_search_path_is_found(self):
        folder = small_build(self.root, "one", "-Wl,-rpath,/usr/lib:", f"-fmacro-prefix-map={self.root}/=")
        told = run(SCRIPT, "--paths", folder)
        self.assertIn("search path /usr/lib:: libraries are looked for in the working directory", told.stdout)

    def test_a_file_of_one_build_only_is_told(self):
        first = small_build(self.root, "one")
        second = self.root / "two"
        shutil.copytree(first, second)
        (first / "bin" / "more").write_bytes(b"x")
        self.assertIn(f"only in {first}", run(SCRIPT, "--compare", first, second).stdout)

    def test_wrong_input_is_one_line(self):
        done = run(SCRIPT, "--compare", self.root / "nowhere", self.root)
        self.assertEqual((done.returncode, done.stderr.count("\n")), (3, 1), done.stderr)
        self.assertIn("nowhere", done.stderr)
        self.assertEqual(run(SCRIPT, "--revision", "no_such_revision").returncode, 2)


if __name__ == "__main__":
    unittest.main()
