#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Finds the functions of a C++ file by matching braces; no compiler needed.

Every brace block at namespace or class level that is neither a scope (namespace, class, enum …) nor an initialiser is
the body of a function. Comments, literals and preprocessor lines are blanked first.
"""
import collections
import re

Function = collections.namedtuple("Function", "name line lines")

TOKENS = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"(?P<tag>[^(\s]*)\(.*?\)(?P=tag)"|"(?:\\.|[^"\\\n])*"|(?<![0-9A-Fa-f])\'(?:\\.|[^\'\\\n])+\''
    r"|^[ \t]*#(?:\\\n|[^\n])*", re.DOTALL | re.MULTILINE)
# A macro that stands alone, without a semicolon: no part of the declaration that follows.
MACRO = re.compile(r"^[ \t]*[A-Z][A-Z0-9_]+\([^;{}]*?\)[ \t]*$(?!\s*\{)", re.MULTILINE)
LEAD = re.compile(r"(?:\s|\b(?:public|private|protected)\s*:)*")
SCOPE = re.compile(r'^(?:typedef\s+|inline\s+)*(?:namespace|class|struct|union|enum)\b|^extern\s*(?:""\s*)?$')


def blanked(text):
    """The text without comments, literals, preprocessor lines and lone macros; every line keeps its number."""
    def blank(match):
        token = match.group(0)
        return ('""' if token[0] in '"R' else " ") + "\n" * token.count("\n")
    return MACRO.sub(lambda match: "\n" * match.group(0).count("\n"), TOKENS.sub(blank, text))


def without_comments(text):
    """The text without comments; literals stay, and every line keeps its number."""
    def blank(match):
        token = match.group(0)
        return " " + "\n" * token.count("\n") if token.startswith(("//", "/*")) else strip_directive(token)
    return TOKENS.sub(blank, text)


def strip_directive(token):
    """A preprocessor line without the comment at its end; other tokens as they are."""
    return re.sub(r"//[^\n]*|/\*.*?\*/", " ", token, flags=re.DOTALL) if token.lstrip().startswith("#") else token


def without_groups(head, left, right):
    """`head` with the insides of (nested) groups removed."""
    out, depth = [], 0
    for c in head:
        depth -= c == right and depth > 0
        if depth == 0:
            out.append(c)
        depth += c == left
    return "".join(out)


def without_templates(head):
    head = head.strip()
    while head.startswith("template"):
        depth, i = 0, head.find("<")
        for i in range(max(i, 0), len(head)):
            depth += (head[i] == "<") - (head[i] == ">")
            if depth == 0:
                break
        head = head[i + 1:].strip()
    return head


def kind_of(head):
    """'scope', 'initialiser' or 'function'."""
    bare = without_templates(re.sub(r"\[\[.*?\]\]|\b(?:public|private|protected)\s*:", " ", head, flags=re.DOTALL))
    flat = without_groups(bare, "(", ")")
    if SCOPE.match(flat) and "(" not in flat:
        return "scope"
    no_operators = re.sub(r"operator\s*[^\s(\w]+", "operator", flat)
    if "=" in no_operators or "(" not in flat:
        return "initialiser"
    return "function"


def name_of(head):
    flat = without_templates(head)
    match = re.search(r"((?:~|operator\s*)?[\w:~]*(?:operator\s*\S+?)?)\s*\(", flat)
    if match and re.fullmatch(r"(?:TEST|TEST_F|TEST_P|TYPED_TEST)", match.group(1)):
        inside = re.search(r"\(([^)]*)\)", flat)
        return ".".join(part.strip() for part in inside.group(1).split(","))
    return match.group(1).strip() if match else "?"


class Finder:
    def __init__(self, text):
        self.text = blanked(text)
        self.found = []
        self.at = 0

    def line(self, position):
        return self.text.count("\n", 0, position) + 1

    def skip_block(self):
        """Moves behind the block that opens at self.at."""
        depth = 0
        while self.at < len(self.text):
            depth += {"{": 1, "}": -1}.get(self.text[self.at], 0)
            self.at += 1
            if depth == 0:
                return

    def next_character(self):
        match = re.compile(r"\S").search(self.text, self.at)
        return match.group(0) if match else ""

    def scan_scope(self):
        """Declarations up to the brace that closes this scope."""
        begin, parens = self.at, 0
        while self.at < len(self.text):
            c = self.text[self.at]
            parens += {"(": 1, ")": -1}.get(c, 0)
            if c == "}" and parens <= 0:
                self.at += 1
                return
            if c == ";" and parens <= 0:
                begin = self.at + 1
            if c == "{":
                begin = self.block(begin, parens)
                continue
            self.at += 1

    def block(self, begin, parens):
        head = self.text[begin:self.at]
        kind = "initialiser" if parens > 0 else kind_of(head)
        if kind == "scope":
            self.at += 1
            self.scan_scope()
            return self.at
        self.skip_block()
        # Inside parentheses, or in a list of member initialisers: the declaration goes on.
        if parens > 0 or self.next_character() in (",", "{"):
            return begin
        if kind == "function":
            first = self.line(begin + LEAD.match(head).end())
            last = self.line(self.at - 1)
            self.found.append(Function(name_of(head), first, last - first + 1))
        return self.at


def find(text):
    """Functions in the order of the file: name, first line, number of lines (signature included)."""
    finder = Finder(text)
    while finder.at < len(finder.text):
        finder.scan_scope()
    return finder.found
