#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The checks themselves: each must find what it is there for, and only that."""
import pathlib
import sys
import tempfile
import textwrap
import unittest

import check_headers
import check_layers
import check_names
import check_references
import check_sizes
import check_text
import cpp_functions

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "bench"))
import test_ratio  # noqa: E402

LICENCE = "// SPDX-License-Identifier: BSD-3-Clause\n"
HEAD = LICENCE + "// Example source for the checks.\n"


class TreeTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.folder.name)
        self.addCleanup(self.folder.cleanup)

    def write(self, path, text):
        file = self.root / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")


class Names(TreeTest):
    def problems(self, *texts):
        for i, text in enumerate(texts):
            self.write(f"libs/l{i}/src/a.h", text)
        return check_names.check(self.root)[0]

    def test_one_name_in_two_places(self):
        found = self.problems("namespace roomgraph {\nstruct View {\n  int a;\n};\n}\n",
                              "namespace roomgraph {\n\nclass View final : public Base<int> {\n};\n}\n")
        self.assertEqual(found, ["libs/l1/src/a.h:3: roomgraph::View is defined at libs/l0/src/a.h:2 already"])
        self.assertEqual(len(self.problems("namespace roomgraph {\nenum class Kind { kA };\n}\n",
                                           "namespace roomgraph {\nenum class Kind : int { kB };\n}\n")), 1)

    def test_what_is_no_second_definition(self):
        one = "namespace roomgraph {\nstruct View { int a; };\ntemplate <class T, class U = std::vector<T>>\nT f() { return {}; }\n"
        self.assertEqual(self.problems(one + "}\n", "namespace roomgraph {\nclass View;\n}\n",
                                       "namespace roomgraph {\nnamespace {\nstruct View { int b; };\n}\n}\n",
                                       "namespace roomgraph::test {\nstruct View { int b; };\n}\n",
                                       "namespace roomgraph {\nstruct Outer {\n  struct View { int b; };\n  View v{};\n};\n"
                                       "template <class T>\nvoid g(T) {\n  struct View { int b; };\n}\n}\n"), [])


    def test_constants_of_one_library(self):
        self.write("libs/l0/src/a.cpp", "namespace {\nconstexpr int kLeast = 3, kMost = 4;\n}\n")
        self.write("libs/l0/src/b.cpp", "namespace {\n#if X\nconstexpr bool kOn = true;\n#else\nconstexpr bool kOn = false;\n#endif\n"
                                        "int f() {\n  constexpr int kLeast = 1;\n  return kLeast;\n}\nconst double kOther = 2 * kLeast;\n}\n")
        self.write("libs/l0/src/e.cpp", "namespace {\nconst int kFirst{kMost[0]}, kLast = f(1, kMost(2));\n}\n")
        self.write("libs/l1/src/c.cpp", "namespace {\nconst double kLeast = 2;\n}\n")
        self.assertEqual(check_names.check(self.root)[0], [])
        self.write("libs/l0/src/d.cpp", "namespace {\nconst double kFew{1}, kMost[] = {1, 2};\n}\n")
        self.assertEqual(check_names.check(self.root)[0], ["libs/l0/src/d.cpp:2: kMost is defined at libs/l0/src/a.cpp:2 already"])

    def test_other_names_for_types_of_one_library(self):
        self.write("libs/l0/src/a.cpp", "namespace {\nusing View = int;\nusing Many = int;\n}\n")
        self.write("libs/l0/src/b.cpp", "namespace {\nusing View = int;\nvoid f() {\n  using Many = float;\n}\n}\n")
        self.assertEqual(check_names.check(self.root)[0], [])
        self.write("libs/l0/src/c.cpp", "namespace {\nusing View = float;\nstruct Many {};\n}\n")
        self.assertEqual(check_names.check(self.root)[0], ["libs/l0/src/c.cpp:3: Many is defined at libs/l0/src/a.cpp:3 already",
                                                           "libs/l0/src/c.cpp:2: View is defined at libs/l0/src/a.cpp:2 already"])

    def test_anonymous_types_of_one_library(self):
        text = "namespace roomgraph {\nnamespace {\nstruct View { int a; };\n}\n}\n"
        self.write("libs/l0/src/b.cpp", text)
        found = self.problems(text, text)
        self.assertEqual(found, ["libs/l0/src/b.cpp:3: roomgraph::(anonymous)::View is defined at libs/l0/src/a.h:3 already"])


