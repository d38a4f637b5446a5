"""clang-tidy over modules of src/ in one go. Usage: tidy.py ROOT BUILD MODULE...

Reading Eigen, PETSc and their like costs seconds for every file that includes them, and instantiating templates as much
again. So all source files of the named modules are read as one, without their explicit instantiations, with the flags that
BUILD/compile_commands.json has for these modules, and only checks that are cheap on other people's headers are made. The whole set of
.clang-tidy is for `clang-tidy -p BUILD FILE...` by hand.

Since the files are read together, no two of them may have local helpers of equal name.
"""
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

CHECKS = """
    readability-identifier-naming readability-simplify-boolean-expr readability-inconsistent-declaration-parameter-name
    readability-const-return-type readability-misleading-indentation readability-redundant-access-specifiers
    readability-redundant-member-init readability-redundant-smartptr-get readability-redundant-string-cstr
    readability-redundant-string-init
    modernize-concat-nested-namespaces modernize-loop-convert modernize-make-unique
    modernize-use-equals-default modernize-use-equals-delete modernize-use-override
    bugprone-argument-comment bugprone-branch-clone bugprone-copy-constructor-init bugprone-integer-division
    bugprone-move-forwarding-reference bugprone-string-constructor
    bugprone-swapped-arguments bugprone-too-small-loop-variable
    performance-for-range-copy performance-implicit-conversion-in-loop
    performance-noexcept-move-constructor
    misc-unused-alias-decls misc-unused-parameters
""".split()

# Its memory is one piece in pages of 2 MB: to fetch a gigabyte in pages of 4 kB cost a seventh of the time.
MEMORY = {"GLIBC_TUNABLES": "glibc.malloc.hugetlb=1:glibc.malloc.mmap_threshold=8000000000:glibc.malloc.trim_threshold=8000000000"}


def kept_flags(command):
    """Definitions and include paths of a compiler's command line."""
    words = iter(shlex.split(command))
    for word in words:
        if word == "-isystem":
            yield word, next(words)
        elif word.startswith(("-D", "-I")):
            yield (word,)


def joined(entries):
    """Flags of all entries, each once, in order."""
    return [word for flag in dict.fromkeys(flag for entry in entries for flag in kept_flags(entry["command"]))
            for word in flag]


def without_instantiations(source):
    """The source, with empty lines for `template class Name<2>;`, `TAILWATER_IN_2D_AND_3D(name);` and their like."""
    return re.sub(r"^(template (?!<)|TAILWATER_IN_2D_AND_3D\()[^;{]*;", lambda found: "\n" * found[0].count("\n"),
                  source, flags=re.MULTILINE)


def copied(source, root, folder):
    """The file as it is read, at the same place in `folder` as in the tree."""
    copy = folder / source.relative_to(root)
    copy.parent.mkdir(parents=True, exist_ok=True)
    copy.write_text(without_instantiations(source.read_text(encoding="utf-8")), encoding="utf-8")
    return copy


def findings(text, root, folder):
    """{"file:line: what [check]"} of those in the tree, each once: a header is seen by several files."""
    found = re.findall(r"^(\S+:\d+):\d+: (?:warning|error): (.*)$", text, re.MULTILINE)
    return dict.fromkeys(f"{place.removeprefix(f'{folder}/').removeprefix(f'{root}/')}: {what}" for place, what in found)


def main():
    root, build = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
    modules = sys.argv[3:]
    if shutil.which("clang-tidy") is None:
        sys.exit("clang-tidy is not installed; run scripts/install.sh")
    sources = [source for module in modules for source in sorted((root / "src" / module).rglob("*.cpp"))]
    # A file that the build joins from several sources stands below BUILD/src/MODULE.
    entries = [entry for entry in json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
               if any(pathlib.Path(entry["file"]).is_relative_to(top / "src" / module)
                      for module in modules for top in (root, build))]
    if not sources or not entries:
        sys.exit(f"src/{{{','.join(modules)}}} has {len(sources)} source files and {len(entries)} entries in "
                 f"{build}/compile_commands.json; give modules of src/CMakeLists.txt that have source files")
    folder = build / "style" / modules[0]
    unit = folder / "modules.cpp"
    copies = [copied(source, root, folder) for source in sources]
    unit.write_text("".join(f'#include "{copy}"\n' for copy in copies), encoding="utf-8")
    result = subprocess.run(
        ["clang-tidy", "--quiet", f"--config-file={root}/.clang-tidy", f"--checks=-*,{','.join(CHECKS)}",
         f"--header-filter=^({re.escape(str(root))}|{re.escape(str(folder))})/src/", str(unit), "--", "-std=c++20",
         *joined(entries)], capture_output=True, text=True, check=False, env={**os.environ, **MEMORY})
    found = findings(result.stdout, root, folder)
    if result.returncode != 0 and not found:
        sys.exit(f"{result.stdout}{result.stderr}clang-tidy exited with {result.returncode}")
    print("\n".join(found))
    print(f"{len(sources)} files, {len(found)} findings")
    if found:
        sys.exit("Mend these lines; where clang-tidy is wrong, put // NOLINT(check): why at the end of the line.")


main()
