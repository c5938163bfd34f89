#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# Part of roomgraph, object-level semantic SLAM.
"""Citations and links lead somewhere.

Usage: check_references.py ROOT

Citations: every "sec. n", "sec. n.m" and "Eq. n" (also "Eq. 3 to 7", "sec. 4 and 6") in sources and documents is a
section or equation of docs/method.md: a heading "## 4. Title" or "### 4.1 Title", a line "**Eq. 10** (paper)".
A citation belongs to another work, and is not looked up, when a year or "et al." stands before it on its line with no
bracket or semicolon in between: "Hess et al. 2016, Eq. 3", "(Umeyama 1991, Eq. 40-42)". Sections with Roman numbers
are never ours.

Links: in Markdown, a relative target exists, and an #anchor is a heading of the file it points to.
"""
import pathlib
import re
import sys

import source_files

METHOD = pathlib.Path("docs/method.md")
CITING = {".h", ".cpp", ".py", ".ini", ".md"}

# A citation may go on in the next line, behind its comment sign.
GAP = r"(?:[ \t]|\n[ \t]*(?://[/!]?<?|#|\*)?[ \t]*)*"
NUMBER = r"\d+(?:\.(?:\d+|[A-Z])\b)?"
MORE = rf"{GAP}(?:,|-|–|\bto\b|\band\b){GAP}"
CITATION = re.compile(rf"\b(?P<kind>[Ss]ecs?|[Ee]qs?)\.{GAP}\(?(?P<numbers>{NUMBER}(?:{MORE}{NUMBER})*)")
OTHER_WORK = re.compile(r"(?:\b(?:19|20)\d\d\b|\bet al\.)[^;()\[\]]*$")

HEADING = re.compile(r"^(#{1,6})\s+(.*?)\s*$", re.MULTILINE)
SECTION = re.compile(rf"({NUMBER})\.?\s")
EQUATION = re.compile(r"^\*\*Eq\. (\d+)\*\*", re.MULTILINE)
FENCED = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)
INLINE_CODE = re.compile(r"`[^`\n]*`")
LINK = re.compile(r"\[[^\]]*\]\(\s*<?([^)\s>]+)>?[^)]*\)")
ELSEWHERE = re.compile(r"[a-z][a-z0-9+.-]*:")


def without_code(text):
    """The text with code blanked out; lines stay where they are."""
    blank = lambda match: re.sub(r"[^\n]", " ", match.group(0))
    return INLINE_CODE.sub(blank, FENCED.sub(blank, text))


def method_numbers(text):
    """Numbers of the sections and of the equations of the method's page."""
    sections = (SECTION.match(title) for _, title in HEADING.findall(text))
    return {"sec": {match.group(1) for match in sections if match}, "eq": set(EQUATION.findall(text))}


def line_of(text, offset):
    return text.count("\n", 0, offset) + 1


def citations(text):
    """(line, "sec" or "eq", number) of every citation of the method."""
    for match in CITATION.finditer(text):
        before = text[text.rfind("\n", 0, match.start()) + 1:match.start()]
        if OTHER_WORK.search(before):
            continue
        kind = match.group("kind").lower().rstrip("s")
        for number in re.findall(NUMBER, match.group("numbers")):
            yield line_of(text, match.start()), kind, number


def check_citations(path, text, known):
    for line, kind, number in citations(text):
        if number not in known[kind]:
            yield f"{path}:{line}: {METHOD} has no {'sec.' if kind == 'sec' else 'Eq.'} {number}"


def anchors(text):
    """Anchors of the headings, as GitHub makes them."""
    found = set()
    for _, title in HEADING.findall(FENCED.sub("", text)):
        title = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", title).lower()
        anchor = re.sub(r"[^\w\- ]", "", title).replace(" ", "-")
        repeated = sum(1 for other in found if re.fullmatch(rf"{re.escape(anchor)}(-\d+)?", other))
        found.add(f"{anchor}-{repeated}" if repeated else anchor)
    return found


def check_links(root, path, text):
    text = without_code(text)
    for match in LINK.finditer(text):
        target, _, anchor = match.group(1).partition("#")
        if ELSEWHERE.match(match.group(1)):
            continue
        place = f"{path}:{line_of(text, match.start())}"
        file = root / path.parent / target if target else root / path
        if not file.exists():
            yield f"{place}: no file {target}"
        elif anchor and file.suffix == ".md" and anchor not in anchors(file.read_text(encoding="utf-8")):
            yield f"{place}: {target or path.name} has no heading #{anchor}"


def check(root):
    root = pathlib.Path(root)
    if not (root / METHOD).exists():
        return [f"{METHOD} is missing"], 1
    known = method_numbers(source_files.read(root, METHOD))
    problems, checked = [], 0
    for path in source_files.files(root, CITING):
        if path.parent.name == "tooling":  # these hold examples
            continue
        checked += 1
        text = source_files.read(root, path)
        problems += check_citations(path, text, known)
        if path.suffix == ".md":
            problems += check_links(root, path, text)
    return problems, checked


if __name__ == "__main__":
    source_files.finish("references", *check(sys.argv[1]))