class Headers(TreeTest):
    def problems(self, listed, **files):
        for name, text in {"lidar/include/roomgraph/lidar/a.h": "", **files}.items():
            self.write(f"libs/{name}", text)
        self.write("list.txt", listed)
        return check_headers.check(self.root, self.root / "list.txt")[0]

    def test_a_user_in_another_library_an_app_a_plugin_or_outside(self):
        include = '#include "roomgraph/lidar/a.h"\n'
        for user in ("libs/mapping/src/b.cpp", "apps/b.cpp", "plugins/p/b.h", "tests/tooling/consumer/main.cpp"):
            self.write(user, include)
            self.assertEqual(self.problems("# all\nlidar/a.h\n"), [], user)
            (self.root / user).unlink()

    def test_nobody_outside_includes_it(self):
        for user in ("libs/lidar/src/b.cpp", "tests/lidar/b.cpp"):
            self.write(user, '#include "roomgraph/lidar/a.h"\n')
        self.assertEqual(self.problems("lidar/a.h\n"),
                         ["libs/lidar/include/roomgraph/lidar/a.h: no other library, app or plug-in includes it: it belongs into src/"])
        self.assertEqual(self.problems("lidar/a.h  for programs that read maps\n"), [])

    def test_a_header_that_a_needed_header_needs(self):
        files = {"lidar/include/roomgraph/lidar/b.h": '#include "roomgraph/lidar/a.h"\n'}
        self.assertEqual(len(self.problems("lidar/a.h\nlidar/b.h\n", **files)), 2)
        self.write("apps/c.cpp", '#include "roomgraph/lidar/b.h"\n')
        self.assertEqual(self.problems("lidar/a.h\nlidar/b.h\n", **files), [])

    def test_the_list_is_complete_and_true(self):
        self.write("apps/b.cpp", '#include "roomgraph/lidar/a.h"\n')
        self.assertEqual(self.problems(""), ["libs/lidar/include/roomgraph/lidar/a.h: is not in list.txt"])
        self.assertEqual(self.problems("lidar/a.h\nlidar/b.h\n"), ["list.txt: there is no public header 'lidar/b.h'"])
        self.assertEqual(self.problems("lidar/a.h for others\n"), ["list.txt: 'lidar/a.h' has users: it needs no reason"])


class TestRatio(TreeTest):
    CODE = "// comment\n\nint f() {  /* another\n  */ return 1;\n}\n"  # three lines of code

    def test_only_lines_with_code_count(self):
        self.assertEqual(test_ratio.count(self.CODE), 3)
        self.assertEqual(test_ratio.count('const char* s = "// no comment";  // one\n#include "a.h"  // two\n// three\n'), 2)

    def test_the_table_and_its_limits(self):
        self.write("libs/lidar/src/a.cpp", self.CODE * 2)
        self.write("libs/lidar/CMakeLists.txt", "x\n" * 99)
        self.write("apps/a.cpp", self.CODE)
        self.write("tests/lidar/a_test.cpp", self.CODE)
        self.write("tests/support/b.h", self.CODE)
        rows = test_ratio.table(self.root)
        self.assertEqual(rows, [("lidar", 6, 3), ("overall", 9, 6)])
        self.assertEqual(test_ratio.too_low(rows, 0.5, 0.66), [])
        self.assertEqual(test_ratio.too_low(rows, 0.51, 0.67), ["lidar", "overall"])
        self.assertEqual(test_ratio.too_low([("overall", 0, 0)], 0.5, 0.6), ["overall"])


