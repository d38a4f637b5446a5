"""clang-format has nothing to change in any C++ file of src/, tests/ and benchmarks/. Usage: format.py ROOT"""
import pathlib
import re
import shutil
import subprocess
import sys


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    if shutil.which("clang-format") is None:
        sys.exit("clang-format is not installed; run scripts/install.sh")
    files = [str(file.relative_to(root)) for top in ("src", "tests", "benchmarks", "python")
             for file in sorted((root / top).rglob("*")) if file.suffix in {".h", ".cpp"}]
    result = subprocess.run(["clang-format", "--dry-run", "-Werror", *files], cwd=root, capture_output=True, text=True,
                            check=False)
    places = dict.fromkeys(re.findall(r"^(\S+:\d+):\d+: error", result.stderr, re.MULTILINE))
    if result.returncode != 0 and not places:
        sys.exit(f"{result.stderr}clang-format exited with {result.returncode}")
    print("\n".join(f"{place}: not as clang-format has it" for place in places) or f"{len(files)} files")
    if places:
        sys.exit(f"Run: clang-format -i {' '.join(dict.fromkeys(place.split(':')[0] for place in places))}")


main()
