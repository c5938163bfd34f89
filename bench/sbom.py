#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Bill of materials of a built program, as SPDX 2.3 JSON: the Debian packages of the shared libraries that it loads.

Usage: sbom.py PROGRAM [-o FILE] [--version VERSION]

    bench/sbom.py build/release/bin/roomgraph -o sbom.spdx.json

The same program on the same system gives the same bytes. Libraries of no package (the program's own) are left out, unless
they are missing, which is an error. Exit code 3: PROGRAM is not there or is no program.
"""
import argparse
import hashlib
import json
import pathlib
import re
import subprocess
import sys

LIBRARY = re.compile(r"^\s*(\S+) => (\S+|not found)", re.MULTILINE)
FIELDS = ("Package", "Version", "Architecture", "source:Package", "source:Version")


def libraries(program):
    """Files of all shared libraries that the loader finds for the program, without symbolic links."""
    found = subprocess.run(["ldd", str(program)], capture_output=True, text=True, check=False)
    if found.returncode != 0:
        raise ValueError(f"{program}: {(found.stderr or found.stdout).strip()}")
    files = set()
    for name, file in LIBRARY.findall(found.stdout):
        if file.startswith("not"):
            raise ValueError(f"{program}: needs {name}, which is not there")
        files.add(pathlib.Path(file).resolve())
    return sorted(files)


def owners(files):
    """Packages of files; those of no package are left out. Debian's database may know a path from before /usr was merged."""
    paths = [path for file in files for path in (str(file), str(file).removeprefix("/usr"))]
    found = subprocess.run(["dpkg-query", "-S", *paths], capture_output=True, text=True, check=False)
    return sorted({line.split(": ")[0].split(",")[0] for line in found.stdout.splitlines() if not line.startswith("diversion")})


def package_entries(names):
    form = "\\t".join("${%s}" % field for field in FIELDS) + "\\n"
    found = subprocess.run(["dpkg-query", "-W", "-f", form, *names], capture_output=True, text=True, check=True)
    return [package_entry(*line.split("\t")) for line in found.stdout.splitlines()]


def package_entry(package, version, architecture, source, source_version):
    return {"SPDXID": "SPDXRef-" + re.sub(r"[^A-Za-z0-9.-]", "-", package), "name": package, "versionInfo": version,
            "supplier": "Organization: Debian", "downloadLocation": "NOASSERTION", "filesAnalyzed": False,
            "sourceInfo": f"source package {source} {source_version}",
            "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",
                              "referenceLocator": f"pkg:deb/debian/{package}@{version}?arch={architecture}"}]}


def document(program, version):
    entries = sorted(package_entries(owners(libraries(program))), key=lambda entry: entry["name"])
    digest = hashlib.sha256(pathlib.Path(program).read_bytes()).hexdigest()
    own = {"SPDXID": "SPDXRef-roomgraph", "name": "roomgraph", "versionInfo": version, "downloadLocation": "NOASSERTION",
           "filesAnalyzed": False, "licenseDeclared": "BSD-3-Clause",
           "checksums": [{"algorithm": "SHA256", "checksumValue": digest}]}
    relations = [{"spdxElementId": "SPDXRef-DOCUMENT", "relationshipType": "DESCRIBES", "relatedSpdxElement": own["SPDXID"]}]
    relations += [{"spdxElementId": own["SPDXID"], "relationshipType": "DYNAMIC_LINK", "relatedSpdxElement": entry["SPDXID"]}
                  for entry in entries]
    return {"spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT", "name": "roomgraph",
            "documentNamespace": f"https://spdx.org/spdxdocs/roomgraph-{digest}",
            "creationInfo": {"creators": ["Tool: bench/sbom.py"], "created": "1970-01-01T00:00:00Z"},
            "packages": [own] + entries, "relationships": relations}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("-o", "--output", type=pathlib.Path, help="default: standard output")
    parser.add_argument("--version", default="NOASSERTION", help="of the program")
    arguments = parser.parse_args()
    try:
        text = json.dumps(document(arguments.program, arguments.version), indent=1) + "\n"
    except (OSError, ValueError) as error:
        print(f"sbom.py: {error}", file=sys.stderr)
        sys.exit(3)
    if arguments.output:
        arguments.output.write_text(text, encoding="utf-8")
    else:
        print(text, end="")


if __name__ == "__main__":
    main()