class Layers(TreeTest):
    def problems(self, path, text):
        self.write(path, text)
        return check_layers.check(self.root)[0]

    def test_downward_and_own_includes_are_fine(self):
        self.assertEqual(self.problems("libs/lidar/src/a.cpp", '#include "roomgraph/lidar/a.h"\n'
                                       '#include "roomgraph/core/errors.h"\n#include "own.h"\n#include <vector>\n'), [])

    def test_upward_sideways_unknown(self):
        found = self.problems("libs/lidar/src/a.cpp", '#include "roomgraph/pipeline/a.h"\n'
                              '  #  include <roomgraph/mapping/b.h>\n#include "roomgraph/nonsense/c.h"\n')
        self.assertEqual(len(found), 3)
        self.assertIn("a.cpp:1: lidar (level 3) reaches upwards to pipeline", found[0])
        self.assertIn("a.cpp:2: lidar (level 3) reaches sideways to mapping", found[1])
        self.assertIn("unknown library 'nonsense'", found[2])

    def test_relative_path_out_of_the_folder(self):
        self.assertIn("leaves its folder", self.problems("libs/core/src/a.cpp", '#include "../../lidar/src/x.h"\n')[0])

    def test_heavy_headers_are_for_src_only(self):
        text = "#include <opencv2/dnn.hpp>\n#include <ceres/ceres.h>\n#include <opencv2/features2d.hpp>\n" \
               "#include <opencv2/core/mat.hpp>\n"
        self.assertEqual(len(self.problems("libs/tracking/include/roomgraph/tracking/a.h", text)), 3)
        (self.root / "libs/tracking/include/roomgraph/tracking/a.h").unlink()
        self.assertEqual(self.problems("libs/tracking/src/a.h", text), [])

    def test_the_table_of_the_document_says_the_same(self):
        self.write("docs/architecture.md", "| level | library |\n| --- | --- |\n| 0 | core | x |\n| 2 | lidar | y |\n| 9 | attic | z |\n")
        self.write("libs/core/src/a.cpp", "")
        self.write("libs/mapping/src/a.cpp", "")
        found = self.problems("libs/lidar/src/a.cpp", "")
        self.assertEqual(len(found), 3)
        self.assertIn("there is no library 'attic'", found[0])
        self.assertIn("'lidar' has level 2, check_layers.py says 3", found[1])
        self.assertIn("'mapping' is missing", found[2])

    def test_links_follow_the_same_rule(self):
        found = self.problems("libs/backend/CMakeLists.txt", "roomgraph_add_library(backend SOURCES src/a.cpp\n"
                              "  PUBLIC roomgraph::observations roomgraph::mapping)\n")
        self.assertEqual(len(found), 1)
        self.assertIn("CMakeLists.txt:2: backend (level 3) reaches sideways to mapping", found[0])

    def test_only_gui_opens_windows(self):
        self.assertEqual(self.problems("gui/a.cpp", "#include <mrpt/" "gui/CDisplayWindow3D.h>\n"), [])
        self.assertIn("only gui/", self.problems("apps/roomgraph/a.cpp", "#include <mrpt/" "gui/CDisplayWindow3D.h>\n")[0])
        (self.root / "apps/roomgraph/a.cpp").unlink()
        self.assertIn("only gui/", self.problems("CMakeLists.txt", "find_package(mrpt-" + "gui REQUIRED)\n")[0])

    def test_library_without_level(self):
        self.assertIn("has no level", self.problems("libs/extra/src/a.cpp", "")[0])


LONG = "int f() {\n" + "  g();\n" * 59 + "}\n"      # 61 lines


class Sizes(TreeTest):
    def problems(self, path, text, allowed=""):
        self.write(path, text)
        self.write("allowed.txt", allowed)
        return check_sizes.check(self.root, self.root / "allowed.txt")[0]

    def test_long_function(self):
        found = self.problems("libs/core/src/a.cpp", "\n" + LONG)
        self.assertEqual(found, ["libs/core/src/a.cpp:2: function f of 61 lines, at most 60"])

    def test_function_at_the_limit(self):
        self.assertEqual(self.problems("libs/core/src/a.cpp", LONG.replace("  g();\n", "", 1)), [])

    def test_long_file(self):
        self.assertEqual(self.problems("tests/core/a.h", "//\n" * 400), [])
        self.assertEqual(self.problems("tests/core/a.h", "//\n" * 401), ["tests/core/a.h: file of 401 lines, at most 400"])

    def test_scripts_and_styles_of_pages(self):
        script = LONG.replace("int f()", "function f(a, { b })")
        self.assertEqual(self.problems("libs/report/page/a.js", script), ["libs/report/page/a.js:1: function f of 61 lines, at most 60"])
        self.assertEqual(len(self.problems("libs/report/page/a.css", "a { b: c; }\n" * 401)), 2)

    def test_exceptions(self):
        name = "libs/core/src/a.cpp"
        self.assertEqual(self.problems(name, LONG, f"# list\n{name}:f 61 a table\n"), [])
        self.assertEqual(len(self.problems(name, LONG, f"{name}:f 60 a table\n")), 1)
        self.assertIn("needs no exception", self.problems(name, "int a;\n", f"{name}:f 61 a table\n")[0])
        with self.assertRaises(SystemExit):
            self.problems(name, LONG, f"{name}:f 61\n")


