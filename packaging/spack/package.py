# SPDX-License-Identifier: Apache-2.0
# For Spack 1.0 or newer.
from spack_repo.builtin.build_systems.cmake import CMakePackage

from spack.package import *


class Tailwater(CMakePackage):
    """Free-surface water flow by incompressible smoothed particle hydrodynamics."""

    homepage = "https://tailwater.example/"
    git = "https://tailwater.example/tailwater.git"

    license("Apache-2.0")
    version("main", branch="main")
    version("1.0.0", tag="v1.0.0")

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("ninja", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("mpi")
    depends_on("petsc@3.18: ~complex +mpi +hdf5")
    depends_on("hdf5 +mpi")
    depends_on("trilinos +zoltan")
    depends_on("eigen@3.4:3")
    depends_on("fmt@9:")
    depends_on("cli11@2.1:")
    depends_on("cpp-httplib@0.11:")
    depends_on("tomlplusplus@3.3:")
    depends_on("muparser@2.3:")
    depends_on("nlohmann-json@3.11:")
    depends_on("zlib-api")
    depends_on("libdeflate@1.14:")
    depends_on("python@3.11:", type=("build", "run"))
    depends_on("py-numpy", type="run")
    depends_on("py-scipy", type="run")
    depends_on("py-pandas", type="run")
    depends_on("py-matplotlib", type="run")

    generator("ninja")

    def cmake_args(self):
        return [
            self.define("TAILWATER_BUILD_TESTS", False),
            self.define("TAILWATER_PYTHON", False),
            self.define("TAILWATER_ARCH", ""),  # Spack's compiler chooses by the target
            self.define("Python3_EXECUTABLE", self.spec["python"].command.path),
        ]
