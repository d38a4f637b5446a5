# TAILWATER_ARCH. The default is not this machine's own processor: what is built on one node of a cluster must run on the
# others. x86-64-v3 is every amd64 processor with AVX2 (Haswell of 2013, Zen); what it costs is in docs/packages.md.
if(NOT DEFINED TAILWATER_ARCH AND CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  include(CheckCXXSourceRuns)
  check_cxx_source_runs("int main() { return __builtin_cpu_supports(\"avx2\") && __builtin_cpu_supports(\"fma\") ? 0 : 1; }"
                        TAILWATER_HAS_AVX2)
  if(TAILWATER_HAS_AVX2)
    set(default_arch x86-64-v3)
  else()
    set(default_arch x86-64-v2)
  endif()
endif()
set(TAILWATER_ARCH "${default_arch}" CACHE STRING
    "Processor to build for, as -march of the compiler: x86-64-v3, x86-64-v2, native, ...; empty: the compiler's default")
# A package has the program twice, built one after the other (scripts/package.sh), and chooses at start.
set(TAILWATER_FASTER_PROGRAM "" CACHE FILEPATH "Program built for x86-64-v3, which this one becomes where it can")