class CppFunctions(unittest.TestCase):
    def names(self, text):
        return [(f.name, f.line, f.lines) for f in cpp_functions.find(textwrap.dedent(text))]

    def test_scopes_members_and_templates(self):
        self.assertEqual(self.names("""\
            namespace a::b {
            class X final : public Y {
             public:
              X() : a_{1}, b_(2) {
                go();
              }
              ~X() override { stop(); }
              bool operator==(const X&) const { return true; }
              int a_{0}, b_ = {3};
            };
            template <class T, int N = 3>
            auto f(T t, std::vector<int> v = {1, 2}) -> std::vector<T>
            {
              if (t) { return {}; }
            }
            enum class E { kA, kB };
            }  // namespace a::b
            """), [("X", 4, 3), ("~X", 7, 1), ("operator==", 8, 1), ("f", 11, 5)])

    def test_braces_in_literals_comments_and_macros_do_not_count(self):
        self.assertEqual(self.names("""\
            #define OPEN {
            // {
            /* { */ int f() {
              const char* a = "{"; char b = '{'; auto c = R"x({ " )x"; int d = 1'000'000;
              return 0;  // }
            }
            int g() { return 1; }
            """), [("f", 3, 4), ("g", 7, 1)])

    def test_macros_without_semicolon(self):
        self.assertEqual(self.names("REGISTER(A, ns)\nREGISTER(B,\n         ns)\nnamespace {\nint f() {\n}\n}\n"),
                         [("f", 5, 2)])
        self.assertEqual(self.names("INITIALIZER(a)\n{\n}\n"), [("INITIALIZER", 1, 3)])

    def test_tables_are_no_functions(self):
        self.assertEqual(self.names("const int kTable[] = {\n1,\n2,\n};\nstd::map<int, int> m{{1, 2}};\nint f() {}\n"),
                         [("f", 6, 1)])

    def test_lambdas_belong_to_their_function(self):
        self.assertEqual(self.names("void f() {\n  run([&](int a) {\n    a = {1};\n  });\n}\n"), [("f", 1, 5)])

    def test_tests_have_names(self):
        self.assertEqual(self.names("TEST(Suite, Case) {\n}\n"), [("Suite.Case", 1, 2)])


class Text(TreeTest):
    def problems(self, path, text):
        self.write(path, text)
        return check_text.check(self.root)[0]

    def test_clean(self):
        self.assertEqual(self.problems("libs/core/src/a.cpp", HEAD + "int workload;  // see ../shared/work of others\n"), [])

    def test_words_and_paths(self):
        for bad in ("// TO" + "DO: later", "/* FIX" + "ME */", "// X" + "XX", '"/wo' + 'rk/data"', "see /ho" + "me/me"):
            self.assertEqual(len(self.problems("libs/core/src/a.cpp", HEAD + bad + "\n")), 1, bad)
        self.assertEqual(len(self.problems("README.md", "TO" + "DO\n")), 2)

    def test_licence(self):
        self.assertIn("no licence line", self.problems("tests/core/a.cpp", "int a;\n")[0])
        self.assertEqual(self.problems("tests/core/a.cpp", HEAD), [])

    def test_every_file_says_what_it_holds(self):
        for second in ("", "#pragma once\n", "// Too few words.\n",
                       "// Part of roomgraph, object-level semantic SLAM.\n"):
            self.assertIn("a.h:2: the second line does not say", self.problems("libs/core/src/a.h", LICENCE + second)[0])
        self.assertIn("first line is not the licence", self.problems("libs/core/src/a.h", "\n" + LICENCE)[0])
        self.assertEqual(self.problems("libs/core/src/a.h", HEAD), [])

    def test_a_caption_is_for_two_files_at_most(self):
        self.write("libs/core/src/a.h", HEAD)
        self.assertEqual(self.problems("libs/core/src/a.cpp", HEAD), [])
        found = self.problems("libs/core/src/b.cpp", HEAD)
        self.assertEqual(len(found), 1)
        self.assertIn("libs/core/src/b.cpp:2: 'Example source for the checks.' is said of libs/core/src/a.cpp already", found[0])


