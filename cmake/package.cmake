# Debian packages by CPack (scripts/package.sh): tailwater, python3-tailwater, libtailwater-dev and tailwater-doc.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME tailwater)
set(CPACK_PACKAGE_VENDOR "The Tailwater developers")
set(CPACK_PACKAGE_CONTACT "The Tailwater developers <maintainers@tailwater.example>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program library documents)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)

# A description's first line is what Debian lists; a summary of all packages (CPACK_PACKAGE_DESCRIPTION_SUMMARY) would come
# before it.
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "free-surface water flow by incompressible SPH
Tailwater computes dam breaks, flumes, weirs, waves and floating bodies with
incompressible smoothed particle hydrodynamics. A case is one text file; a run
leaves tables, particle fields for ParaView and a summary.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME tailwater)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
# What each of these brings is in docs/packages.md. A command that misses one says so (launch.py). PETSc is loaded by the
# program itself, so that what looks for libraries does not see it.
string(REGEX MATCH "^[0-9]+\\.[0-9]+" petsc_version ${PETSC_VERSION})
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "libpetsc-real${petsc_version}, openmpi-bin, python3, python3-numpy")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "python3-matplotlib, python3-scipy")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "python3-vtk9, xvfb, python3-h5py, python3-rasterio, paraview, tailwater-doc")

# The compiled module, and what scripts need: what is plain Python of the package is in the program's, which draws and
# validates by it without pandas, whose recommended packages would be a quarter of all that apt installs.
if(TAILWATER_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL module)
  set(CPACK_COMPONENT_MODULE_DESCRIPTION "simulations of Tailwater in a process of Python
The compiled module of the Python package tailwater, with which a script steps
a simulation and reads its particles in memory.")
  set(CPACK_DEBIAN_MODULE_PACKAGE_NAME python3-tailwater)
  set(CPACK_DEBIAN_MODULE_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_MODULE_PACKAGE_SHLIBDEPS ON)
  math(EXPR next_python "${Python3_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_MODULE_PACKAGE_DEPENDS "tailwater (= ${PROJECT_VERSION}), python3 (>= 3.${Python3_VERSION_MINOR}), python3 (<< 3.${next_python}), python3-pandas")
endif()

set(CPACK_COMPONENT_LIBRARY_DESCRIPTION "library of Tailwater, for programs of one's own
Static libraries and headers of the solver, with a CMake package:
find_package(Tailwater).")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libtailwater-dev)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS
    "libpetsc-real-dev, libhdf5-openmpi-dev, libopenmpi-dev, libtrilinos-zoltan-dev, libeigen3-dev, libcli11-dev, libcpp-httplib-dev, libtomlplusplus-dev, libmuparser-dev, libfmt-dev, nlohmann-json3-dev, zlib1g-dev, libdeflate-dev")

set(CPACK_COMPONENT_DOCUMENTS_DESCRIPTION "documents of Tailwater
The reference of the case file, the theory equation by equation, guides and
results of the validation.")
set(CPACK_DEBIAN_DOCUMENTS_PACKAGE_NAME tailwater-doc)
set(CPACK_DEBIAN_DOCUMENTS_PACKAGE_SECTION doc)
set(CPACK_DEBIAN_DOCUMENTS_PACKAGE_ARCHITECTURE all)
include(CPack)
