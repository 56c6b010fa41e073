#!/usr/bin/env python3
"""Writes the record of the plugin ABI from api/portcullis/culler.h: tests/abi/culler_abi1.h, a copy of the header, and
tests/abi/abi1_record.c, every size, offset and value of it. usage: freeze.py ROOT. Only while CULL_ABI is 0, or for new extensions:
what the old record holds must still hold, or tests/repo/abi_record.sh fails.
SPDX-License-Identifier: MIT
"""
import os
import re
import subprocess
import sys
import tempfile

HEAD = """// The plugin ABI, number 1, on LP64: the size and alignment of each struct, the place and size of each field, each enumerator.
// Written by freeze.py. Invariant: no line of it changes while CULL_ABI is 1; new extensions add lines.
// SPDX-License-Identifier: MIT
#include <portcullis/culler.h>

#if defined(__cplusplus)
#define HOLDS(condition, name) static_assert(condition, name)
#define ALIGN(type) alignof(type)
#else
#define HOLDS(condition, name) _Static_assert(condition, name)
#define ALIGN(type) _Alignof(type)
#endif
#define SIZE(type, bytes, align) HOLDS(sizeof(type) == (bytes) && ALIGN(type) == (align), "size of " #type)
#define AT(type, field, place, bytes) HOLDS(offsetof(type, field) == (place) && sizeof(((type *)0)->field) == (bytes), #type "." #field)
#define VALUE(name, number) HOLDS((name) == (number), #name)

#if defined(__LP64__)
"""


def without_comments(text):
    return re.sub(r"/\*.*?\*/", "", re.sub(r"//[^\n]*", "", text), flags=re.S)


def split_outside(text, mark):
    """text at each `mark` that no bracket encloses"""
    parts, depth, start = [], 0, 0
    for i, c in enumerate(text):
        depth += (c in "([{") - (c in ")]}")
        if c == mark and depth == 0:
            parts.append(text[start:i])
            start = i + 1
    return parts + [text[start:]]


def fields(body):
    for declaration in filter(str.strip, split_outside(body, ";")):
        for part in split_outside(declaration, ","):
            pointer = re.search(r"\(\*(\w+)\)", part)
            yield pointer[1] if pointer else re.search(r"(\w+)\s*(\[[^]]*\])*\s*$", part.strip())[1]


def contract(text):
    structs = [(name, list(fields(body))) for name, body in re.findall(r"\bstruct\s+(\w+)\s*\{([^{}]*)\}", text)]
    handles = set(re.findall(r"typedef\s+struct\s+(\w+)\s+\1\s*;", text)) - {name for name, _ in structs}
    values = [re.match(r"\s*(\w+)", part)[1] for body in re.findall(r"\benum\s*\w*\s*\{([^}]*)\}", text) for part in body.split(",") if part.strip()]
    values += [name for name in re.findall(r"#define\s+(CULL_\w+)\s+\d+u\b", text) if name != "CULL_ABI"]
    scalars = re.findall(r"typedef\s+u?int\d+_t\s+(\w+)\s*;", text)
    return structs, handles, values, scalars


def measured(root, structs, values, scalars):
    lines = [f'printf("SIZE({s}, %zu, %zu);\\n", sizeof({s}), _Alignof({s}));' for s in scalars]
    for name, members in structs:
        lines.append(f'printf("\\nSIZE({name}, %zu, %zu);\\n", sizeof({name}), _Alignof({name}));')
        lines += [f'printf("AT({name}, {m}, %zu, %zu);\\n", offsetof({name}, {m}), sizeof((({name} *)0)->{m}));' for m in members]
    lines.append('printf("\\n");')
    lines += [f'printf("VALUE({v}, %lld);\\n", (long long){v});' for v in values]
    with tempfile.TemporaryDirectory() as folder:
        source, program = os.path.join(folder, "print.c"), os.path.join(folder, "print")
        with open(source, "w", encoding="ascii") as file:
            file.write("#include <portcullis/culler.h>\n#include <stdio.h>\nint main(void)\n{\n" + "\n".join(lines) + "\nreturn 0;\n}\n")
        subprocess.run([os.environ.get("CC", "gcc"), "-std=c11", "-I", os.path.join(root, "api"), source, "-o", program], check=True)
        return subprocess.run([program], check=True, capture_output=True, text=True).stdout


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: freeze.py ROOT")
    root = sys.argv[1]
    folder = os.path.join(root, "tests", "abi")
    with open(os.path.join(root, "api", "portcullis", "culler.h"), encoding="utf-8") as file:
        header = file.read()
    structs, _, values, scalars = contract(without_comments(header))
    with open(os.path.join(folder, "abi1_record.c"), "w", encoding="ascii") as file:
        file.write(HEAD + measured(root, structs, values, scalars) + "#endif\n")
    number = re.compile(r"^#define CULL_ABI \d+u$", re.M)
    assert number.search(header)
    with open(os.path.join(folder, "culler_abi1.h"), "w", encoding="utf-8") as file:
        file.write("// A copy of api/portcullis/culler.h as ABI number 1 has it, by freeze.py: plugins built with it must work with today's host.\n")
        file.write(number.sub("#ifndef CULL_ABI // the tests say 0 while the host's number is 0\n#define CULL_ABI 1u\n#endif", header))
    print(f"{len(structs)} structs, {sum(len(m) for _, m in structs)} fields, {len(values)} values")


main()
