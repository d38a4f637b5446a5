"""Starts a command of Tailwater that is a program in Python: python3 -m tailwater_validation.launch MODULE [arguments].

A missing library is reported in one line, with the Debian package that has it. This
module is not one of `tailwater`, because that package itself needs libraries."""

import runpy
import sys

# Module that Python imports: its usual name, and its Debian packages. Drawing in 3D needs Xvfb too.
LIBRARIES = {"numpy": ("NumPy", "python3-numpy"), "matplotlib": ("Matplotlib", "python3-matplotlib"),
             "PIL": ("Pillow", "python3-pil"), "scipy": ("SciPy", "python3-scipy"), "pandas": ("pandas", "python3-pandas"),
             "vtkmodules": ("VTK", "python3-vtk9 xvfb")}


def main():
    module = sys.argv.pop(1)
    try:
        runpy.run_module(module, run_name="__main__", alter_sys=True)
    except ImportError as error:
        library = (error.name or "").partition(".")[0]
        if library not in LIBRARIES:
            raise
        name, packages = LIBRARIES[library]
        print(f"error: this needs {name} for Python ({error}); remedy: apt install {packages}", file=sys.stderr)
        sys.exit(2)


if __name__ == "__main__":
    main()