METHOD = """\
# The method

## 1. From an image
### 1.2 Ground plane
### 1.A Cylinder
## 4. Association
See Eq. 5 of sec. 4 and `sec. n`.

**Eq. 3** (paper)

**Eq. 4** (paper)

**Eq. 5** (paper)
"""


class References(TreeTest):
    def problems(self, path, text, method=METHOD):
        self.write("docs/method.md", method)
        self.write(path, text)
        return check_references.check(self.root)[0]

    def test_citations_that_resolve(self):
        self.assertEqual(self.problems("libs/core/src/a.cpp", "// method.md sec. 1.2 to 1.A, and sec. 4; Eq. 3 to 5 (Eq.\n"
                                       "/// 4), paper sec. IV.A, Eqs. 3, 4 and 5, Eq. 3.\n"), [])

    def test_citations_that_do_not(self):
        for bad in ("sec. 2", "sec. 1.B", "sec. 1.2 to 1.D", "Eq. 6", "Eq. 3 to 7", "Eq. (9)", "sec.\n/// 7", "Eq. 3, 6"):
            self.assertEqual(len(self.problems("libs/core/src/a.h", f"int a;  // {bad}\n")), 1, bad)
        self.assertEqual(self.problems("libs/core/src/a.h", "int a;\nint b;  ///< paper Eq. 10\n"),
                         ["libs/core/src/a.h:2: docs/method.md has no Eq. 10"])

    def test_citations_in_every_kind_of_file(self):
        for path in ("a.py", "config.ini", "docs/a.md", "tests/core/a.cpp", "apps/a.h"):
            self.assertEqual(len(self.problems(path, "sec. 7\n")), 1, path)
            (self.root / path).unlink()
        self.assertEqual(len(self.problems("docs/method.md", METHOD + "sec. 7\n", METHOD)), 1)

    def test_other_works(self):
        self.assertEqual(self.problems("libs/core/src/a.h", "// Hess et al. 2016, Eq. 14\n// (Umeyama\n// 1991, Eq. 40-42)\n"
                                       "// (Rublee et al., Eq. 1-3)\n// Hess et al. 2016, sec. 7\n"), [])
        for ours in ("(Hess et al. 2016); sec. 7", "Hess et al. (2016), Eq. 9", "Hess et al. 2016; sec. 8"):
            self.assertEqual(len(self.problems("libs/core/src/a.h", f"// {ours}\n")), 1, ours)

    def test_links(self):
        self.write("docs/picture.png", "")
        self.write("docs/other.md", "# Placing sensors\n## A `b_c` (d): e\n## Twice\n## Twice\n```\n# no heading\n```\n")
        good = "[a](other.md) ![p](picture.png) [b](other.md#placing-sensors) [c](other.md#a-b_c-d-e) [d](../docs) [e](#mine)\n" \
               "[f](https://example.org/x.md#y) [g](mailto:a@b.c) [h](other.md#twice-1) `[i](none.md)`\n# Mine\n" \
               "```\n[j](none.md)\n```\n"
        self.assertEqual(self.problems("docs/a.md", good), [])
        self.assertEqual(self.problems("docs/a.md", "\n[a](none.md)\n"), ["docs/a.md:2: no file none.md"])
        self.assertEqual(self.problems("docs/a.md", "[a\nb](other.md#none)\n"), ["docs/a.md:1: other.md has no heading #none"])
        for bad in ("[a](#none)", "[a](other.md#no-heading)", "[a](other.md#twice-2)", "[a](docs/other.md)"):
            self.assertEqual(len(self.problems("docs/a.md", bad + "\n")), 1, bad)

    def test_a_missing_page_is_a_problem(self):
        self.write("libs/core/src/a.h", "// nothing\n")
        self.assertEqual(check_references.check(self.root), (["docs/method.md is missing"], 1))


class Vacuous(TreeTest):
    def test_an_empty_tree_is_noticed(self):
        for check in (check_layers.check, check_text.check, lambda root: check_headers.check(root, root / "list.txt")):
            self.assertEqual(check(self.root), ([], 0))


if __name__ == "__main__":
    unittest.main()
