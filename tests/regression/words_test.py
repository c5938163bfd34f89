#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# Part of roomgraph, object-level semantic SLAM.
"""Completion scripts in real shells, and the manual page: they know what --help knows.

Usage: words_test.py PROGRAM
Needs bash, zsh, fish and man (test.sh installs them).
"""
import functools
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

PROGRAM = sys.argv.pop(1)


def output(*command, **more):
    return subprocess.run(command, check=True, capture_output=True, text=True, **more).stdout


@functools.lru_cache(maxsize=None)
def help_of(path):
    return output(PROGRAM, *path, "--help")


def in_help(path, heading):
    """First words of the indented lines below a heading of --help."""
    part = re.search(rf"^{heading}:\n((?:  .*\n)+)", help_of(path), re.MULTILINE)
    return re.findall(r"^  (\S+)", part.group(1), re.MULTILINE) if part else []


def commands_below(path=()):
    for name in in_help(path, "Subcommands"):
        yield (*path, name)
        yield from commands_below((*path, name))


def option_names(path):
    return [name for names in in_help(path, "Options") for name in names.split(",")]


class Shells(unittest.TestCase):
    """Every shell gets a list of words, the last one to be completed, and says what it offers."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.scripts = {}
        for shell in ("bash", "zsh", "fish"):
            file = pathlib.Path(cls.folder.name, shell)
            file.write_text(output(PROGRAM, "completion", shell), encoding="utf-8")
            cls.scripts[shell] = str(file)
        pathlib.Path(cls.folder.name, "lab.rawlog").touch()

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def bash(self, *words):
        script = ('source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _roomgraph; '
                  'printf "%s\\n" "${COMPREPLY[@]}"')
        return set(output("bash", "--norc", "-c", script, "-", self.scripts["bash"], "roomgraph", *words).split())

    def zsh(self, *words):
        # Stands in for the line editor: what the function hands to zsh's own helpers is what would be shown.
        script = ('script=$1; shift; compdef() { : }; compadd() { while [[ $1 != -- ]]; do shift; done; shift; print -l -- "$@"; }; '
                  '_files() { print FILES; }; _describe() { local list=${@[-1]}; print -l -- ${${(P)list}%%:*}; }; '
                  'source $script; words=("$@"); CURRENT=$#; PREFIX=${@[-1]}; _roomgraph')
        offered = output("zsh", "-f", "-c", script, "-", self.scripts["zsh"], "roomgraph", *words).split()
        return {word for word in offered if word.startswith(words[-1]) or word == "FILES"}

    def fish(self, *words):
        line = " ".join(("roomgraph", *words))
        lines = output("fish", "--no-config", "-c", f"source {self.scripts['fish']}; complete -C '{line}'",
                       cwd=self.folder.name).splitlines()
        return {line.split("\t")[0] for line in lines}

    def all_shells(self, *words):
        answers = {shell: getattr(self, shell)(*words) for shell in self.scripts}
        self.assertEqual(answers["bash"], answers["zsh"], words)
        self.assertEqual(answers["bash"], answers["fish"], words)
        return answers["bash"]

    def test_commands(self):
        self.assertEqual(self.all_shells("ma"), {"map", "manual"})
        self.assertEqual(self.all_shells("map", ""), {"info", "export", "crop", "diff", "join", "merge"})

    def test_every_command_and_option_of_help_is_offered(self):
        paths = [(), *commands_below()]
        self.assertGreater(len(paths), 20)
        for path in paths:
            self.assertLessEqual(set(option_names(path)), self.bash(*path, "-"), path)
            self.assertLessEqual(set(in_help(path, "Subcommands")), self.bash(*path, ""), path)

    def test_allowed_values(self):
        self.assertEqual(self.all_shells("snapshot", "--view", ""), {"top", "orbit", "robot"})
        self.assertEqual(self.all_shells("completion", ""), {"bash", "zsh", "fish"})
        self.assertEqual(self.bash("snapshot", "--view", "=", "o"), {"orbit"})
        self.assertEqual(self.bash("snapshot", "--view", "="), {"top", "orbit", "robot"})

    def test_configuration_keys(self):
        self.assertEqual(self.all_shells("run", "lab.rawlog", "--set", "lidar.enab"), {"lidar.enabled="})

    def test_flag_takes_no_value(self):
        self.assertIn("--output", self.all_shells("run", "--quiet", "--o"))

    def test_a_value_is_no_command(self):
        self.assertEqual(self.bash("run", "-o", "map", "--no-s"), {"--no-snapshot"})

    def test_files_take_the_place_of_words(self):
        self.assertEqual(self.bash("run", "la"), set())  # and so bash offers files
        self.assertEqual(self.zsh("run", "la"), {"FILES"})
        self.assertEqual(self.fish("run", "la"), {"lab.rawlog"})
        self.assertIn("-o default", pathlib.Path(self.scripts["bash"]).read_text(encoding="utf-8"))


class Manual(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.page = output(PROGRAM, "manual")

    def test_no_warnings(self):
        with tempfile.NamedTemporaryFile("w", suffix=".1", encoding="utf-8") as file:
            file.write(self.page)
            file.flush()
            result = subprocess.run(["man", "--warnings", "-E", "UTF-8", "-l", file.name], check=True, capture_output=True,
                                    text=True, env={"LC_ALL": "C.UTF-8", "PATH": "/usr/bin:/bin", "MANWIDTH": "100"})
        self.assertEqual(result.stderr, "")
        self.assertIn("roomgraph map diff [OPTIONS] BEFORE AFTER", result.stdout)
        self.assertIn("roomgraph map diff monday/map.rgmap friday/map.rgmap", result.stdout)

    def test_every_command_and_option_of_help_is_in_it(self):
        plain = self.page.replace("\\-", "-")
        for path in commands_below():
            part = plain.partition(f".SS roomgraph {' '.join(path)}\n")[2].partition("\n.SS ")[0]
            self.assertTrue(part, path)
            for name in option_names(path):
                self.assertRegex(part, rf"\\fB{name}\\fR", path)

    def test_values(self):
        self.assertIn("\\fB\\-\\-quiet\\fR\nno progress", self.page)
        self.assertIn("\\fB\\-\\-style\\fR \\fIVALUE\\fR", self.page)
        self.assertIn("; one of screen, paper; default: screen", self.page)


if __name__ == "__main__":
    unittest.main()
